// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Bodies in equilibrium with gravity start under the weight of what is
 * straight above.
 */

using namespace limber;
using dealii::Point;

namespace
{
  constexpr double weight_g = 10;



  /** Expects the pressures of a body's points, Pa. */
  template <class Exact>
  void
  expect_pressures(SceneRun<2> &run, const unsigned int body, const Exact exact)
  {
    const auto points = run.points(body);
    ASSERT_GT(points.size, 60u);
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const Point<2> x = run.position(p, body);
        EXPECT_NEAR(points.pressure[p], exact(x), 0.1) << x;
      }
  }



  std::string
  liquid_at_rest(const std::string &name,
                 const std::string &inside,
                 const std::string &density)
  {
    return "subsection Body " + name +
           "\n set Shape = formula\n subsection Formula\n set Inside = " +
           inside +
           "\n end\n set Initial pressure = hydrostatic\n"
           " set Material = newtonian fluid\n subsection Newtonian fluid\n"
           " set Bulk modulus = 1e12\n set Density = " +
           density + "\n end\nend\n";
  }



  const std::string unit_tank = R"(
    subsection Grid
      set Cells = 16, 16
    end
    subsection Loads
      set Gravity = 0, -10
    end
  )";
} // namespace



TEST(WeightAbove, OfALayerIsOnTheLayerBelow)
{
  SceneRun<2> run(
    "set Bodies = water, oil\n" + liquid_at_rest("water", "0.45 - y", "1000") +
    liquid_at_rest("oil", "min(0.8 - y, y - 0.45)", "700") + unit_tank);
  expect_pressures(run, 0, [](const Point<2> &x) {
    return weight_g * (1000 * (0.45 - x[1]) + 700 * 0.35);
  });
  expect_pressures(run, 1, [](const Point<2> &x) {
    return weight_g * 700 * (0.8 - x[1]);
  });
}



// Two pools on the sides of a wall, one body.
TEST(WeightAbove, IsThatOfEachPool)
{
  SceneRun<2> run(
    "set Bodies = water\n" +
    liquid_at_rest("water",
                   "if(x < 0.5, 0.8, 0.3) - y + if(abs(x - 0.5) < "
                   "0.1, -2, 0)",
                   "1000") +
    unit_tank);
  expect_pressures(run, 0, [](const Point<2> &x) {
    return weight_g * 1000 * ((x[0] < 0.5 ? 0.8 : 0.3) - x[1]);
  });
}



// Below the wall that dips into it, water is under the level of the arms.
TEST(WeightAbove, UnderARoofIsThatOfTheHighestPlace)
{
  SceneRun<2> run(
    "set Bodies = water\nset Obstacles = wall\n" +
    liquid_at_rest("water",
                   "min(0.8 - y, max(abs(x - 0.5) - 0.25, 0.25 - y))",
                   "1000") +
    R"(
    subsection Obstacle wall
      subsection Box
        set Lower corner = 0.25, 0.25
        set Upper corner = 0.75, 2
      end
    end
  )" +
    unit_tank);
  expect_pressures(run, 0, [](const Point<2> &x) {
    return weight_g * 1000 * (0.8 - x[1]);
  });
}



// The stress in a slope is that of the soil straight above, and of the water
// on it.
TEST(WeightAbove, InASlopeBeginsAtItsSurface)
{
  SceneRun<2> run(
    "set Bodies = soil, water\n" +
    liquid_at_rest("water", "min(0.8 - y, y - 0.3 - 0.2*x)", "1000") +
    R"(
    subsection Body soil
      set Shape = formula
      subsection Formula
        set Inside = 0.3 + 0.2*x - y
      end
      set Initial stress = K0: 0.4
      set Material = linear elastic
      subsection Linear elastic
        set Density = 2000
        set Young's modulus = 1e10
        set Poisson's ratio = 0.25
      end
    end
  )" +
    unit_tank);
  const double mean = (1 + 2 * 0.4) / 3;
  expect_pressures(run, 0, [mean](const Point<2> &x) {
    const double surface = 0.3 + 0.2 * x[0];
    return mean * weight_g * (2000 * (surface - x[1]) + 1000 * (0.8 - surface));
  });
}
