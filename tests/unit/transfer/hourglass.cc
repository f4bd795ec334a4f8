// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/hourglass.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>
#include <numeric>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class Dimension>
  class Hourglass : public testing::Test
  {
  public:
    static constexpr int dim = Dimension::value;
    using Layout             = NodeLayout<dim>;

    /** Nodal masses and the sums of random points; all cells. */
    Hourglass()
      : points(random_points<dim>(grid, random))
      , cells(grid.n_cells)
    {
      grid.gather(points.view());
      std::iota(cells.begin(), cells.end(), 0u);
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        record(n)[Layout::mass] = random(0.5, 2);
    }

    double *
    record(const std::size_t node)
    {
      return &grid.nodes[node * Layout::stride];
    }

    void
    set_velocity(const std::size_t node, const Vector<dim> &v)
    {
      for (int d = 0; d < dim; ++d)
        record(node)[Layout::momentum + d] = record(node)[Layout::mass] * v[d];
    }

    void
    resist(const double chi, const double step)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        std::fill_n(record(n) + Layout::remapped, dim, 0.);
      sums.assign(grid.nodes.size(), 0.);
      find_hourglass_modes<dim>(cells,
                                grid.view(),
                                {{grid.cell_sums(), chi}},
                                step,
                                modes,
                                sums.data());
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        if (double *const of_node = &sums[n * Layout::stride]; of_node[0] > 0)
          for (unsigned int k = 1; k < HourglassLayout<dim>::n; ++k)
            of_node[k] /= of_node[0];
      add_hourglass_forces<dim>(cells, grid.view(), modes, sums.data());
    }

    /** A place as if all edges were one, from the first node. */
    Vector<dim>
    scaled_place(const std::size_t node) const
    {
      Vector<dim> x = grid.place(node);
      for (int d = 0; d < dim; ++d)
        x[d] = (x[d] - grid.lower[d]) / grid.edge[d];
      return x;
    }

    Random                           random;
    SmallGrid<dim>                   grid;
    SmallPoints<dim>                 points;
    std::vector<std::uint32_t>       cells;
    std::vector<HourglassModes<dim>> modes;
    std::vector<double>              sums;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(Hourglass, Dimensions);
} // namespace



// Also at the boundary of what there is, wherever that is.
TYPED_TEST(Hourglass, QuadraticFieldsMeetNoResistance)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  this->cells.erase(this->cells.begin() + 3, this->cells.begin() + 9);
  const auto  a = this->random.template vector<dim>();
  const auto  A = this->random.template matrix<dim>(3.);
  Matrix<dim> B[dim];
  for (auto &of_component : B)
    of_component = this->random.template matrix<dim>(5.);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    {
      const auto x = this->grid.place(n);
      auto       v = a;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            v[d] += A[d][e] * x[e];
            for (int f = 0; f < dim; ++f)
              v[d] += B[d][e][f] * x[e] * x[f];
          }
      this->set_velocity(n, v);
    }
  this->resist(0.5, 1e-9);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    for (int d = 0; d < dim; ++d)
      EXPECT_NEAR(this->record(n)[Layout::remapped + d], 0., 1e-11);
}



// No force and no moment on the whole, and energy is taken, never given; also
// where the limit for a long step is at work.
TYPED_TEST(Hourglass, MomentumIsKeptAndEnergyTaken)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  for (const double step : {1e-9, 0.1})
    {
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        this->set_velocity(n, this->random.template vector<dim>());
      this->resist(0.5, step);

      Vector<dim> force{};
      Matrix<dim> moment{};
      double      power = 0, before = 0, after = 0;
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        {
          const auto          x      = this->grid.place(n);
          const double *const record = this->record(n);
          const double        mass   = record[Layout::mass];
          for (int d = 0; d < dim; ++d)
            {
              const double f = record[Layout::remapped + d];
              const double v = record[Layout::momentum + d] / mass;
              force[d] += f;
              power += f * v;
              before += 0.5 * mass * v * v;
              after +=
                0.5 * mass * (v + step * f / mass) * (v + step * f / mass);
              for (int e = 0; e < dim; ++e)
                moment[d][e] += x[d] * record[Layout::remapped + e] -
                                x[e] * record[Layout::remapped + d];
            }
        }
      const double size = std::abs(power);
      EXPECT_LT(power, 0.);
      EXPECT_LT(after, before);
      for (int d = 0; d < dim; ++d)
        {
          EXPECT_NEAR(force[d], 0., 1e-13 * size);
          for (int e = 0; e < dim; ++e)
            EXPECT_NEAR(moment[d][e], 0., 1e-12 * size);
        }
    }
}



