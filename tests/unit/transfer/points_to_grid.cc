// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/cell_batch.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/points_to_grid.h>
#include <limber/transfer/project_on_nodes.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>
#include <support/treatments.h>

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
  class PointsToGrid : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Layout             = NodeLayout<dim>;
    using Grid               = SmallGrid<dim, Case::kernel>;

    /** The sums as the textbook has them, point by point, node by node. */
    std::vector<double>
    direct(SmallPoints<dim> &own, const P2GOptions &what)
    {
      const auto          points = own.view();
      std::vector<double> result(grid.nodes.size());
      for (std::size_t p = 0; p < points.size; ++p)
        for (int i = 0; i < Grid::n_in_cell; ++i)
          {
            const auto          cell   = points.cell[p];
            const auto          x      = own.position(p);
            const double        mass   = points.mass[p];
            const double        N      = grid.shape(cell, i, x);
            const auto          G      = grid.gradient(cell, i, x);
            const std::uint32_t node   = grid.node_number(cell, i);
            const auto          x_i    = grid.place(node);
            double *const       record = result.data() + node * Layout::stride;
            if (what.momentum)
              {
                record[Layout::mass] += mass * N;
                for (int d = 0; d < dim; ++d)
                  {
                    double v = points.velocity[d][p];
                    if (what.affine)
                      for (int e = 0; e < dim; ++e)
                        v += points.affine[d * dim + e][p] * (x_i[e] - x[e]);
                    record[Layout::momentum + d] += mass * N * v;
                  }
              }
            if (what.force)
              {
                const auto t = kirchhoff_stress(points, p);
                for (int d = 0; d < dim; ++d)
                  for (int e = 0; e < dim; ++e)
                    record[Layout::force + d] -=
                      mass * what.inverse_density * t[d][e] * G[e];
              }
          }
      return result;
    }

    void
    expect_nodes(const std::vector<double> &expected) const
    {
      for (std::size_t k = 0; k < expected.size(); ++k)
        ASSERT_NEAR(grid.nodes[k], expected[k], 2e-12)
          << "node " << k / Layout::stride << ", slot " << k % Layout::stride;
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
  TYPED_TEST_SUITE(PointsToGrid, Cases);
} // namespace



TEST(AddToNodes, TransposesBlocks)
{
  std::array<Pack<4>, 4> a;
  std::array<Pack<8>, 8> b;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      a[i][j] = 10 * i + j;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      b[i][j] = 10 * i + j;
  transpose<4>(a);
  transpose<8>(b);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_EQ(a[i][j], 10 * j + i);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      EXPECT_EQ(b[i][j], 10 * j + i);
}



TYPED_TEST(PointsToGrid, SumsAreThoseOfAPlainLoop)
{
  constexpr int dim = TestFixture::dim;
  for (int variant = 0; variant < 32; ++variant)
    {
      P2GOptions what;
      what.momentum        = variant & 1;
      what.force           = variant & 2;
      what.affine          = variant & 4;
      what.inverse_density = 0.8;
      auto points          = random_points<dim>(
        this->grid, this->random, variant & 8, 0, -1, variant & 16);
      this->grid.clear();
      points_to_grid<dim>(points.view(), this->grid.view(), what, nullptr);
      this->expect_nodes(this->direct(points, what));
    }
}



TYPED_TEST(PointsToGrid, SumsAreAddedToWhatIsThere)
{
  constexpr int dim    = TestFixture::dim;
  auto          points = random_points<dim>(this->grid, this->random);
  P2GOptions    what;
  what.inverse_density = 1;
  auto expected        = this->direct(points, what);
  for (std::size_t k = 0; k < expected.size(); ++k)
    expected[k] += this->grid.nodes[k] = this->random();
  points_to_grid<dim>(points.view(), this->grid.view(), what, nullptr);
  this->expect_nodes(expected);
}



// f_i += sum_p V_p pbar G_ip, with pbar V-weighted over the points of the cell
TYPED_TEST(PointsToGrid, ProjectedPressureActsThroughAllPointsOfItsCell)
{
  constexpr int dim = TestFixture::dim;
  for (int variant = 0; variant < 8; ++variant)
    {
      auto own = random_points<dim>(
        this->grid, this->random, variant & 1, 0, -1, variant & 2);
      const auto points = own.view();
      P2GOptions what;
      what.momentum        = variant & 4;
      what.inverse_density = 0.8;
      what.treatment.kind  = Treatment::cell;
      this->grid.clear();
      this->grid.gather(points);
      const auto sums = this->grid.cell_sums();
      points_to_grid<dim>(points, this->grid.view(), what, &sums);

      std::vector<double> pressure(this->grid.n_cells),
        volume(this->grid.n_cells);
      for (std::size_t p = 0; p < points.size; ++p)
        {
          pressure[points.cell[p]] += points.mass[p] * points.pressure[p];
          volume[points.cell[p]] += points.mass[p];
        }
      for (std::size_t p = 0; p < points.size; ++p)
        points.pressure[p] = pressure[points.cell[p]] / volume[points.cell[p]];
      this->expect_nodes(this->direct(own, what));
    }
}



