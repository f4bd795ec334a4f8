// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/grid/covered_sides.h>
#include <limber/problem/closed_surface.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/signed_distance.h>

#include <gtest/gtest.h>
#include <support/triangles.h>

#include <cmath>

/** @file Where obstacles are and how far places are from them. */

using namespace limber;
using dealii::Point;
using dealii::Tensor;

namespace
{
  const std::string scene_with_obstacle = R"(
    set Bodies = block
    set Obstacles = thing
    subsection Body block
      subsection Box
        set Lower corner = 0, 3
        set Upper corner = 1, 4
      end
    end
    subsection Obstacle thing
      set Centre = 2, 1
    end
    subsection Grid
      set Upper corner = 4, 4
      set Cells = 8, 8
    end)";

  const std::string scene_in_space = R"(
    set Dimension = 3
    set Bodies = block
    set Obstacles = thing
    subsection Body block
      subsection Box
        set Lower corner = 0, 3, 0
        set Upper corner = 1, 4, 1
      end
    end
    subsection Grid
      set Upper corner = 4, 4, 4
      set Cells = 8, 8, 8
    end)";



  template <int dim>
  Obstacle<dim>
  obstacle_of(const std::string &more)
  {
    return read_problem<dim>(
             SceneFile(ParameterText{
               (dim == 2 ? scene_with_obstacle : scene_in_space) +
                 "\nsubsection Obstacle thing\n" + more + "\nend\n",
               FileFormat::prm,
               "scene"}))
      .obstacles.at(0);
  }



  template <int dim>
  void
  expect_distance(const SignedDistance<dim> &found,
                  const double               value,
                  const Tensor<1, dim>      &normal,
                  const double               tolerance = 1e-12)
  {
    EXPECT_NEAR(found.value, value, tolerance);
    EXPECT_NEAR((found.normal - normal / normal.norm()).norm(), 0, tolerance);
  }



  Tensor<1, 2>
  plane_vector(const double x, const double y)
  {
    return Point<2>(x, y);
  }
} // namespace



TEST(Obstacles, HalfSpace)
{
  const HalfSpaceShape<2> shape(Point<2>(1, 1), plane_vector(3, 4));
  EXPECT_TRUE(shape.contains(Point<2>(0, 0)));
  EXPECT_FALSE(shape.contains(Point<2>(2, 2)));
  expect_distance(*shape.signed_distance(Point<2>(2, 3)),
                  11. / 5,
                  plane_vector(3, 4));
}



TEST(Obstacles, DistancesFromBoxes)
{
  const BoxShape<2> box(Point<2>(1, 1), Point<2>(3, 2));
  expect_distance(*box.signed_distance(Point<2>(2, 2.5)),
                  0.5,
                  plane_vector(0, 1));
  expect_distance(*box.signed_distance(Point<2>(1.1, 1.5)),
                  -0.1,
                  plane_vector(-1, 0));
  expect_distance(*box.signed_distance(Point<2>(3.3, 2.4)),
                  0.5,
                  plane_vector(3, 4));
  const BoxShape<3> cube(Point<3>(0, 0, 0), Point<3>(1, 1, 1));
  expect_distance<3>(*cube.signed_distance(Point<3>(1.2, 1.3, 1.6)),
                     0.7,
                     Point<3>(2, 3, 6));
  expect_distance<3>(*cube.signed_distance(Point<3>(1.3, 0.5, -0.4)),
                     0.5,
                     Point<3>(3, 0, -4));
}



TEST(Obstacles, DistancesFromWhatIsRound)
{
  expect_distance(
    *BallShape<2>(Point<2>(1, 0), 0.5).signed_distance(Point<2>(1.3, 0.4)),
    0,
    plane_vector(3, 4));
  const CylinderShape<3> cylinder(2, Point<3>(0, 0, 0), 1, 0, 2);
  expect_distance<3>(*cylinder.signed_distance(Point<3>(0, -0.9, 1)),
                     -0.1,
                     Point<3>(0, -1, 0));
  expect_distance<3>(*cylinder.signed_distance(Point<3>(1.3, 0, 2.4)),
                     0.5,
                     Point<3>(3, 0, 4));
}



