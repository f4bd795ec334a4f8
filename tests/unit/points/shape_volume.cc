// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/shape_volume.h>

#include <gtest/gtest.h>

/** @file Volumes by formula and by counting. */

using namespace limber;
using dealii::Point;

namespace
{
  template <int dim>
  void
  expect_agreement(const Shape<dim> &shape, const double volume)
  {
    ASSERT_TRUE(shape.exact_volume());
    EXPECT_NEAR(*shape.exact_volume(), volume, 1e-12 * volume);
    EXPECT_EQ(shape_volume(shape), *shape.exact_volume());
    EXPECT_NEAR(counted_volume(shape), volume, 2e-3 * volume);
  }
} // namespace



TEST(ShapeVolume, FormulasAgreeWithCounting)
{
  expect_agreement<2>(BoxShape<2>(Point<2>(-1, 2), Point<2>(3, 2.1)), 0.4);
  expect_agreement<3>(BoxShape<3>(Point<3>(0, 0, 0), Point<3>(1, 2, 3)), 6);
  expect_agreement<2>(BallShape<2>(Point<2>(1, 1), 0.3),
                      dealii::numbers::PI * 0.09);
  expect_agreement<3>(BallShape<3>(Point<3>(1, 1, 1), 0.3),
                      dealii::numbers::PI * 0.036);
  expect_agreement<3>(CylinderShape<3>(1, Point<3>(1, 0, 2), 0.5, -1, 3),
                      dealii::numbers::PI);
  // a trapezium of parallel edges 3 and 1 at a distance of 2
  const BlockShape<2>::Vertices trapezium = {
    {Point<2>(0, 0), Point<2>(3, 0), Point<2>(0, 2), Point<2>(1, 2)}};
  expect_agreement<2>(BlockShape<2>(trapezium), 4);
}



TEST(ShapeVolume, AUnionCountsWhatPartsShareOnce)
{
  const auto box = [](const double left, const double right) {
    return std::make_shared<BoxShape<2>>(Point<2>(left, 0), Point<2>(right, 1));
  };
  const UnionShape<2> both({box(0, 2), box(1, 4)});
  EXPECT_FALSE(both.exact_volume());
  EXPECT_NEAR(shape_volume(both), 4, 4e-3);
}