// Forces that the material exerts on itself: no sum and no moment.
TYPED_TEST(PointsToGrid, TotalsAreKept)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  for (const bool affine : {false, true})
    for (const Treatment kind : treatments_of<TypeParam::kernel>())
      {
        auto       own    = random_points<dim>(this->grid, this->random);
        const auto points = own.view();
        P2GOptions what;
        what.inverse_density = 0.8;
        what.affine          = affine;
        what.treatment       = strain_treatment_of(kind);
        what.projected_pressure =
          this->grid.nodal_means([&](double *const records) {
            sum_pressure<dim>(points, this->grid.view(), records);
          });
        this->grid.clear();
        this->grid.gather(points);
        const auto sums = this->grid.cell_sums();
        points_to_grid<dim>(points, this->grid.view(), what, &sums);

        double      mass = 0;
        Vector<dim> momentum{}, force{};
        Matrix<dim> moment{}, spin{};
        for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
          {
            const double *const record = &this->grid.nodes[n * Layout::stride];
            const auto          x      = this->grid.place(n);
            mass += record[Layout::mass];
            for (int d = 0; d < dim; ++d)
              {
                momentum[d] += record[Layout::momentum + d];
                force[d] += record[Layout::force + d];
                for (int e = 0; e < dim; ++e)
                  {
                    moment[d][e] += x[d] * record[Layout::force + e] -
                                    x[e] * record[Layout::force + d];
                    spin[d][e] += x[d] * record[Layout::momentum + e] -
                                  x[e] * record[Layout::momentum + d];
                  }
              }
          }
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const auto x = own.position(p);
            mass -= points.mass[p];
            for (int d = 0; d < dim; ++d)
              {
                momentum[d] -= points.mass[p] * points.velocity[d][p];
                for (int e = 0; e < dim; ++e)
                  spin[d][e] -= points.mass[p] * (x[d] * points.velocity[e][p] -
                                                  x[e] * points.velocity[d][p]);
              }
          }
        EXPECT_NEAR(mass, 0., 1e-11);
        for (int d = 0; d < dim; ++d)
          {
            // the affine part sums to zero: sum N_i (x_i - x) = 0
            EXPECT_NEAR(momentum[d], 0., 1e-11);
            EXPECT_NEAR(force[d], 0., 1e-11);
            for (int e = 0; e < dim; ++e)
              {
                EXPECT_NEAR(moment[d][e], 0., 1e-11);
                if (!affine) // it adds the spin of the point itself
                  {
                    EXPECT_NEAR(spin[d][e], 0., 1e-11);
                  }
              }
          }
      }
}



TYPED_TEST(PointsToGrid, BatchesAreCountedAndCoverAllPoints)
{
  constexpr int dim     = TestFixture::dim;
  auto          points  = random_points<dim>(this->grid, this->random);
  std::size_t   covered = 0, runs = 0;
  for (std::size_t p = 0; p < points.size; ++p)
    runs += p == 0 || points.cell[p] != points.cell[p - 1];
  const std::size_t n =
    for_each_batch(points.view(), [&](const CellBatch &batch) {
      EXPECT_EQ(batch.begin, covered);
      covered = batch.end;
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        EXPECT_EQ(points.cell[p], batch.cell);
    });
  EXPECT_EQ(covered, points.size);
  EXPECT_EQ(n, runs);
  EXPECT_EQ(points_to_grid<dim>(
              points.view(), this->grid.view(), P2GOptions(), nullptr),
            runs);
}



TYPED_TEST(PointsToGrid, NoPointsGiveNothing)
{
  constexpr int    dim = TestFixture::dim;
  SmallPoints<dim> points(0, true, 0, -1);
  EXPECT_EQ(points_to_grid<dim>(
              points.view(), this->grid.view(), P2GOptions(), nullptr),
            0u);
  this->expect_nodes(std::vector<double>(this->grid.nodes.size()));
}
