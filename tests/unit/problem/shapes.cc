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



TEST(Shapes, BlockIsAQuadrilateral)
{
  // Cook's panel, in deal.II's order of vertices
  const BlockShape<2>::Vertices vertices = {
    {Point<2>(0, 0), Point<2>(48, 44), Point<2>(0, 44), Point<2>(48, 60)}};
  const BlockShape<2> panel(vertices);
  EXPECT_EQ(panel.bounding_box().second, Point<2>(48, 60));
  EXPECT_LT(panel.place(Point<2>(0.5, 0.5)).distance(Point<2>(24, 37)), 1e-12);
  for (const auto &[x, y] :
       {std::pair(0., 0.), {48., 60.}, {24., 22.01}, {24., 51.99}, {47.9, 44.}})
    EXPECT_TRUE(panel.contains(Point<2>(x, y))) << x << ", " << y;
  for (const auto &[x, y] : {std::pair(24., 21.99),
                             {24., 52.01},
                             {-0.01, 20.},
                             {48.01, 50.},
                             {48., 60.1},
                             {1e3, -1e3},
                             {-200., 300.}})
    EXPECT_FALSE(panel.contains(Point<2>(x, y))) << x << ", " << y;

  EXPECT_NEAR(panel.volume({Point<2>(0, 0), Point<2>(1, 1)}), 1440, 1e-10);
  EXPECT_NEAR(panel.volume({Point<2>(0, 0), Point<2>(0.5, 1)}), 888, 1e-10);
}



TEST(Shapes, BlockIsAHexahedronWithBentFaces)
{
  // A cube with one corner pulled out: its volume follows from the average of
  // the trilinear map's determinant, here by another rule.
  BlockShape<3>::Vertices vertices;
  for (unsigned int i = 0; i < 8; ++i)
    vertices[i] = Point<3>(i & 1, i >> 1 & 1, i >> 2 & 1);
  vertices[7] = Point<3>(1.5, 1.4, 1.3);
  const BlockShape<3> block(vertices);
  const unsigned int  n   = 40;
  double              sum = 0;
  for (unsigned int i = 0; i < n * n * n; ++i)
    sum += determinant(block.jacobian(Point<3>((i % n + 0.5) / n,
                                               (i / n % n + 0.5) / n,
                                               (i / n / n + 0.5) / n))) /
           (n * n * n);
  const Point<3> one(1, 1, 1);
  EXPECT_NEAR(block.volume({Point<3>(), one}), sum, 1e-4);
  EXPECT_NEAR(block.volume({Point<3>(), Point<3>(0.3, 1, 1)}) +
                block.volume({Point<3>(0.3, 0, 0), one}),
              block.volume({Point<3>(), one}),
              1e-14);

  EXPECT_TRUE(block.contains(block.place(Point<3>(0.99, 0.99, 0.99))));
  EXPECT_TRUE(block.contains(block.place(Point<3>(1, 0.5, 0.5))));
  EXPECT_FALSE(block.contains(block.place(Point<3>(1.01, 0.5, 0.5))));
  EXPECT_FALSE(block.contains(Point<3>(1.2, 0.1, 0.1)));
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
