// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/problem/surface.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

/**
 * @file Surfaces of shapes in facets: area and volume of second order, and all
 * facets fit together to the last bit.
 */

using namespace limber;
using dealii::Point;
using dealii::Tensor;
using dealii::numbers::PI;

namespace
{
  template <int dim>
  Tensor<1, dim>
  area_vector(const Facet<dim> &facet)
  {
    if constexpr (dim == 2)
      return dealii::cross_product_2d(facet[1] - facet[0]);
    else
      return 0.5 *
             dealii::cross_product_3d(facet[1] - facet[0], facet[2] - facet[0]);
  }



  template <int dim>
  struct Measures
  {
    double         area = 0, volume = 0;
    Tensor<1, dim> sum; // of area vectors: zero if closed

    explicit Measures(const std::vector<Facet<dim>> &facets)
    {
      for (const Facet<dim> &facet : facets)
        {
          const Tensor<1, dim> part = area_vector<dim>(facet);
          area += part.norm();
          sum += part;
          volume += facet[0] * part / dim;
        }
    }
  };



  template <int dim>
  Corners<dim>
  cube(const double lower, const double upper)
  {
    Corners<dim> box;
    for (int d = 0; d < dim; ++d)
      {
        box.first[d]  = lower;
        box.second[d] = upper;
      }
    return box;
  }



  template <int dim>
  std::vector<Facet<dim>>
  facets_of(const Shape<dim>   &shape,
            const double        spacing,
            const Corners<dim> &box = cube<dim>(-2, 2))
  {
    std::array<double, dim> spacings;
    spacings.fill(spacing);
    return surface<dim>(shape, box, spacings);
  }



  /** Every edge (in the plane: corner) is met once in either direction. */
  template <int dim>
  bool
  is_closed(const std::vector<Facet<dim>> &facets)
  {
    std::map<std::array<double, 6>, int> meetings;
    for (const Facet<dim> &facet : facets)
      for (int i = 0; i < dim; ++i)
        {
          const Point<dim>     &a = facet[i], &b = facet[(i + 1) % dim];
          std::array<double, 6> there{}, back{};
          for (int d = 0; d < dim; ++d)
            {
              there[d] = a[d];
              back[d]  = b[d];
              if (dim == 3)
                {
                  there[3 + d] = b[d];
                  back[3 + d]  = a[d];
                }
            }
          if (dim == 2 && i == 1)
            continue;
          ++meetings[there];
          --meetings[back];
        }
    return std::all_of(meetings.begin(), meetings.end(), [](const auto &entry) {
      return entry.second == 0;
    });
  }



  template <int dim>
  Formula<dim>
  formula(const std::string &text)
  {
    return Formula<dim>(text, {}, 1, "test");
  }



  /** A shape with its area and volume. */
  template <int dim>
  struct Known
  {
    std::string                 name;
    std::shared_ptr<Shape<dim>> shape;
    double                      area, volume;
  };



  const std::vector<Known<2>> plane_shapes = {
    {"circle",
     std::make_shared<BallShape<2>>(Point<2>(0.13, -0.21), 1.1),
     2 * PI * 1.1,
     PI * 1.1 * 1.1},
    // half axes 1.5 and 0.8; the perimeter by the trapezoidal rule
    {"ellipse",
     std::make_shared<FormulaShape<2>>(
       formula<2>("1 - ((0.8*x + 0.6*y)/1.5)^2 - ((0.8*y - 0.6*x)/0.8)^2"),
       cube<2>(-2, 2)),
     7.3939790178712546,
     PI * 1.2},
    // Only the sign of a formula counts.
    {"ring by a step",
     std::make_shared<FormulaShape<2>>(
       formula<2>("if(x^2 + y^2 < 2 & x^2 + y^2 > 0.5, 1, -1)"),
       cube<2>(-1.7, 1.9)),
     2 * PI *(std::sqrt(2.) + std::sqrt(0.5)),
     PI * 1.5}};

  // area of the spheroid: 2 pi a^2 (1 + c/(a e) asin e), e^2 = 1 - a^2/c^2
  const double eccentricity = std::sqrt(1 - 0.64 / 2.25);

