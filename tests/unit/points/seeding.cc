// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/points/seeding.h>
#include <limber/problem/polygon.h>

#include <gtest/gtest.h>

#include <cmath>

/** @file How bodies are filled: volumes and centroids. */

using namespace limber;
using dealii::Point;

namespace
{
  constexpr double density = 3;

  struct Filled
  {
    double                volume = 0;
    dealii::Tensor<1, 2>  centroid;
    dealii::Tensor<2, 2>  spread; // about the centroid
    std::vector<Point<2>> places;
    std::vector<double>   volumes;

    Filled(const std::shared_ptr<const Shape<2>> &shape,
           const Placement                        placement,
           const unsigned int                     n_cells  = 12,
           const unsigned int                     per_edge = 2)
    {
      GridDescription<2> description;
      description.upper = Point<2>(6, 6);
      description.cells = {{n_cells, n_cells}};
      const BackgroundGrid<2> grid(description, MPI_COMM_SELF);
      Body<2>                 body;
      body.shape                = shape;
      body.placement            = placement;
      body.points_per_cell_edge = {{per_edge, per_edge}};
      body.lattice              = {{13, 7}};
      MaterialPoints<2> points(grid, PointLayout());
      seed<2>(
        body, grid, [](const Point<2> &) { return density; }, points);

      const PointView<2> view = points.view();
      for (std::size_t p = 0; p < view.size; ++p)
        {
          places.emplace_back(view.position[0][p], view.position[1][p]);
          volumes.push_back(view.mass[p] / density);
          volume += volumes.back();
          centroid += volumes.back() * places.back();
          std::array<double, 2> x{{places.back()[0], places.back()[1]}};
          EXPECT_EQ(view.cell[p], grid.bins.cell_at(x));
        }
      centroid /= volume;
      for (std::size_t p = 0; p < view.size; ++p)
        spread += volumes[p] / volume *
                  outer_product(places[p] - centroid, places[p] - centroid);
    }
  };



  const BlockShape<2>::Vertices slanted = {{Point<2>(0.3, 0.4),
                                            Point<2>(5.1, 1.3),
                                            Point<2>(0.7, 4.9),
                                            Point<2>(4.2, 5.6)}};



  /** Area and centroid of the block between these vertices. */
  std::pair<double, dealii::Tensor<1, 2>>
  area_and_centroid(const BlockShape<2>::Vertices &v)
  {
    double               area = 0;
    dealii::Tensor<1, 2> centroid;
    const unsigned int   around[] = {0, 1, 3, 2, 0};
    for (unsigned int i = 0; i < 4; ++i)
      {
        const Point<2> a = v[around[i]], b = v[around[i + 1]];
        const double   cross = a[0] * b[1] - a[1] * b[0];
        area += cross / 2;
        centroid += cross / 6 * (a + b);
      }
    return {area, centroid / area};
  }



  /** Mean of (x - c) (x - c)^T over the block between these vertices. */
  dealii::Tensor<2, 2>
  spread_of(const BlockShape<2>::Vertices &v)
  {
    const auto [area, c] = area_and_centroid(v);
    dealii::Tensor<2, 2> result;
    const unsigned int   around[] = {0, 1, 3, 2, 0};
    for (unsigned int i = 0; i < 4; ++i)
      {
        // a triangle with a corner at the centroid
        const dealii::Tensor<1, 2> a = v[around[i]] - c,
                                   b = v[around[i + 1]] - c;
        const double share           = 0.5 * (a[0] * b[1] - a[1] * b[0]) / area;
        result += share / 12 *
                  (outer_product(a, a) + outer_product(b, b) +
                   outer_product(a + b, a + b));
      }
    return result;
  }
} // namespace



TEST(Seeding, FittedPointsFillABlockExactly)
{
  const auto   shape = std::make_shared<BlockShape<2>>(slanted);
  const Filled filled(shape, Placement::fitted);
  const auto [area, centroid] = area_and_centroid(slanted);
  EXPECT_EQ(filled.places.size(), 13u * 7u);
  EXPECT_NEAR(filled.volume, area, 1e-12);
  // each place is not quite the centroid of its part
  EXPECT_LT((filled.centroid - centroid).norm(), 5e-3);
}



