// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/output/health_figures.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <cmath>

/**
 * @file Liquids whose pressure is implicit at rigid obstacles: at rest, at the
 * bulk modulus of water, they stay at rest and give obstacles their load.
 */

using namespace limber;

namespace
{
  // One metre deep; what is over or beside the obstacle follows
  const std::string pool = R"(
    set Bodies = water
    set Obstacles = bed
    subsection Body water
      set Shape = formula
      subsection Formula
        set Upper corner = 1, 1
      end
      set Points per cell edge = 3
      set Placement = cut
      set Initial pressure = hydrostatic
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 2.2e9
      end
    end
    subsection Grid
      set Upper corner = 1, 1.5
      set Cells = 8, 12
    end
    subsection Loads
      set Gravity = 0, -9.81
    end
    subsection Method
      set Time integration = semi-implicit
    end)";

  /** Largest kinetic energy within a second, J; the impulses of the obstacle
   * per second over the second half of it, N, by @p force. */
  double
  largest_motion(SceneRun<2> &run, dealii::Tensor<1, 3> &force)
  {
    double     largest = 0;
    const auto look    = [&]() {
      largest = std::max(largest, run.totals().all.kinetic_energy);
    };
    run.advance_to(0.5, look);
    const auto before = run.totals().obstacles[0].impulse;
    run.advance_to(1, look);
    const auto after = run.totals().obstacles[0].impulse;
    for (int d = 0; d < 2; ++d)
      force[d] = (after[d] - before[d]) / 0.5;
    return largest;
  }
} // namespace



// Beside walls and over floors anywhere in a cell, those that leave a
// twentieth of it open as well: to round-off.
TEST(ImplicitPressureAtObstacles, WaterRestsBesideWallsAndOverFloors)
{
  for (const double open : {0.05, 0.14, 0.3, 0.7})
    for (const bool is_floor : {true, false})
      {
        const double place = 0.5 - 0.125 * open;
        SCOPED_TRACE(std::string(is_floor ? "floor" : "wall") +
                     " that leaves " + std::to_string(open));
        const std::string    end   = std::to_string(place);
        const std::string    along = is_floor ? "y" : "x";
        SceneRun<2>          run(pool,
                        {"Body water/Formula/Inside=min(1 - y, " + along +
                                    " - " + end + ")",
                                  "Obstacle bed/Shape=half-space",
                                  "Obstacle bed/Half-space/Point=" + end + ", " + end,
                                  std::string("Obstacle bed/Half-space/Normal=") +
                                    (is_floor ? "0, 1" : "1, 0")});
        dealii::Tensor<1, 3> force;
        EXPECT_LT(largest_motion(run, force), 1e-8);
        const double depth = is_floor ? 1 - place : 1;
        const double load  = is_floor ? 9810 * depth : 9810 * depth * depth / 2;
        // what is in the last row shares its load with the side
        if (is_floor)
          EXPECT_NEAR(force[1], load, 1e-4 * load);
        else
          EXPECT_NEAR(force[0], load, 1e-4 * load);
        EXPECT_NEAR(run.totals().energy_drift, 0, 1e-6);
      }
}



// The weight over a slope across the cells, and the push against it.
TEST(ImplicitPressureAtObstacles, WaterRestsOverSlopes)
{
  for (const double degrees : {10., 30., 45.})
    {
      SCOPED_TRACE(degrees);
      const double         slope = std::tan(degrees * M_PI / 180);
      SceneRun<2>          run(pool,
                      {"Grid/Cells=16, 24",
                                "Body water/Formula/Inside=min(1 - y, y - (x - 0.3)*" +
                                  std::to_string(slope) + ")",
                                "Obstacle bed/Shape=half-space",
                                "Obstacle bed/Half-space/Point=0.3, 0",
                                "Obstacle bed/Half-space/Normal=" +
                                  std::to_string(-std::sin(degrees * M_PI / 180)) +
                                  ", " +
                                  std::to_string(std::cos(degrees * M_PI / 180))});
      dealii::Tensor<1, 3> force;
      EXPECT_LT(largest_motion(run, force), 0.01);
      const double top = 0.7 * slope;
      EXPECT_NEAR(force[1], 9810 * (0.7 - 0.35 * top), 0.01 * 9810 * 0.7);
      EXPECT_NEAR(run.totals().energy_drift, 0, 1e-6);
    }
}



namespace
{
  /** Of all obstacles and points, the deepest within one, in cells. */
  template <int dim>
  double
  deepest_point(const SceneRun<dim> &run)
  {
    double result = 0;
    for (const ObstacleFigures &obstacle : look_at_obstacles(run.state()))
      result = std::max(result, obstacle.depth);
    return result;
  }

