// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/** @file Water at rest on cells of several sizes (HydrostaticLoad). */

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