  const std::vector<Known<3>> spatial_shapes = {
    {"sphere",
     std::make_shared<BallShape<3>>(Point<3>(0.13, -0.21, 0.07), 1.1),
     4 * PI * 1.21,
     4 * PI * 1.331 / 3},
    {"cylinder",
     std::make_shared<CylinderShape<3>>(1,
                                        Point<3>(0.1, 0, 0.2),
                                        0.9,
                                        -0.83,
                                        1.27),
     2 * PI * 0.9 * (2.1 + 0.9),
     PI * 0.81 * 2.1},
    {"spheroid",
     std::make_shared<FormulaShape<3>>(formula<3>(
                                         "1 - (x^2 + y^2)/0.64 - z^2/2.25"),
                                       cube<3>(-2, 2)),
     2 * PI * 0.64 * (1 + 1.5 / 0.8 / eccentricity * std::asin(eccentricity)),
     4 * PI * 0.64 * 1.5 / 3}};



  template <int dim>
  void
  expect_second_order(const std::vector<Known<dim>> &shapes)
  {
    for (const Known<dim> &known : shapes)
      {
        SCOPED_TRACE(known.name);
        double former_area = 0, former_volume = 0;
        // Not one over the other, so that no node repeats.
        for (const double spacing : {0.2, 0.095, 0.0463})
          {
            const auto facets = facets_of<dim>(*known.shape, spacing);
            EXPECT_TRUE(is_closed<dim>(facets));
            const Measures<dim> found(facets);
            EXPECT_LT(found.sum.norm(), 1e-13 * known.area);
            const double area   = std::abs(found.area / known.area - 1),
                         volume = std::abs(found.volume / known.volume - 1);
            if (former_area > 0)
              {
                EXPECT_LT(area, 0.3 * former_area);
                EXPECT_LT(volume, 0.3 * former_volume);
              }
            else
              {
                EXPECT_LT(area, 0.02);
                EXPECT_LT(volume, 0.04);
              }
            former_area   = area;
            former_volume = volume;
          }
      }
  }
} // namespace



TEST(Surface, AreaAndVolumeAreOfSecondOrder)
{
  expect_second_order<2>(plane_shapes);
  expect_second_order<3>(spatial_shapes);
}



// Nodes of the lattice on the surface, flat sides, edges and corners.
TEST(Surface, IsExactForABoxAlongTheLattice)
{
  const BoxShape<2> square(Point<2>(-0.3, 0.1), Point<2>(0.9, 1.3));
  const Measures<2> of_square(facets_of<2>(square, 0.1));
  const BoxShape<3> brick(Point<3>(-0.3, 0.1, 0.2), Point<3>(0.9, 1.3, 0.5));
  const Measures<3> of_brick(facets_of<3>(brick, 0.1));
  EXPECT_NEAR(of_square.area, 4.8, 1e-12);
  EXPECT_NEAR(of_square.volume, 1.44, 1e-12);
  EXPECT_NEAR(of_brick.area, 2 * 1.44 + 4 * 0.36, 1e-12);
  EXPECT_NEAR(of_brick.volume, 0.432, 1e-12);
}



// Corners of a turned square with a square hole, and a flat part between two of
// them; no corner of a circle is one.
TEST(Surface, SharpCornersInThePlaneAreFound)
{
  const FormulaShape<2> frame(
    formula<2>("min(1 - max(abs(0.8*x + 0.6*y), abs(0.8*y - 0.6*x)), "
               "max(abs(0.8*x + 0.6*y), abs(0.8*y - 0.6*x)) - 0.5)"),
    cube<2>(-1.5, 1.5));
  for (const double spacing : {0.2, 0.095, 0.0463})
    {
      const auto        facets = facets_of<2>(frame, spacing);
      const Measures<2> found(facets);
      EXPECT_TRUE(is_closed<2>(facets));
      EXPECT_NEAR(found.area, 12, 1e-9);
      EXPECT_NEAR(found.volume, 3, 1e-9);
      const auto end = part_in<2>(
        [](const Point<2> &x) { return 0.8 * x[0] + 0.6 * x[1] > 0.999; },
        facets);
      EXPECT_NEAR(Measures<2>(end).area, 2.002, 1e-6);
    }
  // with corners on nodes of the lattice
  const FormulaShape<2> rectangle(
    formula<2>("min(min(x, 1 - x), min(y, 0.5 - y))"), cube<2>(-0.2, 1.8));
  EXPECT_NEAR(Measures<2>(facets_of<2>(rectangle, 0.05)).area, 3, 1e-9);
}