  const std::vector<std::string> over_slope_of_30_degrees = {
    "Grid/Cells=16, 24",
    "Body water/Formula/Inside=min(1 - y, y - 0.577350269189626*(x - 0.3))",
    "Obstacle bed/Shape=half-space",
    "Obstacle bed/Half-space/Point=0.3, 0",
    "Obstacle bed/Half-space/Normal=-0.5, 0.866025403784439"};

  std::vector<std::string>
  with(std::vector<std::string>        settings,
       const std::vector<std::string> &others)
  {
    settings.insert(settings.end(), others.begin(), others.end());
    return settings;
  }
} // namespace



// The points of water that moves stay outside; what happens to those that are
// put back is on record. The level sinks by .026.
TEST(ImplicitPressureAtObstacles, PointsOfMovingWaterStayOutside)
{
  SceneRun<2>  run(pool,
                  with(over_slope_of_30_degrees,
                       {"Body water/Initial velocity=0.3*y; 0"}));
  const double before  = run.totals().all.gravitational_energy;
  double       deepest = 0, lowest = before, highest = before;
  run.advance_to(4, [&]() {
    const double now = run.totals().all.gravitational_energy;
    deepest          = std::max(deepest, deepest_point(run));
    lowest           = std::min(lowest, now);
    highest          = std::max(highest, now);
  });
  EXPECT_GT(lowest, 0.96 * before);
  EXPECT_LT(highest, 1.01 * before);
  EXPECT_LT(deepest, 1e-9);
  EXPECT_GT(run.totals().put_out, 100);
  EXPECT_NEAR(run.totals().energy_drift, 0, 1e-6);
  EXPECT_LT(run.totals().momentum_error, 1e-12);
}



// What alternates along the surface does not grow, and the water stays at rest
// where its surface meets the slope.
TEST(ImplicitPressureAtObstacles, WaterStaysAtRestOverSlopes)
{
  for (const auto &[degrees, most] :
       {std::pair(20., 0.05), std::pair(60., 3.)}) // of 5 kJ
    {
      SCOPED_TRACE(degrees);
      const double slope = std::tan(degrees * M_PI / 180);
      SceneRun<2>  run(pool,
                      {"Grid/Cells=16, 24",
                        "Body water/Formula/Inside=min(1 - y, y - (x - 0.3)*" +
                          digits(slope) + ")",
                        "Obstacle bed/Shape=half-space",
                        "Obstacle bed/Half-space/Point=0.3, 0",
                        "Obstacle bed/Half-space/Normal=" +
                          digits(-std::sin(degrees * M_PI / 180)) + ", " +
                          digits(std::cos(degrees * M_PI / 180))});
      run.advance_to(4);
      EXPECT_LT(run.totals().all.kinetic_energy, most);
      EXPECT_NEAR(run.totals().energy_drift, 0, 1e-6);
    }
}



// A disc that is set in motion slowly takes the water along that its potential
// flow holds: added mass 1.19 rho pi R^2 between these walls under a free
// surface (finite volumes, 64 cells per metre).
TEST(ImplicitPressureAtObstacles, ADiscMovesItsAddedMass)
{
  SceneRun<2> run(
    pool,
    {"Grid/Cells=16, 24",
     "Body water/Formula/Inside=min(1 - y, sqrt((x - 0.5)^2 + (y - 0.45)^2) - "
     "0.2)",
     "Obstacle bed/Shape=ball",
     "Obstacle bed/Ball/Centre=0.5, 0.45",
     "Obstacle bed/Ball/Radius=0.2",
     "Obstacle bed/Displacement=0.1*(1 - cos(3*t)); 0"});
  run.advance_to(0.1);
  const double speed = 0.3 * std::sin(0.3);
  const double exact = 0.5 * 1.19 * 1000 * M_PI * 0.04 * speed * speed;
  EXPECT_NEAR(run.totals().all.kinetic_energy, exact, 0.1 * exact);
  run.advance_to(2); // to and fro
  EXPECT_LT(deepest_point(run), 1e-9);
  EXPECT_NEAR(run.totals().energy_drift, 0, 1e-6);
  EXPECT_LT(run.totals().momentum_error, 1e-12);
}



