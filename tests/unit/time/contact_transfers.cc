// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/touching_bodies.h>

/**
 * @file Contact with other transfers than FLIP: the filter of FMPM and XPIC
 * keeps what contact has made of the velocities of nodes, AFLIP its energy.
 */

using namespace limber;
using namespace limber::touching;

namespace
{
  std::string
  disk(const std::string &name,
       const std::string &centre,
       const std::string &radius,
       const std::string &velocity)
  {
    return R"(
    subsection Body )" +
           name + R"(
      set Shape = ball
      set Material = neo hookean
      set Initial velocity = )" +
           velocity + R"(
      subsection Ball
        set Centre = )" +
           centre + R"(
        set Radius = )" +
           radius + R"(
      end
      subsection Neo hookean
        set Density = 1500
        set Young's modulus = 1e9
        set Poisson's ratio = 0.33
      end
    end)";
  }



  // All sides free but those that tests name, cells of half a millimetre
  const std::string pair_of_disks = R"(
    set Bodies = lower, upper
    subsection Contact
      set Pairs = rims
      subsection Pair rims
        set Bodies = lower, upper
      end
    end
    subsection Grid
      set Upper corner = 0.045, 0.045
      set Cells = 90, 90
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end
    subsection Method
      set Kernel = quadratic
      set Courant number = 0.2
    end)";

  // 40 cells over the diameter, each at 1 % of sqrt(E / rho), 1 mm apart
  const std::string large_disks = pair_of_disks +
                                  disk("lower",
                                       "0.015075379475183, 0.015075379475183",
                                       "0.01",
                                       "5.773502691896; 5.773502691896") +
                                  disk("upper",
                                       "0.029924620524817, 0.029924620524817",
                                       "0.01",
                                       "-5.773502691896; -5.773502691896");
} // namespace



// What is lost beyond FLIP, by the order (energy that is left: 0.981, 0.989;
// 0.974, 0.983 if only v(1) were held where they press).
TEST(ContactTransfers, FilteredDisksBounceOffEachOther)
{
  const auto energy_left = [](const std::string &order) {
    SceneRun<2>  run(large_disks,
                    {"Method/Transfer=fmpm", "Method/Transfer order=" + order});
    const double start = run.totals().all.total_energy();
    const auto   p     = run.totals().bodies[0].momentum;
    run.advance_to(2.5e-4);
    const auto totals = run.totals();
    EXPECT_LT(totals.momentum_error, 1e-12);
    EXPECT_LT(totals.bodies[0].momentum * p, -0.95 * p.norm_square());
    EXPECT_NEAR((totals.bodies[0].momentum + totals.bodies[1].momentum).norm(),
                0,
                1e-10 * p.norm());
    return totals.all.total_energy() / start;
  };
  const double fourth = energy_left("4"), eighth = energy_left("8");
  EXPECT_GT(fourth, 0.978);
  EXPECT_GT(eighth, 0.987);
  EXPECT_LT(eighth, 1);
}



// What contact takes from components that a side holds is the side's impulse:
// nodes of the side see the disk through a sheet of half a cell.
TEST(ContactTransfers, WhatIsFilteredOverASideIsItsImpulse)
{
  for (const std::string transfer : {"fmpm", "xpic"})
    {
      SCOPED_TRACE(transfer);
      const std::string sheet = R"(
    set Bodies = sheet, disk
    subsection Contact
      set Pairs = rims
      subsection Pair rims
        set Bodies = sheet, disk
      end
    end
    subsection Grid
      set Upper corner = 0.03, 0.03
      set Cells = 60, 60
    end
    subsection Boundaries
      set bottom = slip
    end
    subsection Body sheet
      set Shape = box
      set Material = neo hookean
      subsection Box
        set Lower corner = 0.005, 0
        set Upper corner = 0.025, 0.00025
      end
      subsection Neo hookean
        set Density = 1500
        set Young's modulus = 1e9
        set Poisson's ratio = 0.33
      end
    end
    subsection Method
      set Kernel = quadratic
      set Courant number = 0.2
      set Transfer order = 4
    end)";
      SceneRun<2> run(sheet + disk("disk", "0.015, 0.0055", "0.005", "0; -10"),
                      {"Method/Transfer=" + transfer});
      run.advance_to(8e-5);
      const auto totals = run.totals();
      EXPECT_LT(totals.momentum_error, 1e-12);
      EXPECT_GT(totals.bodies[1].momentum[1], 0); // it is on its way back
    }
}



// The energy that the affine part takes is on record, as is that of contact.
TEST(ContactTransfers, DisksBounceOffEachOtherWithAffineIncrements)
{
  for (const std::string order : {"musl", "usavg"})
    {
      SCOPED_TRACE(order);
      SceneRun<2>  run(large_disks,
                      {"Method/Transfer=aflip",
                        "Method/Stress update=" + order});
      const double start = run.totals().all.total_energy();
      const auto   p     = run.totals().bodies[0].momentum;
      double       most  = 0;
      run.advance_to(2.5e-4, [&]() {
        most = std::max(most, run.totals().all.total_energy());
      });
      const auto totals = run.totals();
      EXPECT_LT(most, 1.001 * start);
      EXPECT_GT(totals.all.total_energy(), 0.988 * start);
      EXPECT_NEAR(totals.energy_drift, 0, 3e-4);
      EXPECT_LT(totals.momentum_error, 1e-12);
      EXPECT_LT(totals.bodies[0].momentum * p, -0.95 * p.norm_square());
    }
}