TEST(Seeding, CutPartsHaveTheVolumeOfWhatIsInside)
{
  const auto block            = std::make_shared<BlockShape<2>>(slanted);
  const auto [area, centroid] = area_and_centroid(slanted);
  const auto   ball = std::make_shared<BallShape<2>>(Point<2>(2.9, 3.1), 2.3);
  const double disc = 3.14159265358979 * 2.3 * 2.3;

  // less what is left out, a millionth of a part
  const Filled cut(block, Placement::cut);
  EXPECT_NEAR(cut.volume, area, 1e-6 * area);
  EXPECT_LT((cut.centroid - centroid).norm(), 1e-6);
  for (const Point<2> &place : cut.places)
    EXPECT_TRUE(block->contains(place));

  for (const unsigned int n : {6, 12, 24})
    {
      const Filled round(ball, Placement::cut, n);
      EXPECT_NEAR(round.volume, disc, 2e-3 * disc);
      EXPECT_LT((round.centroid - Point<2>(2.9, 3.1)).norm(), 2e-3);
    }
}



// A fifth of a part thick and turned by 30 degrees, it passes between the
// corners and centres of most parts.
TEST(Seeding, CutPartsOfAThinSheetAreFound)
{
  const dealii::Tensor<1, 2> along({3 * std::sqrt(0.75), 1.5}),
    across({-0.025, 0.05 * std::sqrt(0.75)});
  const Point<2>                corner(1.03, 1.02);
  const Point<2>                corners[] = {corner,
                                             corner + along,
                                             corner + along + across,
                                             corner + across};
  const double                  area      = 3 * 0.05;
  const Point<2>                middle    = corner + 0.5 * (along + across);
  const BlockShape<2>::Vertices vertices  = {
     {corners[0], corners[1], corners[3], corners[2]}};
  const Filled block(std::make_shared<BlockShape<2>>(vertices), Placement::cut);
  EXPECT_NEAR(block.volume, area, 2e-5 * area);
  EXPECT_LT((block.centroid - middle).norm(), 1e-4);

  // by 16 x 16 places in each part, which see it three deep
  std::vector<ClosedPolygon::Edge> edges;
  for (int i = 0; i < 4; ++i)
    edges.push_back({{corners[i], corners[(i + 1) % 4]}});
  const Filled polygon(std::make_shared<PolygonShape<2>>(ClosedPolygon(edges),
                                                         ""),
                       Placement::cut);
  EXPECT_NEAR(polygon.volume, area, 0.05 * area);
  EXPECT_LT((polygon.centroid - middle).norm(), 0.05);
}



// Of a box they have all of it, however thin it is: between the centres and
// the corners of parts, and with a face as good as on the edge of some: what
// is beyond, 1e-12 high, makes no points.
TEST(Seeding, CutPartsOfABoxAreExact)
{
  for (const double top : {0.55, 0.62, 1.0 + 1e-12, 2.71})
    {
      const Point<2> lower(1.03, 0.52), upper(3.21, top);
      const Filled   cut(std::make_shared<BoxShape<2>>(lower, upper),
                       Placement::cut);
      const double   area = (upper[0] - lower[0]) * (upper[1] - lower[1]);
      EXPECT_NEAR(cut.volume, area, 1e-11 * area) << top;
      EXPECT_LT((cut.centroid - 0.5 * (lower + upper)).norm(), 1e-11) << top;
      for (const double volume : cut.volumes)
        EXPECT_GT(volume, 1e-6);
    }
}



// Around a corner that points into the body the centroid of what is inside is
// not: three parts make room there for the one of a regular lattice.
TEST(Seeding, CutPartsAroundACornerAreInside)
{
  const auto shape = std::make_shared<FormulaShape<2>>(
    Formula<2>("max(2.08 - x, y - 2.17)", {}, 1, ""),
    Corners<2>(Point<2>(1, 1), Point<2>(4, 4)));
  const Filled cut(shape, Placement::cut);
  const double area = 9 - (4 - 2.08) * (2.17 - 1);
  EXPECT_NEAR(cut.volume, area, 2e-3 * area);
  for (const Point<2> &place : cut.places)
    EXPECT_TRUE(shape->contains(place)) << place;
}



// Where no part is cut, 'cut' is 'regular'.
TEST(Seeding, CutLeavesWholePartsAlone)
{
  const auto box =
    std::make_shared<BoxShape<2>>(Point<2>(1, 0.5), Point<2>(3.25, 2.75));
  const Filled cut(box, Placement::cut), regular(box, Placement::regular);
  ASSERT_EQ(cut.places.size(), regular.places.size());
  for (std::size_t p = 0; p < cut.places.size(); ++p)
    {
      EXPECT_LT(cut.places[p].distance(regular.places[p]), 1e-14);
      EXPECT_NEAR(cut.volumes[p], regular.volumes[p], 1e-15);
    }
}