// All velocities alternate from node to node: means around nodes within are
// zero where the cells weigh the same, and the force is that of a cell by
// itself.
TYPED_TEST(Hourglass, AlternatingMotionMeetsAllOfTheResistance)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  const double k = 0.7, step = 1e-9;
  const double edge =
    *std::min_element(this->grid.edge.begin(), this->grid.edge.end());
  for (std::size_t c = 0; c < this->grid.n_cells; ++c)
    this->grid.sums[(c << dim) + CellSums<dim>::mass] = k * edge;
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    {
      const auto  x = this->scaled_place(n);
      Vector<dim> v{};
      v[0] = std::lround(x[0] + x[1]) % 2 == 0 ? 0.2 : -0.2;
      this->set_velocity(n, v);
    }
  this->resist(1, step);
  unsigned int n_inside = 0;
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    {
      const auto x = this->scaled_place(n);
      if (std::any_of(x.begin(), x.end(), [](const double coordinate) {
            return coordinate < 1.5 || coordinate > 3.5;
          }))
        continue;
      ++n_inside;
      const double *const record = this->record(n);
      EXPECT_NEAR(record[Layout::remapped],
                  -(1 << dim) * k * record[Layout::momentum] /
                    record[Layout::mass],
                  1e-12);
    }
  EXPECT_EQ(n_inside, 1u << dim);
}



// f_a = - s_a chi c (m_cell / h) q on the mode xi eta of amplitude q
TYPED_TEST(Hourglass, ACellAloneResistsByTheFormula)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  for (std::uint32_t c = 0; c < this->grid.n_cells; ++c)
    {
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        this->set_velocity(n, {});
      const auto sign = [](const int i) {
        return ((i & 1) != 0) == ((i & 2) != 0) ? 1. : -1.;
      };
      for (int i = 0; i < 1 << dim; ++i)
        {
          Vector<dim> v{};
          v[1] = 0.3 * sign(i);
          this->set_velocity(this->grid.node_number(c, i), v);
        }
      this->cells = {c};
      this->resist(0.5, 1e-9);
      const double h =
        *std::min_element(this->grid.edge.begin(), this->grid.edge.end());
      const double mass = this->grid.sums[(c << dim) + CellSums<dim>::mass];
      for (int i = 0; i < 1 << dim; ++i)
        for (int d = 0; d < dim; ++d)
          EXPECT_NEAR(this->record(
                        this->grid.node_number(c, i))[Layout::remapped + d],
                      d == 1 ? -0.5 * mass / h * 0.3 * sign(i) : 0.,
                      1e-12);
    }
}



TYPED_TEST(Hourglass, ANodeWithoutMassHasNoVelocityToResist)
{
  constexpr int dim  = TestFixture::dim;
  using Layout       = NodeLayout<dim>;
  const auto without = this->grid.node_number(0, 0);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    {
      if (n == without)
        this->record(n)[Layout::mass] = 0;
      this->set_velocity(n, this->random.template vector<dim>());
    }
  this->resist(0.5, 1e-9);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    for (int d = 0; d < dim; ++d)
      EXPECT_TRUE(std::isfinite(this->record(n)[Layout::remapped + d]));
  for (int d = 0; d < dim; ++d)
    EXPECT_EQ(this->record(without)[Layout::remapped + d], 0);
}
