// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>

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
