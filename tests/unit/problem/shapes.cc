// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/shapes.h>

#include <gtest/gtest.h>

using namespace limber;
using dealii::Point;

TEST(Shapes, BoxHoldsItsCorners)
{
  const BoxShape<3> box(Point<3>(0, 0, 0), Point<3>(1, 2, 3));
  EXPECT_TRUE(box.contains(Point<3>(1, 2, 3)));
  EXPECT_TRUE(box.contains(Point<3>(0.5, 1, 1)));
  EXPECT_FALSE(box.contains(Point<3>(0.5, 1, 3.1)));
  EXPECT_EQ(box.bounding_box().second, box.upper);
}



TEST(Shapes, BallIsRound)
{
  const BallShape<2> ball(Point<2>(1, 1), 0.5);
  EXPECT_TRUE(ball.contains(Point<2>(1, 1.5)));
  EXPECT_FALSE(ball.contains(Point<2>(1.4, 1.4)));
  EXPECT_EQ(ball.bounding_box().first, Point<2>(0.5, 0.5));
}



TEST(Shapes, CylinderRunsAlongItsAxis)
{
  const CylinderShape<3> cylinder(0, Point<3>(99, 1, 1), 0.5, -1, 2);
  EXPECT_TRUE(cylinder.contains(Point<3>(2, 1, 1.5)));
  EXPECT_FALSE(cylinder.contains(Point<3>(2.1, 1, 1)));
  EXPECT_FALSE(cylinder.contains(Point<3>(0, 1.4, 1.4)));
  EXPECT_EQ(cylinder.bounding_box().first, Point<3>(-1, 0.5, 0.5));
  EXPECT_EQ(cylinder.bounding_box().second, Point<3>(2, 1.5, 1.5));
}



TEST(Shapes, FormulaIsCutByItsBox)
{
  const FormulaShape<2> half(Formula<2>("y - x", {}, 1, ""),
                             {Point<2>(0, 0), Point<2>(1, 1)});
  EXPECT_TRUE(half.contains(Point<2>(0.2, 0.8)));
  EXPECT_FALSE(half.contains(Point<2>(0.8, 0.2)));
  EXPECT_FALSE(half.contains(Point<2>(0.2, 1.1)));
}



TEST(Shapes, UnionSpansItsParts)
{
  const UnionShape<2> both(
    {std::make_shared<BallShape<2>>(Point<2>(0, 0), 1),
     std::make_shared<BoxShape<2>>(Point<2>(2, 2), Point<2>(3, 3))});
  EXPECT_TRUE(both.contains(Point<2>(0, -1)));
  EXPECT_TRUE(both.contains(Point<2>(2.5, 2.5)));
  EXPECT_FALSE(both.contains(Point<2>(1.5, 1.5)));
  EXPECT_EQ(both.bounding_box().first, Point<2>(-1, -1));
  EXPECT_EQ(both.bounding_box().second, Point<2>(3, 3));
}
