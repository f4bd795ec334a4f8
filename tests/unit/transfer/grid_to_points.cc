// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/locate.h>
#include <limber/transfer/grid_to_points.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>
#include <limits>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dimension, KernelKind kernel_kind>
  struct Case
  {
    static constexpr int        dim    = dimension;
    static constexpr KernelKind kernel = kernel_kind;
  };



  template <class Case>
  class GridToPoints : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Grid               = SmallGrid<dim, Case::kernel>;
    using Layout             = NodeLayout<dim>;

    /** Values at the nodes of a linear field a + A x, from a slot on. */
    void
    set_field(const unsigned int slot,
              const Vector<dim> &a,
              const Matrix<dim> &A)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          grid.nodes[n * Layout::stride + slot + d] =
            value(a, A, grid.place(n))[d];
    }

    static Vector<dim>
    value(const Vector<dim> &a, const Matrix<dim> &A, const Vector<dim> &x)
    {
      Vector<dim> result = a;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          result[d] += A[d][e] * x[e];
      return result;
    }

    Random random;
    Grid   grid;
  };

  using Cases = testing::Types<Case<2, KernelKind::linear>,
                               Case<3, KernelKind::linear>,
                               Case<2, KernelKind::quadratic>,
                               Case<3, KernelKind::quadratic>,
                               Case<2, KernelKind::cubic>,
                               Case<3, KernelKind::cubic>>;
  TYPED_TEST_SUITE(GridToPoints, Cases);
} // namespace



TYPED_TEST(GridToPoints, LinearFieldsAreTakenExactly)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  const auto a      = this->random.template vector<dim>(),
             b      = this->random.template vector<dim>();
  const auto A      = this->random.template matrix<dim>(),
             B      = this->random.template matrix<dim>();
  this->set_field(Layout::increment, a, A);
  this->set_field(Layout::velocity, b, B);

  for (int variant = 0; variant < 12; ++variant)
    {
      G2POptions what;
      what.flip_share = std::array{1., 0.9, 0.}[variant % 3];
      what.affine     = variant % 6 >= 3;
      auto points =
        random_points<dim>(this->grid, this->random, true, 0, -1, variant >= 6);
      const auto before = points;
      const auto summary =
        grid_to_points<dim>(points.view(), this->grid.view(), what, nullptr);

      double largest = 0, removed = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto increment = this->value(a, A, points.position(p)),
                     velocity  = this->value(b, B, points.position(p));
          double squared       = 0;
          for (int d = 0; d < dim; ++d)
            {
              const double flip  = before.fields[dim + d][p] + increment[d];
              const double alpha = what.flip_share;
              EXPECT_NEAR(points.fields[dim + d][p],
                          alpha * flip + (1 - alpha) * velocity[d],
                          1e-14);
              squared += std::pow(points.fields[dim + d][p], 2);
              removed += 0.5 * points.view().mass[p] *
                         (flip * flip - std::pow(points.fields[dim + d][p], 2));
              for (int e = 0; e < dim; ++e)
                {
                  const auto kept = [&](const int row, const int column) {
                    return points.view().affine[row * dim + column][p];
                  };
                  if (!what.affine)
                    EXPECT_EQ(kept(d, e),
                              before.fields[2 * dim + 2 + n_deviator<dim> +
                                            d * dim + e][p]);
                  else if (what.flip_share == 0)
                    EXPECT_NEAR(kept(d, e), B[d][e], 1e-13);
                  else
                    EXPECT_NEAR(kept(d, e) + kept(e, d),
                                B[d][e] + B[e][d],
                                1e-11);
                }
            }
          largest = std::max(largest, squared);
          // the work of the increments on the affine velocity
          if (what.affine)
            for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
              {
                const auto   cell = points.cell[p];
                const auto   x    = points.position(p);
                const auto   node = this->grid.node_number(cell, i);
                const auto   x_i  = this->grid.place(node);
                const double N    = this->grid.shape(cell, i, x);
                for (int d = 0; d < dim; ++d)
                  for (int e = 0; e < dim; ++e)
                    {
                      const double dv =
                        this->grid
                          .nodes[node * Layout::stride + Layout::increment + d];
                      const double former =
                        before.fields[2 * dim + 2 + n_deviator<dim> + d * dim +
                                      e][p];
                      const double kept = points.view().affine[d * dim + e][p];
                      removed += points.view().mass[p] * N * dv * 0.5 *
                                 (former + kept) * (x_i[e] - x[e]);
                    }
              }
        }
      EXPECT_NEAR(summary.speed_squared, largest, 1e-13);
      EXPECT_NEAR(summary.removed, removed, 1e-13 * points.size);
      EXPECT_EQ(summary.displacement, 0.);

      // everything else, and what lies behind the points, is as it was
      EXPECT_EQ(points.cell, before.cell);
      for (std::size_t k = 0; k < points.fields.size(); ++k)
        {
          const bool velocity = k >= dim && k < 2 * dim;
          const bool affine   = k >= 2 * dim + 2 + n_deviator<dim>;
          if (!velocity && !(affine && what.affine))
            {
              EXPECT_EQ(points.fields[k], before.fields[k]);
            }
          for (std::size_t p = points.size; p < points.fields[k].size(); ++p)
            EXPECT_EQ(points.fields[k][p], before.fields[k][p]);
        }
    }
}