// The same in explicit steps, with the tips of cells that the disc leaves: a
// disc with steps where these are closed moves a third more. No point gets in.
TEST(ImplicitPressureAtObstacles, ADiscMovesItsAddedMassInExplicitSteps)
{
  SceneRun<2> run(
    pool,
    {"Method/Time integration=explicit",
     "Body water/Newtonian fluid/Bulk modulus=1e6",
     "Grid/Cells=32, 48",
     "Body water/Formula/Inside=min(1 - y, sqrt((x - 0.5)^2 + (y - 0.45)^2) - "
     "0.2)",
     "Obstacle bed/Shape=ball",
     "Obstacle bed/Ball/Centre=0.5, 0.45",
     "Obstacle bed/Ball/Radius=0.2",
     "Obstacle bed/Displacement=0.1*(1 - cos(3*t)); 0"});
  run.advance_to(0.1);
  const double speed = 0.3 * std::sin(0.3);
  const double exact = 0.5 * 1.19 * 1000 * M_PI * 0.04 * speed * speed;
  EXPECT_NEAR(run.totals().all.kinetic_energy, exact, 0.15 * exact);
  run.advance_to(0.5);
  EXPECT_LT(deepest_point(run), 1e-9);
  EXPECT_NEAR(run.totals().energy_drift, 0, 0.02);
  EXPECT_LT(run.totals().momentum_error, 1e-12);
}



// Over slopes whose tips are thinner than the step allows for: they give way
// more than other cells and are at rest.
TEST(ImplicitPressureAtObstacles, WaterRestsOverSlopesInExplicitSteps)
{
  for (const char *const place : {"0.25", "0.32"})
    {
      SCOPED_TRACE(place);
      SceneRun<2> run(pool,
                      {"Method/Time integration=explicit",
                       "Body water/Newtonian fluid/Bulk modulus=1e6",
                       "Grid/Cells=16, 24",
                       std::string("Body water/Formula/Inside=min(1 - y, y - "
                                   "0.363970234266202*(x - ") +
                         place + "))",
                       "Obstacle bed/Shape=half-space",
                       std::string("Obstacle bed/Half-space/Point=") + place +
                         ", 0",
                       "Obstacle bed/Half-space/Normal=-0.342020143325669, "
                       "0.939692620785908"});
      run.advance_to(1);
      EXPECT_LT(run.totals().all.kinetic_energy, 0.002);
      EXPECT_NEAR(run.totals().energy_drift, 0, 0.005);
    }
}



// In three dimensions, where a ball moves obliquely next to a slope that ends
// at a side: no point gets into either.
TEST(ImplicitPressureAtObstacles, PointsStayOutsideInThreeDimensions)
{
  SceneRun<3> run(R"(
    set Dimension = 3
    set Bodies = water
    set Obstacles = bed, ball
    subsection Body water
      set Shape = formula
      subsection Formula
        set Inside = min(min(0.9 - z, z - 0.5*(x - 0.3) - 0.2*y), sqrt((x - 0.4)^2 + (y - 0.5)^2 + (z - 0.55)^2) - 0.2)
        set Upper corner = 1, 1, 1
      end
      set Placement = cut
      set Initial pressure = hydrostatic
      set Initial velocity = 0.3*z; 0.2*z; 0
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Bulk modulus = 2.2e9
      end
    end
    subsection Obstacle bed
      set Shape = half-space
      subsection Half-space
        set Point = 0.3, 0, 0
        set Normal = -0.5, -0.2, 1
      end
    end
    subsection Obstacle ball
      set Shape = ball
      subsection Ball
        set Centre = 0.4, 0.5, 0.55
        set Radius = 0.2
      end
      set Displacement = 0.05*(1 - cos(4*t)); 0.03*(1 - cos(4*t)); -0.02*(1 - cos(4*t))
    end
    subsection Grid
      set Upper corner = 1, 1, 1.5
      set Cells = 8, 8, 12
    end
    subsection Loads
      set Gravity = 0, 0, -9.81
    end
    subsection Method
      set Time integration = semi-implicit
    end)");
  double      deepest = 0;
  run.advance_to(1, [&]() { deepest = std::max(deepest, deepest_point(run)); });
  EXPECT_LT(deepest, 1e-9);
  EXPECT_GT(run.totals().put_out, 10);
  EXPECT_NEAR(run.totals().energy_drift, 0, 1e-4);
  EXPECT_LT(run.totals().momentum_error, 1e-12);
}



// What does not go with an implicit pressure at obstacles is refused.
TEST(ImplicitPressureAtObstacles, FrictionIsRefused)
{
  EXPECT_THROW(SceneRun<2>(pool,
                           {"Body water/Formula/Inside=min(1 - y, y - 0.3)",
                            "Obstacle bed/Shape=half-space",
                            "Obstacle bed/Half-space/Point=0, 0.3",
                            "Obstacle bed/Law=stick"}),
               InputError);
}
