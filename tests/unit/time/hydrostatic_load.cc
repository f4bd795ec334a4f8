// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <cmath>

/** @file Water at rest and in free fall (HydrostaticLoad). */

using namespace limber;

namespace
{
  /**
   * Water under a pressure that grows with the depth, with fine cells where a
   * formula is positive.
   */
  std::string
  tank(const int dim, const std::string &fine)
  {
    const auto in_3d = [&](const std::string &text) {
      return dim == 3 ? text : "";
    };
    return "set Dimension = " + std::to_string(dim) +
           "\nset End time = 10\nset Bodies = water\nsubsection Body water\n"
           " set Shape = box\n subsection Box\n set Lower corner = 0, 0" +
           in_3d(", 0") + "\n set Upper corner = 1.5, 1" + in_3d(", 1") +
           "\n end\n set Points per cell edge = 2\n"
           " set Initial pressure = hydrostatic\n"
           " set Material = newtonian fluid\n"
           " subsection Newtonian fluid\n set Density = 1000\n"
           " set Bulk modulus = 1e8\n end\nend\n"
           "subsection Grid\n set Upper corner = 1.5, 1.5" +
           in_3d(", 1") + "\n set Cells = 6, 6" + in_3d(", 4") +
           "\n set Levels = 1\n set Refine = part\n"
           " subsection Refine part\n set Where = " +
           fine +
           "\n end\nend\nsubsection Loads\n"
           " set Gravity = 0, -9.81" +
           in_3d(", 0") + "\nend\n";
  }



  constexpr double gravity_of_tank = 9.81;



  /** That points are slow after some steps, against those in free fall. */
  template <int dim>
  void
  expect_rest(const std::string &fine)
  {
    SCOPED_TRACE(std::to_string(dim) + "d, " + fine);
    SceneRun<dim> run(tank(dim, fine));
    ASSERT_FALSE(run.grid.vertices.hanging.empty());
    const double step = 0.5 * run.integrator.longest_step();
    run.advance(step, 20);

    const PointView<dim> points = run.points();
    double               speed  = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      speed = std::max(speed, run.velocity(p).norm());
    // As dense as the depth makes them, cells do not cancel to the last bit:
    // rho g h / K is 2.5e-5.
    EXPECT_LT(speed, 1e-5 * gravity_of_tank * run.time);
  }
} // namespace



// Without the load, corners of fine regions start with some g/16.
TEST(HydrostaticLoad, KeepsWaterAtRestOnCellsOfSeveralSizes)
{
  const std::string middle = "0.3 - sqrt((x - 0.9)^2 + (y - 0.4)^2)",
                    side   = "0.3 - x"; // from the floor to the surface
  for (const std::string &fine : {middle, side})
    {
      expect_rest<2>(fine);
      expect_rest<3>(fine);
    }
  // corners in all directions
  expect_rest<3>("0.3 - sqrt((x - 0.9)^2 + (y - 0.4)^2 + (z - 0.6)^2)");
}



// What falls has no pressure: no force may act along its surface, which is a
// flight of stairs.
TEST(HydrostaticLoad, LeavesWhatFallsAlone)
{
  const std::vector<double> gravity = {2.5, -9.5};
  SceneRun<2>               run(
    "set Dimension = 2\nset End time = 10\nset Bodies = drop\n"
                  "subsection Body drop\n set Shape = ball\n subsection Ball\n"
                  " set Centre = 0.5, 0.6\n set Radius = 0.25\n end\n"
                  " set Material = newtonian fluid\n subsection Newtonian fluid\n"
                  " set Density = 1000\n set Bulk modulus = 1e6\n end\nend\n"
                  "subsection Grid\n set Cells = 16, 16\nend\n"
                  "subsection Loads\n set Gravity = 2.5, -9.5\nend\n");
  run.advance(2e-4, 100);
  const PointView<2> points = run.points();
  ASSERT_GT(points.size, 100u);
  for (std::size_t p = 0; p < points.size; ++p)
    for (unsigned int d = 0; d < 2; ++d)
      EXPECT_NEAR(points.velocity[d][p],
                  gravity[d] * run.time,
                  1e-9 * std::abs(gravity[d]) * run.time);
}



// Its points are swept into the edge, where some pass it by next to nothing.
TEST(HydrostaticLoad, ThrowsNothingOutOfAnEdge)
{
  SceneRun<2> run(R"(
    set Dimension = 2
    set End time = 10
    set Bodies = water
    set Obstacles = edge
    subsection Body water
      set Shape = formula
      subsection Formula
        set Inside = min(0.6 - y, y - 0.1 - abs(x - 0.5))
      end
      set Material = newtonian fluid
    end
    subsection Obstacle edge
      set Shape = formula
      subsection Formula
        set Inside = max(0.6 - x - y, x - 0.4 - y)
      end
    end
    subsection Grid
      set Upper corner = 1, 0.9
      set Cells = 40, 36
    end
    subsection Loads
      set Gravity = 0, -9.81
    end)");
  run.advance_to(2);
  const PointView<2> points = run.points();
  for (std::size_t p = 0; p < points.size; ++p)
    EXPECT_LT(std::hypot(points.position[0][p] - 0.5,
                         points.position[1][p] - 0.1),
              0.8);
}