// A point that has just come into an empty cell.
TYPED_TEST(GridToPoints, LightNodesBoundTheAffineVelocity)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  if (TypeParam::kernel != KernelKind::linear)
    return; // D of splines has a bound
  for (double &value : this->grid.nodes)
    value = 0.5 + 0.5 * this->random();
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    this->grid.nodes[n * Layout::stride + Layout::mass] =
      std::pow(10., -3 * this->random(0, 1));
  auto       points = random_points<dim>(this->grid, this->random);
  const auto before = points;

  const auto run = [&](const double light_density) {
    auto       result = before;
    G2POptions what;
    what.affine        = true;
    what.flip_share    = 0;
    what.light_density = light_density;
    grid_to_points<dim>(result.view(), this->grid.view(), what, nullptr);
    return result;
  };
  const double density = 10;
  const auto   whole = run(0), bounded = run(density);

  double volume = 1;
  for (int d = 0; d < dim; ++d)
    volume *= this->grid.edge[d];
  const double least_mass = density * volume;

  unsigned int n_bounded = 0;
  for (std::size_t p = 0; p < before.size; ++p)
    {
      const auto  cell = before.cell[p];
      const auto  x    = points.position(p);
      Vector<dim> at_point{}, D{};
      Matrix<dim> L{}; // what is left out
      const auto  of_node = [&](const int i) {
        return this->grid.nodes.data() +
               this->grid.node_number(cell, i) * Layout::stride;
      };
      for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
        for (int d = 0; d < dim; ++d)
          {
            const auto x_i = this->grid.place(this->grid.node_number(cell, i));
            const double N = this->grid.shape(cell, i, x);
            at_point[d] += N * of_node(i)[Layout::increment + d];
            D[d] += N * std::pow(x_i[d] - x[d], 2);
          }
      for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
        {
          const double theta =
            std::min(1., of_node(i)[Layout::mass] / least_mass);
          n_bounded += theta < 1;
          const auto G = this->grid.gradient(cell, i, x);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              L[d][e] += (1 - theta) *
                         (of_node(i)[Layout::increment + d] - at_point[d]) *
                         G[e];
        }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            const auto C = [&](const auto &taken, const int d, const int e) {
              return taken
                .fields[2 * dim + 2 + n_deviator<dim> + d * dim + e][p];
            };
            const double spin =
              d == e ? 0. : (L[d][e] * D[e] - L[e][d] * D[d]) / (D[d] + D[e]);
            EXPECT_NEAR(C(bounded, d, e),
                        C(whole, d, e) - L[d][e] + spin,
                        1e-11 * (1 + std::abs(L[d][e])));
            // the angular momentum of the affine velocity
            EXPECT_NEAR(C(bounded, d, e) * D[e] - C(bounded, e, d) * D[d],
                        C(whole, d, e) * D[e] - C(whole, e, d) * D[d],
                        1e-11);
          }
    }
  EXPECT_GT(n_bounded, 20u);

  // nodes that are heavy say all
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    this->grid.nodes[n * Layout::stride + Layout::mass] = 1e3;
  EXPECT_EQ(run(density).fields, whole.fields);
}