// Where parts meet in an edge, a lattice sees two corners across; both
// answers are right, but neighbours must give the same.
TEST(Surface, IsClosedForAnythingWhatever)
{
  const FormulaShape<2> dots(formula<2>("sin(9*x + y*x)*sin(8*y - x) + 0.03"),
                             cube<2>(-1, 1));
  const FormulaShape<3> sponge(
    formula<3>("sin(9*x)*cos(8*y) + sin(7*y)*cos(9*z) + sin(8*z)*cos(9*x)"),
    cube<3>(-1, 1));
  const UnionShape<3> touching(
    {std::make_shared<BoxShape<3>>(Point<3>(-1, -1, -1), Point<3>(0, 0, 0)),
     std::make_shared<BoxShape<3>>(Point<3>(0, 0, -1), Point<3>(1, 1, 0)),
     std::make_shared<BallShape<3>>(Point<3>(0, 0, 0.5), 0.5)});
  for (const double spacing : {0.31, 0.2, 0.1})
    {
      const auto in_plane = facets_of<2>(dots, spacing);
      EXPECT_TRUE(is_closed<2>(in_plane));
      EXPECT_GT(in_plane.size(), 10u);
      for (const Shape<3> *shape : {static_cast<const Shape<3> *>(&sponge),
                                    static_cast<const Shape<3> *>(&touching)})
        {
          const auto facets = facets_of<3>(*shape, spacing);
          EXPECT_TRUE(is_closed<3>(facets));
          EXPECT_GT(Measures<3>(facets).volume, 1);
        }
    }
}



// The part of a shape within the grid has a surface of its own, a closed one.
TEST(Surface, EndsWithTheBox)
{
  const BallShape<3> ball(Point<3>(0, 0, 0), 1);
  const auto         eighth = facets_of<3>(ball, 0.05, cube<3>(0, 2));
  EXPECT_TRUE(is_closed<3>(eighth));
  const Measures<3> measures(eighth);
  EXPECT_NEAR(measures.area, PI / 2 + 3 * PI / 4, 2e-3);
  EXPECT_NEAR(measures.volume, PI / 6, 2e-3);
  EXPECT_TRUE(facets_of<3>(ball, 0.05, cube<3>(1.5, 2)).empty());
}



TEST(Surface, PartsAreCutWhereTheirRegionEnds)
{
  // A cap of height h has the area 2 pi r h.
  const auto   sphere = facets_of<3>(BallShape<3>(Point<3>(), 1), 0.05);
  const double height = 0.237;
  const auto   cap =
    part_in<3>([=](const Point<3> &x) { return x[2] > 1 - height; }, sphere);
  EXPECT_NEAR(Measures<3>(cap).area, 2 * PI * height, 4e-3);
  for (const Facet<3> &facet : cap)
    for (const Point<3> &corner : facet)
      EXPECT_GT(corner[2], 1 - height - 1e-12);
  const auto rest =
    part_in<3>([=](const Point<3> &x) { return !(x[2] > 1 - height); }, sphere);
  EXPECT_LT((Measures<3>(cap).sum + Measures<3>(rest).sum).norm(), 1e-12);
  EXPECT_NEAR(Measures<3>(cap).area + Measures<3>(rest).area,
              Measures<3>(sphere).area,
              1e-11);

  const auto circle = facets_of<2>(BallShape<2>(Point<2>(), 1), 0.05);
  const auto arc =
    part_in<2>([](const Point<2> &x) { return x[1] > 0.5; }, circle);
  EXPECT_NEAR(Measures<2>(arc).area, 2 * PI / 3, 1e-3);
  EXPECT_LT((Measures<2>(arc).sum - Point<2>(0, std::sqrt(3.))).norm(), 1e-3);
}