// A quadrilateral, whose corners are those of a square that has been turned.
TEST(Obstacles, DistancesFromBlocks)
{
  const double                  r = std::sqrt(0.5);
  const BlockShape<2>::Vertices corners{
    {Point<2>(0, 0), Point<2>(r, r), Point<2>(-r, r), Point<2>(0, 2 * r)}};
  const BlockShape<2> block(corners);
  expect_distance(*block.signed_distance(Point<2>(r, 0)),
                  0.5,
                  plane_vector(1, -1));
  expect_distance(*block.signed_distance(Point<2>(0.1 * r, 0.5 * r)),
                  -0.2,
                  plane_vector(1, -1));
  expect_distance(*block.signed_distance(Point<2>(0, -0.3)),
                  0.3,
                  plane_vector(0, -1));
  // on an edge
  expect_distance(*block.signed_distance(Point<2>(0.5 * r, 0.5 * r)),
                  0,
                  plane_vector(1, -1));
}



// Of a formula that grows by two per metre, and one that is not linear.
TEST(Obstacles, DistancesFromFormulas)
{
  const auto plane = obstacle_of<2>(
    "set Shape = formula\nsubsection Formula\nset Inside = 2*(1 - y)\nend");
  expect_distance(ObstaclePlace<2>(plane, 0.).distance(Point<2>(2, 1.25)),
                  0.25,
                  plane_vector(0, 1),
                  1e-9);
  // not the side of the grid, where the formula goes on
  expect_distance(ObstaclePlace<2>(plane, 0.).distance(Point<2>(0.01, 0.5)),
                  -0.5,
                  plane_vector(0, 1),
                  1e-9);
  const auto disc = obstacle_of<2>("set Shape = formula\nsubsection Formula\n"
                                   "set Inside = 1 - (x-2)^2 - (y-1)^2\nend");
  expect_distance(ObstaclePlace<2>(disc, 0.).distance(Point<2>(2, 2.01)),
                  0.01,
                  plane_vector(0, 1),
                  1e-4);
}



// The nearest of 1280 facets, as when each is asked alone; and a sphere.
TEST(Obstacles, DistancesFromTriangles)
{
  const TestFacets facets = icosphere(3);
  TriangleMesh     mesh;
  for (const TestFacet &facet : facets)
    {
      const unsigned int first = mesh.corners.size();
      mesh.corners.insert(mesh.corners.end(), facet.begin(), facet.end());
      mesh.facets.push_back({{first, first + 1, first + 2}});
    }
  const ClosedSurface surface(mesh);
  for (const Point<3> &place : {Point<3>(0.3, 0.2, 0.4),
                                Point<3>(0.7, -0.5, 0.55),
                                Point<3>(-1.5, 0.1, 0.3),
                                Point<3>(3, 2, -4),
                                Point<3>(0.01, 0.02, 0.98)})
    {
      double nearest = 1e300;
      for (const TestFacet &facet : facets)
        nearest = std::min(nearest,
                           NearestFacet({facet}, surface.bounding_box())(place)
                             .place.distance(place));
      const SignedDistance<3> found = surface.signed_distance(place);
      EXPECT_NEAR(std::abs(found.value), nearest, 1e-14);
      EXPECT_NEAR(found.value, place.norm() - 1, 0.008);
      EXPECT_GT(found.normal * place, 0.99 * place.norm());
    }
}



TEST(Obstacles, DistancesFromUnions)
{
  const auto             two = obstacle_of<2>(R"(
    set Shape = union
    subsection Union
      set Shapes = left, right
      subsection Shape left
        set Shape = ball
        subsection Ball
          set Centre = 0.5, 1
          set Radius = 0.5
        end
      end
      subsection Shape right
        subsection Box
          set Lower corner = 3, 0
          set Upper corner = 5, 2
        end
      end
    end)");
  const ObstaclePlace<2> place(two, 0.);
  expect_distance(place.distance(Point<2>(1.5, 1)), 0.5, plane_vector(1, 0));
  expect_distance(place.distance(Point<2>(2.8, 1)), 0.2, plane_vector(-1, 0));
}