// AFLIP: whatever points and nodes have, the points together gain the angular
// momentum of the increments, before they move.
TYPED_TEST(GridToPoints, IncrementsBringTheirAngularMomentum)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  for (double &value : this->grid.nodes)
    value = this->random();
  auto       points = random_points<dim>(this->grid, this->random);
  const auto before = points;

  G2POptions what;
  what.affine = true;
  grid_to_points<dim>(points.view(), this->grid.view(), what, nullptr);

  for (int d = 0; d < dim; ++d)
    for (int e = 0; e < d; ++e)
      {
        double gained = 0, brought = 0, size = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const auto     x = points.position(p);
            const double   m = points.view().mass[p];
            Vector<dim>    D{};
            constexpr auto C = 2 * dim + 2 + n_deviator<dim>;
            for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
              {
                const auto   node = this->grid.node_number(points.cell[p], i);
                const auto   x_i  = this->grid.place(node);
                const double N    = this->grid.shape(points.cell[p], i, x);
                for (int k = 0; k < dim; ++k)
                  D[k] += N * std::pow(x_i[k] - x[k], 2);
                const double *const dv =
                  &this->grid.nodes[node * Layout::stride + Layout::increment];
                brought += m * N * (x_i[d] * dv[e] - x_i[e] * dv[d]);
                size +=
                  m * N * (std::abs(x_i[d] * dv[e]) + std::abs(x_i[e] * dv[d]));
              }
            const auto change = [&](const int k) {
              return points.fields[k][p] - before.fields[k][p];
            };
            gained += m * (x[d] * change(dim + e) - x[e] * change(dim + d) +
                           D[d] * change(C + e * dim + d) -
                           D[e] * change(C + d * dim + e));
          }
        EXPECT_NEAR(gained, brought, 1e-13 * size);
        EXPECT_GT(std::abs(brought), 1e-3 * size);
      }
}



// The new momentum goes back with the weights of the old places.
TYPED_TEST(GridToPoints, RemapIsTheDirectSum)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  for (int variant = 0; variant < 4; ++variant)
    {
      for (double &value : this->grid.nodes)
        value = this->random();
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          this->grid.nodes[n * Layout::stride + Layout::remapped + d] = 0;

      auto own =
        random_points<dim>(this->grid, this->random, false, 0, -1, variant & 2);
      G2POptions what;
      what.affine       = variant & 1;
      what.remap        = true;
      auto       wanted = this->grid.nodes;
      const auto points = own.view();
      grid_to_points<dim>(points, this->grid.view(), what, nullptr);

      for (std::size_t p = 0; p < points.size; ++p)
        for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
          {
            const auto cell = points.cell[p];
            const auto x    = own.position(p);
            const auto node = this->grid.node_number(cell, i);
            const auto x_i  = this->grid.place(node);
            for (int d = 0; d < dim; ++d)
              {
                double v = points.velocity[d][p];
                if (what.affine)
                  for (int e = 0; e < dim; ++e)
                    v += points.affine[d * dim + e][p] * (x_i[e] - x[e]);
                wanted[node * Layout::stride + Layout::remapped + d] +=
                  points.mass[p] * this->grid.shape(cell, i, x) * v;
              }
          }
      for (std::size_t k = 0; k < wanted.size(); ++k)
        ASSERT_NEAR(this->grid.nodes[k], wanted[k], 1e-11);
    }
}