// Volume, first and second moments: what a body needs to bend with its own
// stiffness, and to turn with its own inertia.
TEST(Seeding, GaussPlacesHaveTheSecondMomentsOfABlock)
{
  const auto block            = std::make_shared<BlockShape<2>>(slanted);
  const auto [area, centroid] = area_and_centroid(slanted);
  for (const unsigned int n_cells : {3, 5, 12})
    for (const unsigned int per_edge : {2, 3})
      {
        const Filled gauss(block, Placement::gauss, n_cells, per_edge);
        EXPECT_NEAR(gauss.volume, area, 2e-6 * area);
        EXPECT_LT((gauss.centroid - centroid).norm(), 2e-6);
        EXPECT_LT((gauss.spread - spread_of(slanted)).norm(), 1e-5);
      }
  // one point in each cell has none of its own
  const Filled one(block, Placement::gauss, 12, 1);
  EXPECT_NEAR(one.volume, area, 2e-6 * area);
  EXPECT_GT((one.spread - spread_of(slanted)).norm(), 1e-3);
}



TEST(Seeding, GaussPlacesHaveTheSecondMomentsOfADisc)
{
  const double radius = 2.3, disc = 3.14159265358979 * radius * radius;
  const auto ball = std::make_shared<BallShape<2>>(Point<2>(2.9, 3.1), radius);
  for (const unsigned int n : {6, 12, 24})
    {
      const Filled round(ball, Placement::gauss, n);
      EXPECT_NEAR(round.volume, disc, 2e-3 * disc);
      for (unsigned int d = 0; d < 2; ++d)
        EXPECT_NEAR(round.spread[d][d], radius * radius / 4, 4e-3);
      EXPECT_NEAR(round.spread[0][1], 0, 2e-3);
    }
}



// In a box that fills cells they are those of Gauss and Legendre; in one that
// does not they are those of the part that it fills, however thin.
TEST(Seeding, GaussPlacesOfABoxAreThoseOfItsPartOfACell)
{
  for (const double top : {0.55, 0.62, 1.0, 2.71})
    for (const unsigned int per_edge : {2, 3})
      {
        const Point<2> lower(1.03, 0.52), upper(3.21, top);
        const Filled   gauss(std::make_shared<BoxShape<2>>(lower, upper),
                           Placement::gauss,
                           12,
                           per_edge);
        const double   area = (upper[0] - lower[0]) * (upper[1] - lower[1]);
        EXPECT_NEAR(gauss.volume, area, 1e-11 * area) << top;
        for (unsigned int d = 0; d < 2; ++d)
          {
            const double edge = upper[d] - lower[d];
            EXPECT_NEAR(gauss.spread[d][d], edge * edge / 12, 1e-11) << top;
          }
        EXPECT_NEAR(gauss.spread[0][1], 0, 1e-11) << top;
        // the first in the part of its cell
        const double nodes[] = {0, 0, 1 / std::sqrt(3.), std::sqrt(0.6)};
        EXPECT_NEAR(gauss.places[0][0],
                    1.03 + 0.235 * (1 - nodes[per_edge]),
                    1e-12);
      }
}



TEST(Seeding, GaussPlacesOfABoxInSpace)
{
  GridDescription<3> description;
  description.upper = Point<3>(4, 4, 4);
  description.cells = {{4, 4, 4}};
  const BackgroundGrid<3> grid(description, MPI_COMM_SELF);
  const Point<3>          lower(0.3, 1, 0.7), upper(3.6, 3, 2.2);
  Body<3>                 body;
  body.shape                = std::make_shared<BoxShape<3>>(lower, upper);
  body.placement            = Placement::gauss;
  body.points_per_cell_edge = {{2, 2, 2}};
  MaterialPoints<3> points(grid, PointLayout());
  seed<3>(
    body, grid, [](const Point<3> &) { return density; }, points);
  const PointView<3>   view = points.view();
  dealii::Tensor<2, 3> spread;
  double               mass = 0;
  for (std::size_t p = 0; p < view.size; ++p)
    {
      dealii::Tensor<1, 3> arm;
      for (unsigned int d = 0; d < 3; ++d)
        arm[d] = view.position[d][p] - 0.5 * (lower[d] + upper[d]);
      spread += view.mass[p] * outer_product(arm, arm);
      mass += view.mass[p];
    }
  EXPECT_NEAR(mass, density * 3.3 * 2 * 1.5, 1e-11);
  for (unsigned int d = 0; d < 3; ++d)
    for (unsigned int e = 0; e < 3; ++e)
      {
        const double edge = upper[d] - lower[d];
        EXPECT_NEAR(spread[d][e], d == e ? mass * edge * edge / 12 : 0, 1e-11);
      }
}