// A half-space that turns about a place of its surface and rises.
TEST(Obstacles, MoveAsTheirFormulasSay)
{
  const auto             rising = obstacle_of<2>(R"(
    set Shape        = half-space
    subsection Half-space
      set Point      = 2, 1
    end
    set Displacement = 0; 0.5*t
    set Rotation     = pi/6*t)");
  const ObstaclePlace<2> place(rising, 1);
  const double           angle = std::acos(-1.) / 6;
  const auto normal = plane_vector(-std::sin(angle), std::cos(angle));
  expect_distance(place.distance(Point<2>(2, 2)),
                  0.5 * std::cos(angle),
                  normal);
  EXPECT_NEAR(place.place_of(Point<2>(3, 1))
                .distance(Point<2>(2 + std::cos(angle), 1.5 + std::sin(angle))),
              0,
              1e-14);
  EXPECT_NEAR(
    place.start_of(place.place_of(Point<2>(3, 2))).distance(Point<2>(3, 2)),
    0,
    1e-14);
}



// A velocity is that of what is there in the middle of a step. So the surface
// of a disc that turns about its centre moves along itself, however far in a
// step, and what is moved alone has the mean velocity.
TEST(Obstacles, VelocityOfAStep)
{
  const auto                 turning = obstacle_of<2>("set Rotation = 3*t");
  const ObstacleMotion<2>    turn(turning, 0.2, 0.1);
  const Point<2>             x(2.3, 1.4); // 0.5 m from the centre
  const dealii::Tensor<1, 2> arm = x - Point<2>(2, 1);
  EXPECT_NEAR(turn.velocity(x) * arm, 0, 1e-14);
  EXPECT_NEAR(turn.velocity(x).norm(), 0.5 * 2 * std::sin(0.15) / 0.1, 1e-13);
  const auto              moved = obstacle_of<2>("set Displacement = t^2; 0");
  const ObstacleMotion<2> motion(moved, 0.2, 0.1);
  EXPECT_NEAR(motion.velocity(x)[0], (0.09 - 0.04) / 0.1, 1e-14);
  EXPECT_NEAR(motion.velocity(x)[1], 0, 1e-14);
}



// In space about any axis; that of a diagonal hands the axes on.
TEST(Obstacles, TurnInSpace)
{
  const auto turning   = obstacle_of<3>(R"(
    set Shape    = half-space
    set Axis     = 2, 2, 2
    set Rotation = 2*pi/3*t)");
  const auto direction = ObstaclePlace<3>(turning, 1).distance(Point<3>());
  EXPECT_NEAR((direction.normal - Tensor<1, 3>(Point<3>(1, 0, 0))).norm(),
              0,
              1e-14);
}



// Every message names the entry and says what to change.
TEST(Obstacles, BadOnesAreRefused)
{
  struct Case
  {
    std::string              more;
    std::vector<std::string> words;
  };
  const std::vector<Case> cases = {
    {"set Shape = half-spice", {"half-spice", "half-space"}},
    {"set Shape = half-space\nsubsection Half-space\nset Normal = 0, 0\nend",
     {"Normal", "no length"}},
    {"set Law = friction", {"lacks its 'Friction coefficient'"}},
    {"set Shape = ball\nsubsection Ball\nset Radius = 0\nend", {"Radius"}},
    {"set Shape = ball\nsubsection Ball\nset Radius = 0.4\nend",
     {"0.8 m thick", "two cells, 1 m"}},
    {"set Shape = formula\nsubsection Formula\nset Inside = 1/(x-x)\nend",
     {"not finite"}},
    {"set Displacement = 1/t; 0", {"Displacement", "not finite", "time 0"}},
    {"set Displacement = x; 0", {"differs from place to place"}},
    {"set Rotation = sqrt(0.5 - t)", {"Rotation", "not finite"}},
  };
  for (const Case &one : cases)
    {
      SCOPED_TRACE(one.more);
      try
        {
          obstacle_of<2>(one.more);
          ADD_FAILURE() << "is accepted";
        }
      catch (const InputError &error)
        {
          const std::string message = error.what();
          for (const std::string &word : one.words)
            EXPECT_NE(message.find(word), std::string::npos) << message;
        }
    }
  EXPECT_THROW(obstacle_of<3>("set Axis = 0, 0, 0"), InputError);
}



