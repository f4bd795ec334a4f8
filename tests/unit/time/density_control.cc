// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/** @file The volume of liquids in explicit steps (DensityControl). */

using namespace limber;

namespace
{
  const std::string stirred_water = R"(
    set Bodies = water
    subsection Body water
      set Shape = box
      set Points per cell edge = 2
      set Material = newtonian fluid
      set Initial pressure = hydrostatic
      set Initial velocity = 0.1*sin(29*x+13*y*y); 0.1*cos(31*x*y-9*y)
      subsection Box
        set Lower corner = 0, 0
        set Upper corner = 1, 0.5
      end
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 1e6
      end
    end
    subsection Grid
      set Cells = 16, 16
    end
    subsection Loads
      set Gravity = 0, -9.81
    end)";



  /** Bring all points nearer to the floor, by this factor; they know nothing of
   * it. */
  void
  lower(SceneRun<2> &run, const double factor)
  {
    const PointView<2> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.position[1][p] *= factor;
        points.cell[p] = run.nodes.view().bins.cell_at(
          {{points.position[0][p], points.position[1][p]}});
      }
    run.integrator.reinit();
  }



  double
  potential_energy(SceneRun<2> &run)
  {
    const PointView<2> points = run.points();
    double             result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      result += 9.81 * points.mass[p] * points.position[1][p];
    return result;
  }
} // namespace



// What is too dense everywhere rises to where it belongs, and stays there: no
// gradient of what nodes hold tells that it is too dense.
TEST(DensityControl, LiftsWhatHasSunk)
{
  const auto level = [](const std::string &control) {
    SceneRun<2>  run(stirred_water,
                    {"Body water/Density control=" + control,
                      "Body water/Particle shifting=0"});
    const double before = potential_energy(run);
    lower(run, 0.97);
    run.advance_to(3);
    EXPECT_LT(run.totals().momentum_error, 1e-12);
    return potential_energy(run) / before;
  };
  EXPECT_LT(level("0"), 0.97);
  EXPECT_NEAR(level("auto"), 1, 0.01);
}



// What it does to the energy of pressure is on record. (The balance of USL is
// wrong by more than that without it.)
TEST(DensityControl, IsInTheBalanceOfEnergy)
{
  for (const std::string order : {"usf", "musl", "usavg"})
    {
      SCOPED_TRACE(order);
      const auto after = [&](const std::string &control) {
        SceneRun<2> run(stirred_water,
                        {"Body water/Density control=" + control,
                         "Method/Stress update=" + order});
        run.advance_to(1);
        return run.totals();
      };
      const auto with = after("auto"), without = after("0");
      EXPECT_GT(std::abs(with.removed_with_history -
                         without.removed_with_history),
                0.1);
      EXPECT_NEAR(with.energy_drift, without.energy_drift, 0.002);
    }
}



// Nodes at surfaces that counted an excess alone made energy of noise: a dam
// break with four points in a cell, whose surfaces are long, got 1.1 % of its
// energy in addition.
TEST(DensityControl, MakesNoEnergyAtSurfaces)
{
  SceneRun<2>  run(stirred_water,
                  {"Body water/Initial velocity=0; 0",
                    "Body water/Box/Upper corner=1, 2",
                    "Body water/Newtonian fluid/Bulk modulus=4e6",
                    "Grid/Upper corner=5, 3",
                    "Grid/Cells=60, 36"});
  const double at_first = run.totals().all.total_energy();
  run.advance_to(0.68);
  const double at_last = run.totals().all.total_energy();
  EXPECT_LT(at_last, 1.005 * at_first);
  EXPECT_GT(at_last, 0.99 * at_first);
}
