// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/checkerboard.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <algorithm>
#include <functional>
#include <numeric>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  /** Cells with masses and means of the volumetric variable, no points. */
  template <class Dimension>
  class Checkerboard : public testing::Test
  {
  public:
    static constexpr int dim = Dimension::value;

    Checkerboard()
      : cells(grid.n_cells)
      , mean(grid.n_cells)
      , mass(grid.n_cells, 2.)
      , shift(grid.n_cells)
    {
      std::iota(cells.begin(), cells.end(), 0u);
    }

    /** Place of a cell on the lattice in direction d. */
    int
    at(std::uint32_t cell, const int d) const
    {
      for (int e = 0; e < d; ++e)
        cell /= grid.bins.n[e];
      return cell % grid.bins.n[d];
    }

    void
    set_means(const std::function<double(std::uint32_t)> &value)
    {
      for (const std::uint32_t cell : cells)
        mean[cell] = value(cell);
    }

    void
    random_state()
    {
      set_means([&](const auto) { return random(0.9, 1.1); });
      for (double &m : mass)
        m = std::exp(random(-4, 1));
      for (unsigned int k = 0; k < 3; ++k)
        mass[random.below(mass.size())] = 0; // cells without points
    }

    void
    control(const double share)
    {
      for (const std::uint32_t cell : cells)
        {
          double *const record        = &grid.sums[cell << dim];
          record[CellSums<dim>::mass] = mass[cell];
          record[(1 << dim) - 1]      = mass[cell] * mean[cell];
        }
      std::fill(grid.nodes.begin(), grid.nodes.end(), 0.);
      gather_checkerboards<dim>(cells, grid.view(), grid.cell_sums());
      find_checkerboard_shifts<dim>(cells,
                                    grid.view(),
                                    grid.cell_sums(),
                                    share * *std::min_element(grid.edge.begin(),
                                                              grid.edge.end()),
                                    shift.data());
    }

    /** In the middle, with a ring of neighbours whose nodes all count. */
    bool
    is_inside(const std::uint32_t cell) const
    {
      for (int d = 0; d < dim; ++d)
        if (at(cell, d) < 1 || at(cell, d) > grid.bins.n[d] - 2)
          return false;
      return true;
    }

    Random                     random;
    SmallGrid<dim>             grid;
    std::vector<std::uint32_t> cells;
    std::vector<double>        mean, mass, shift;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(Checkerboard, Dimensions);
} // namespace



// Fields that vary along one direction at a time have no pattern.
TYPED_TEST(Checkerboard, LeavesSumsOfOneDimensionalFieldsAlone)
{
  this->set_means([&](const auto cell) {
    double sum = 0;
    for (int d = 0; d < TestFixture::dim; ++d)
      sum += (d + 1) * this->at(cell, d) + std::pow(this->at(cell, d), 2);
    return sum;
  });
  for (double &m : this->mass)
    m = this->random(0.1, 2);
  this->control(0.25);
  for (const double s : this->shift)
    EXPECT_NEAR(s, 0, 1e-13);
}



// A full checkerboard on equal cells decays by the share, as each cell has
// 2^dim nodes and W / m is 2^-dim.
TYPED_TEST(Checkerboard, TakesItsShareOfACheckerboard)
{
  this->set_means([&](const auto cell) {
    int sum = 0;
    for (int d = 0; d < TestFixture::dim; ++d)
      sum += this->at(cell, d);
    return sum % 2 ? 1. : -1.;
  });
  this->control(0.1);
  for (const std::uint32_t cell : this->cells)
    if (this->is_inside(cell))
      {
        EXPECT_NEAR(this->shift[cell], -0.1 * this->mean[cell], 1e-13);
      }
}



TYPED_TEST(Checkerboard, KeepsTheVolumeAndNeverAddsEnergy)
{
  for (unsigned int n = 0; n < 20; ++n)
    {
      this->random_state();
      this->control(1. / (1 << TestFixture::dim));
      double volume = 0, gain = 0, size = 0;
      for (const std::uint32_t cell : this->cells)
        {
          const double m = this->mass[cell], s = this->shift[cell];
          volume += m * s;
          gain += m * (std::pow(this->mean[cell] + s - 1, 2) -
                       std::pow(this->mean[cell] - 1, 2));
          size += m * std::abs(s);
        }
      EXPECT_GT(size, 1e-3);
      EXPECT_NEAR(volume, 0, 1e-13);
      EXPECT_LT(gain, 0);
    }
}



// Next to the surface the patterns of a pressure do meet a force.
TYPED_TEST(Checkerboard, NeedsAllCellsAroundANode)
{
  this->random_state();
  std::fill(this->mass.begin(), this->mass.end(), 0.);
  for (const std::uint32_t cell : this->cells)
    if (this->at(cell, 0) == 2) // one layer
      this->mass[cell] = 1;
  this->control(0.25);
  for (const double s : this->shift)
    EXPECT_EQ(s, 0);
}