TEST(Obstacles, WhatDoesNotGoWithThemIsRefused)
{
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
    {{"Method/Time integration=implicit", "Method/Time step=0.1"},
     "entry 'Time integration'"},
    {{"Observable force/Obstacle=ting"}, "'ting'"}};
  for (const auto &[overrides, words] : cases)
    {
      SCOPED_TRACE(words);
      try
        {
          read_problem<2>(SceneFile(
            ParameterText{
              scene_with_obstacle +
                "\nset Observables = force\nsubsection Observable force\n"
                "set Type = obstacle force\nset Obstacle = thing\n"
                "set Direction = x\nend\n",
              FileFormat::prm,
              "scene"},
            overrides));
          ADD_FAILURE() << "is accepted";
        }
      catch (const InputError &error)
        {
          EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
            << error.what();
        }
    }
}



// Of a half-space that goes along x, from the left side on.
TEST(Obstacles, TakeThePlaceOfSides)
{
  const std::string shape = "set Shape = half-space\nsubsection Half-space\n"
                            "set Point = 0, 0\nset Normal = 1, 0\nend\n";
  const std::vector<Obstacle<2>> piston = {
    obstacle_of<2>(shape + "set Displacement = t; 0\n")};
  constexpr std::uint8_t left = 1, bottom = 4;
  GridDescription<2>     grid;
  grid.upper = Point<2>(4, 4);
  grid.cells = {{4, 4}};
  CoveredSides<2> sides(piston, grid);
  EXPECT_EQ(sides.uncovered(left, Point<2>(0, 1)), 0) << "it begins there";
  EXPECT_EQ(sides.uncovered(left | bottom, Point<2>(0, 0)), bottom);
  EXPECT_EQ(sides.uncovered(bottom, Point<2>(0.5, 0)), bottom);
  const auto version = sides.version();
  sides.find(1);
  EXPECT_NE(sides.version(), version);
  EXPECT_EQ(sides.uncovered(bottom, Point<2>(0.5, 0)), bottom)
    << "what is behind it on the floor cannot go through that";
  sides.find(-1);
  EXPECT_EQ(sides.uncovered(left, Point<2>(0, 1)), left) << "it is outside";

  // What stays where it is leaves sides alone, also if it turns there.
  const std::vector<Obstacle<2>> wall = {obstacle_of<2>(shape)};
  EXPECT_EQ(CoveredSides<2>(wall, grid).uncovered(left, Point<2>(0, 1)), left);
}



TEST(Obstacles, ThatAreRoundTurnWhereTheyAre)
{
  const auto changes = [](const std::string &more) {
    return obstacle_of<2>(
             "set Shape = ball\nset Rotation = t\nsubsection Ball\n"
             "set Centre = 2, 1\nset Radius = 0.5\nend\n" +
             more)
      .changes_place();
  };
  EXPECT_FALSE(changes(""));
  EXPECT_TRUE(changes("set Centre = 2, 1.1\n"));
  EXPECT_TRUE(changes("set Displacement = t; 0\n"));
  const CylinderShape<3> cylinder(2, Point<3>(1, 2, 0), 0.5, 0, 1);
  EXPECT_TRUE(cylinder.is_round_about(Point<3>(1, 2, 7), Point<3>(0, 0, -1)));
  EXPECT_FALSE(cylinder.is_round_about(Point<3>(1, 2, 7), Point<3>(0, 1, 0)));
  EXPECT_FALSE(cylinder.is_round_about(Point<3>(1, 1, 0), Point<3>(0, 0, 1)));
}
