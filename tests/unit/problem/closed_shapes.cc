// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/points/shape_volume.h>
#include <limber/problem/file_shapes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <random>
#include <sstream>

#include "support/triangles.h"

/** @file Polygons and surfaces of triangles: what is inside, what is wrong. */

using namespace limber;
using dealii::Point;
using dealii::Tensor;
using dealii::numbers::PI;

namespace
{
  ClosedPolygon
  polygon(const std::string &text, const FilePlacement<2> &placement = {})
  {
    return read_polygon_text({"outline.csv", text}, placement);
  }



  TriangleMesh
  stl(const std::string &bytes, const FilePlacement<3> &placement = {})
  {
    return read_stl_text({"part.stl", bytes}, placement);
  }



  ClosedSurface
  surface_of(const TestFacets &facets)
  {
    return ClosedSurface(stl(ascii_stl(facets)));
  }



  template <int dim>
  Point<dim>
  random_place(std::mt19937 &random, const double lower, const double upper)
  {
    Point<dim> place;
    for (int d = 0; d < dim; ++d)
      place[d] = lower + (upper - lower) * (random() / 4294967296.);
    return place;
  }



  /** x, y of a gear of so many teeth and vertices. */
  std::string
  gear(const unsigned int n, const unsigned int teeth)
  {
    std::ostringstream text;
    text.precision(17);
    for (unsigned int i = 0; i < n; ++i)
      {
        const double angle  = 2 * PI * i / n;
        const double radius = 1 + 0.2 * std::sin(teeth * angle);
        text << radius * std::cos(angle) << ", " << radius * std::sin(angle)
             << '\n';
      }
    return text.str();
  }



