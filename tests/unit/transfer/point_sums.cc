// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/point_sums.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  // Any number of them: full packs, the rest of one, more than a block.
  template <int dim>
  void
  expect_sums_of(const std::size_t n)
  {
    Random           random;
    SmallPoints<dim> own(n, false, 0, -1);
    for (auto &field : own.fields)
      for (double &value : field)
        value = random();
    PointView<dim>      points = own.view();
    MotionSums<dim>     exact;
    PositionBounds<dim> box;
    box.lower.fill(std::numeric_limits<double>::max());
    box.upper.fill(-std::numeric_limits<double>::max());
    for (std::size_t p = 0; p < n; ++p)
      {
        double square = 0;
        for (int d = 0; d < dim; ++d)
          {
            const double v = points.velocity[d][p];
            square += v * v;
            exact.momentum[d] += points.mass[p] * v;
            exact.mass_moment[d] += points.mass[p] * points.position[d][p];
            box.lower[d] = std::min(box.lower[d], points.position[d][p]);
            box.upper[d] = std::max(box.upper[d], points.position[d][p]);
          }
        exact.mass += points.mass[p];
        exact.kinetic_energy += 0.5 * points.mass[p] * square;
        exact.absolute_momentum += points.mass[p] * std::sqrt(square);
        exact.squared_speed = std::max(exact.squared_speed, square);
      }
    const MotionSums<dim> found     = sum_motion(points);
    const double          tolerance = 1e-14 * (1. + n);
    EXPECT_NEAR(found.mass, exact.mass, tolerance);
    EXPECT_NEAR(found.kinetic_energy, exact.kinetic_energy, tolerance);
    EXPECT_NEAR(found.absolute_momentum, exact.absolute_momentum, tolerance);
    EXPECT_NEAR(found.squared_speed, exact.squared_speed, 1e-15);
    for (int d = 0; d < dim; ++d)
      {
        EXPECT_NEAR(found.momentum[d], exact.momentum[d], tolerance);
        EXPECT_NEAR(found.mass_moment[d], exact.mass_moment[d], tolerance);
      }
    const PositionBounds<dim> bounds = bounds_of_positions(points);
    EXPECT_EQ(bounds.lower, box.lower);
    EXPECT_EQ(bounds.upper, box.upper);
  }
} // namespace



TEST(PointSums, AreThoseOfAllPointsWhateverTheirNumber)
{
  for (const std::size_t n : {0, 1, 7, 8, 511, 512, 515, 1031})
    {
      SCOPED_TRACE(n);
      expect_sums_of<2>(n);
      expect_sums_of<3>(n);
    }
}