TYPED_TEST(GridToPoints, PointsMoveWithTheGrid)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  const auto b      = this->random.template vector<dim>();
  const auto B      = this->random.template matrix<dim>();
  this->set_field(Layout::velocity, b, B);
  for (const bool affine : {false, true})
    {
      G2POptions what;
      what.affine       = affine;
      what.move         = 0.05;
      auto       points = random_points<dim>(this->grid, this->random);
      const auto before = points;
      const auto summary =
        grid_to_points<dim>(points.view(), this->grid.view(), what, nullptr);
      double largest = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto v = this->value(b, B, before.position(p));
          for (int d = 0; d < dim; ++d)
            {
              EXPECT_NEAR(points.fields[d][p],
                          before.fields[d][p] + what.move * v[d],
                          1e-14);
              largest =
                std::max(largest,
                         std::abs(what.move * v[d]) / this->grid.edge[d]);
            }
          const auto cell = this->grid.bins.cell_at(points.position(p));
          EXPECT_EQ(points.cell[p], cell);
        }
      EXPECT_NEAR(summary.displacement, largest, 1e-14);
    }
}



TYPED_TEST(GridToPoints, LocateFindsCellsAndReportsThem)
{
  constexpr int       dim  = TestFixture::dim;
  auto               &grid = this->grid;
  SmallPoints<dim>    points(200, false, 0, -1);
  const auto          view = points.view();
  const std::uint32_t home = grid.n_cells / 2;
  grid.occupied[home]      = 1;
  for (std::size_t p = 0; p < points.size; ++p)
    {
      points.cell[p] = home;
      for (int d = 0; d < dim; ++d)
        view.position[d][p] =
          grid.cells[home].origin[d] + grid.edge[d] * this->random(-1, 2);
    }
  // the first and the last stay outside the range that is asked for
  locate<dim>(view, grid.view(), home, 1, points.size - 1);
  EXPECT_EQ(points.cell[0], home);
  EXPECT_EQ(points.cell[points.size - 1], home);

  std::vector<std::uint8_t> found(grid.n_cells);
  found[home] = 1;
  for (std::size_t p = 1; p < points.size - 1; ++p)
    {
      ASSERT_LT(points.cell[p], grid.n_cells);
      const auto &cell = grid.cells[points.cell[p]];
      for (int d = 0; d < dim; ++d)
        {
          const double xi =
            (view.position[d][p] - cell.origin[d]) * cell.inverse_edge[d];
          EXPECT_GE(xi, 0.);
          EXPECT_LE(xi, 1.);
        }
      found[points.cell[p]] = 1;
    }
  EXPECT_EQ(grid.occupied, found);
  EXPECT_FALSE(grid.left);

  // each new cell is reported once
  auto entered = grid.entered;
  std::sort(entered.begin(), entered.end());
  EXPECT_EQ(std::unique(entered.begin(), entered.end()), entered.end());
  EXPECT_EQ(entered.size() + 1,
            std::size_t(std::count(found.begin(), found.end(), 1)));
}



TYPED_TEST(GridToPoints, LocateSeesPointsLeave)
{
  constexpr int dim = TestFixture::dim;
  const double  nan = std::numeric_limits<double>::quiet_NaN();
  for (const double outside : {-1e-9, 1 + 1e-9, 1e300, -1e300, nan})
    for (int d = 0; d < dim; ++d)
      {
        SmallGrid<dim>   grid(3);
        SmallPoints<dim> points(1, false, 0, -1);
        for (int e = 0; e < dim; ++e)
          points.fields[e][0] = grid.lower[e] + 1.5 * grid.edge[e];
        points.cell[0]      = grid.n_cells / 2;
        points.fields[d][0] = grid.lower[d] + 3 * outside * grid.edge[d];
        locate<dim>(points.view(), grid.view(), points.cell[0], 0, 1);
        EXPECT_EQ(points.cell[0], invalid_cell);
        EXPECT_TRUE(grid.left);
        EXPECT_TRUE(grid.entered.empty());
      }
}