  template <class Read>
  std::string
  message_of(const Read &read)
  {
    try
      {
        read();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  void
  expect_message(const std::string              &message,
                 const std::vector<std::string> &expected)
  {
    EXPECT_FALSE(message.empty()) << "The file was taken.";
    for (const std::string &fragment : expected)
      EXPECT_NE(message.find(fragment), std::string::npos)
        << "expected: " << fragment << "\nin: " << message;
    std::istringstream words(message);
    const auto n = std::distance(std::istream_iterator<std::string>(words),
                                 std::istream_iterator<std::string>());
    EXPECT_GE(n, 15) << message;
    EXPECT_LE(n, 40) << message;
  }
} // namespace



// A square with a hole in which there is an island, whichever way they go.
TEST(ClosedPolygon, LoopsWithinLoopsAreHoles)
{
  const std::string square = "0, 0\n4, 0\n4, 4\n0, 4\n",
                    hole   = "1;1\n1;3\n3;3\n3;1\n",
                    back   = "3 1\n3 3\n1 3\n1 1\n1 1\n3 1\n",
                    island = "# in the middle\n1.5\t1.5\n2.5\t1.5\n2\t2.5\n";
  for (const std::string &inner : {hole, back})
    {
      const ClosedPolygon region =
        polygon("x, y\n" + square + "\n" + inner + "\n\n" + island);
      EXPECT_NEAR(region.area(), 16 - 4 + 0.5, 1e-14);
      EXPECT_TRUE(region.contains(Point<2>(0.5, 2)));
      EXPECT_FALSE(region.contains(Point<2>(1.2, 1.2)));
      EXPECT_TRUE(region.contains(Point<2>(2, 2)));
      // at the heights of vertices, where a ray meets two edges at once
      EXPECT_TRUE(region.contains(Point<2>(0.5, 1)));
      EXPECT_TRUE(region.contains(Point<2>(0.5, 1.5)));
      EXPECT_FALSE(region.contains(Point<2>(1.2, 2.5)));
      EXPECT_TRUE(region.contains(Point<2>(3.5, 2.5)));
      EXPECT_FALSE(region.contains(Point<2>(4.5, 1)));
      EXPECT_EQ(region.bounding_box().second, Point<2>(4, 4));
    }
}



TEST(ClosedPolygon, AgreesWithTheFormulaOfItsOutline)
{
  const unsigned int  teeth  = 12;
  const ClosedPolygon region = polygon(gear(5000, teeth));
  // the integral of r^2 / 2
  EXPECT_NEAR(region.area(), PI * (1 + 0.02), 1e-5);
  std::mt19937 random;
  for (unsigned int i = 0; i < 20000; ++i)
    {
      const Point<2> place = random_place<2>(random, -1.3, 1.3);
      const double   angle = std::atan2(place[1], place[0]);
      const double   depth = 1 + 0.2 * std::sin(teeth * angle) - place.norm();
      if (std::abs(depth) > 1e-4)
        {
          EXPECT_EQ(region.contains(place), depth > 0) << place;
        }
    }
}



TEST(ClosedPolygon, IsCountedToOneThousandth)
{
  const auto            region = polygon("0,0\n3,0\n3,1\n1,1\n1,3\n0,3\n\n"
                                         ".2,.2\n.8,.2\n.8,.8\n.2,.8\n");
  const PolygonShape<2> plate(region, "");
  ASSERT_TRUE(plate.exact_volume());
  EXPECT_NEAR(*plate.exact_volume(), 5 - 0.36, 1e-14);
  EXPECT_NEAR(counted_volume(plate), 4.64, 1e-3 * 4.64);

  // extruded along y: the file has x and z
  const PolygonShape<3> bar(region, "", 1, -1, 1);
  EXPECT_EQ(bar.bounding_box().first, Point<3>(0, -1, 0));
  EXPECT_EQ(bar.bounding_box().second, Point<3>(3, 1, 3));
  EXPECT_TRUE(bar.contains(Point<3>(2.5, 0.5, 0.5)));
  EXPECT_FALSE(bar.contains(Point<3>(0.5, 0.5, 0.5)));
  EXPECT_FALSE(bar.contains(Point<3>(2.5, 1.5, 0.5)));
  EXPECT_NEAR(*bar.exact_volume(), 9.28, 1e-13);
}



TEST(ClosedPolygon, IsScaledRotatedAndShifted)
{
  FilePlacement<2> placement;
  placement.scale       = 0.001;
  placement.rotation[0] = Tensor<1, 2>({0, -1});
  placement.rotation[1] = Tensor<1, 2>({1, 0});
  placement.shift       = Tensor<1, 2>({1, 2});
  const ClosedPolygon bar =
    polygon("0 0\n1000 0\n1000 100\n0 100\n", placement);
  EXPECT_NEAR(bar.area(), 0.1, 1e-14);
  EXPECT_TRUE(bar.contains(Point<2>(0.95, 2.9)));
  EXPECT_FALSE(bar.contains(Point<2>(1.05, 2.1)));
}



TEST(ClosedPolygon, SaysWhichLineIsWrong)
{
  const auto said = [](const std::string &text) {
    return message_of([&]() { polygon(text); });
  };
  expect_message(said("# nothing\n\n"), {"'outline.csv'", "no vertex"});
  expect_message(said("0,0\n1,0\n1,nan\n"), {"'1, nan'", "line 3"});
  expect_message(said("0,0\n1,0\n1,1\n0,one\n"), {"'0, one'", "line 4"});
  expect_message(said("0,0,0\n1,0,0\n1,1,0\n"), {"3 words", "line 1"});
  expect_message(said("0\n1\n"), {"1 word ", "line 1"});
  expect_message(said("0,0\n1,0\n\n1,1\n"), {"2 vertices", "line 3"});
  expect_message(said("0,0\n1,1\n2,2\n"), {"without area", "line 3"});
  // a bow tie
  expect_message(said("0,0\n1,1\n1,0\n0,1\n"), {"line 1", "line 3", "(0, 0)"});
  // a loop that stands twice
  expect_message(said("0,0\n1,0\n1,1\n\n0,0\n1,0\n1,1\n"),
                 {"line 1", "line 5"});
}



TEST(ClosedSurface, WordsOfAnStlFileMayBeInCapitals)
{
  const TestFacets facets = icosphere(1, 0.8, Point<3>(1, 2, 3));
  std::string      text   = ascii_stl(facets);
  std::transform(text.begin(), text.end(), text.begin(), [](const char c) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  });
  EXPECT_EQ(stl(text).facets, stl(ascii_stl(facets)).facets);
}



// 1280 triangles: volume as that of the facets, and within 2 % of the ball.
TEST(ClosedSurface, OfASphereHasTheVolumeOfItsFacets)
{
  const TestFacets facets = icosphere(3, 0.8, Point<3>(1, 2, 3));
  ASSERT_EQ(facets.size(), 1280u);
  const double ball = 4 * PI / 3 * std::pow(0.8, 3);
  for (const bool binary : {false, true})
    {
      const TriangleMesh mesh =
        stl(binary ? binary_stl(facets) : ascii_stl(facets));
      EXPECT_EQ(mesh.corners.size(), 642u);
      const StlShape<3> shape(ClosedSurface(mesh), "");
      ASSERT_TRUE(shape.exact_volume());
      EXPECT_NEAR(*shape.exact_volume(),
                  volume_within(facets),
                  binary ? 1e-6 : 1e-12);
      EXPECT_NEAR(*shape.exact_volume(), ball, 0.02 * ball);
      EXPECT_NEAR(counted_volume(shape),
                  *shape.exact_volume(),
                  1e-3 * *shape.exact_volume());
    }
}



TEST(ClosedSurface, KnowsInsideAlsoInLineWithEdges)
{
  // centre of the sphere off every line of symmetry, and on it
  for (const Point<3> &centre : {Point<3>(), Point<3>(0.01, 0.02, 0.03)})
    {
      const ClosedSurface sphere = surface_of(icosphere(3, 1, centre));
      std::mt19937        random;
      for (unsigned int i = 0; i < 20000; ++i)
        {
          // many in planes in which edges and corners lie
          Point<3> place = random_place<3>(random, -1.1, 1.1);
          for (unsigned int d = 0; d < 3; ++d)
            if (random() % 3 == 0)
              place[d] = centre[d];
          const double r = place.distance(centre);
          if (r < 0.985 || r > 1)
            {
              EXPECT_EQ(sphere.contains(place), r < 1) << place;
            }
        }
    }
  const ClosedSurface cube = surface_of(cube_of_facets());
  for (unsigned int i = 0; i < 21 * 21 * 21; ++i)
    {
      const Point<3> place((i % 21) * 0.125 - 0.75,
                           (i / 21 % 21) * 0.125 - 0.75,
                           (i / 441) * 0.125 - 0.75);
      bool           inside = true, outside = false;
      for (unsigned int d = 0; d < 3; ++d)
        {
          inside &= place[d] > 0 && place[d] < 1;
          outside |= place[d] < 0 || place[d] > 1;
        }
      if (inside || outside)
        {
          EXPECT_EQ(cube.contains(place), inside) << place;
        }
    }
}



TEST(ClosedSurface, CavitiesAreEmptyAndOverlapsAreFilledOnce)
{
  const TestFacets    outer = icosphere(2, 1), inner = icosphere(2, 0.5);
  const ClosedSurface hollow = surface_of(joined(outer, reversed(inner)));
  EXPECT_TRUE(hollow.contains(Point<3>(0.7, 0, 0)));
  EXPECT_FALSE(hollow.contains(Point<3>(0.1, 0.2, 0)));
  EXPECT_FALSE(hollow.volume());

  // as a whole inside out: the same region
  const ClosedSurface inside_out =
    surface_of(reversed(joined(outer, reversed(inner))));
  EXPECT_TRUE(inside_out.contains(Point<3>(0.7, 0, 0)));
  EXPECT_FALSE(inside_out.contains(Point<3>(0.1, 0.2, 0)));

  const ClosedSurface both = surface_of(
    joined(cube_of_facets(), cube_of_facets(Point<3>(0.5, 0.5, 0.5))));
  for (const double x : {0.2, 0.7, 1.2})
    EXPECT_TRUE(both.contains(Point<3>(x, x, x)));
  EXPECT_FALSE(both.contains(Point<3>(1.2, 0.2, 0.2)));
  EXPECT_FALSE(both.volume());
  EXPECT_NEAR(*surface_of(reversed(outer)).volume(),
              volume_within(outer),
              1e-12);
}



TEST(ClosedSurface, WhatWasExportedTwiceIsThereOnce)
{
  const TestFacets  outer = icosphere(2, 1);
  const StlShape<3> shape(ClosedSurface(stl(ascii_stl(joined(outer, outer)))),
                          "");
  ASSERT_TRUE(shape.exact_volume());
  EXPECT_NEAR(*shape.exact_volume(), volume_within(outer), 1e-12);
}



TEST(ClosedSurface, IsScaledRotatedAndShifted)
{
  FilePlacement<3> placement;
  placement.scale = 0.1;
  placement.shift = Tensor<1, 3>({5, 0, 0});
  const ClosedSurface cube(
    stl(ascii_stl(cube_of_facets(Point<3>(0, 0, 10), 10)), placement));
  EXPECT_NEAR(*cube.volume(), 1, 1e-12);
  EXPECT_LT(cube.bounding_box().first.distance(Point<3>(5, 0, 1)), 1e-12);
  EXPECT_TRUE(cube.contains(Point<3>(5.5, 0.5, 1.5)));
}



TEST(ClosedSurface, SaysWhichFacetIsWrong)
{
  const TestFacets sphere = icosphere(1);
  const auto       said   = [](const std::string &bytes) {
    return message_of([&]() { stl(bytes); });
  };

  TestFacets open = sphere;
  open.erase(open.begin() + 7);
  expect_message(said(ascii_stl(open)), {"'part.stl'", "open", "(line ", "3"});
  expect_message(said(binary_stl(open)), {"Facet ", "open", "3 such edges"});

  TestFacets flipped = sphere;
  std::swap(flipped[7][0], flipped[7][1]);
  expect_message(said(ascii_stl(flipped)),
                 {"acet 8", "flipped", "3 such edges"});

  TestFacets flat = sphere;
  flat[3][1]      = flat[3][0];
  expect_message(said(ascii_stl(flat)), {"Facet 4 (line 23)", "no area"});
  TestFacets point = cube_of_facets({}, 0);
  expect_message(said(ascii_stl(point)), {"in one place"});

  TestFacets wild = sphere;
  wild[3][1][2]   = std::nan("");
  expect_message(said(ascii_stl(wild)), {"Line 26", "finite"});
  expect_message(said(binary_stl(wild)), {"Facet 4", "not finite"});

  const std::string whole = ascii_stl(sphere), binary = binary_stl(sphere);
  expect_message(said(whole.substr(0, whole.find("outer", 1000))),
                 {"ends within facet"});
  expect_message(said("x" + binary.substr(1, 999)),
                 {"no STL", "1000 bytes", "80 binary facets"});
  expect_message(said("solid" + binary.substr(5, 995)),
                 {"no STL", "1000 bytes", "80 binary facets"});
  expect_message(said("solid nothing\nendsolid\n"), {"no facet"});
  expect_message(said("solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 "
                      "0 0\n   vertex 1 0 0\n   vertex 1 1 0\n   vertex 0 1 "
                      "0\n  endloop\n"),
                 {"Line 7", "'vertex'", "'endloop'", "four corners"});
}
