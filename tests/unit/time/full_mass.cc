// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file What FMPM(k) and XPIC(k) owe to the momentum: none is lost in flight;
 * what sides hold back of the correction is booked as their impulse, from the
 * held nodes alone, so that the balance of momentum would show a fault of the
 * correction; the energy lost is booked, and does not depend on who looks on;
 * and the steps of the default Courant number are stable.
 */

using namespace limber;

namespace
{
  using std::string;

  /**
   * A block of 24 x 16 points that waves run through, so soft that linear
   * functions bear the cells that it hardly touches.
   */
  const string filtered_block = R"(
    set Bodies = block
    subsection Body block
      set Points per cell edge = 2
      subsection Box
        set Lower corner = 3, 2
        set Upper corner = 15, 10
      end
      set Constants = U = 0, V = 0
      set Initial velocity = U + 0.02*sin(0.5*x)*cos(0.3*y); V + 0.02*cos(0.4*x + 0.7*y)
)" + rubber("0.04", "0.3") + R"(
      set Frame = current
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 40, 24
      set Cells = 40, 24
    end
)" + free_sides;



  std::vector<string>
  filter(const string &kernel, const string &transfer, const string &order)
  {
    return {"Method/Kernel=" + kernel,
            "Method/Transfer=" + transfer,
            "Method/Transfer order=" + order};
  }
} // namespace



// Twelve cells to the right and four up, in 400 steps, none of which brings
// points to an edge of cells: USL does not bear nodes of hardly any mass.
TEST(FullMass, MomentumIsKeptInFlight)
{
  for (const string kernel : {"linear", "quadratic", "cubic"})
    for (const string transfer : {"fmpm", "xpic"})
      for (const string order : {"1", "2", "4"})
        {
          SCOPED_TRACE(kernel + ", " + transfer + "(" + order + ")");
          auto set = filter(kernel, transfer, order);
          set.push_back("Body block/Constants=U = 0.3141, V = 0.1057");
          SceneRun<2> run(filtered_block, set);
          const auto  before = run.totals().all;
          run.advance(0.1, 400);
          const auto totals = run.totals();
          EXPECT_NEAR((totals.all.momentum - before.momentum).norm(),
                      0,
                      1e-12 * before.momentum.norm());
          EXPECT_LT(totals.momentum_error, 1e-12);
          EXPECT_EQ(totals.lost_points, 0u);
        }
}



// Into the corner of two sides, of which one may hold everything.
TEST(FullMass, ImpulsesOfSidesExplainTheMomentum)
{
  for (const string kernel : {"linear", "quadratic", "cubic"})
    for (const string transfer : {"fmpm", "xpic"})
      for (const string order : {"1", "2", "4"})
        for (const string side : {"slip", "no slip", "friction", "velocity"})
          {
            SCOPED_TRACE(kernel + ", " + transfer + "(" + order + "), " + side);
            auto set = filter(kernel, transfer, order);
            for (const string entry :
                 {"Body block/Constants=U = -0.0411, V = -0.0303",
                  "Body block/Box/Lower corner=0.1, 0.5",
                  "Body block/Box/Upper corner=8.5, 6.5",
                  "Boundaries/left=slip",
                  "Boundaries/Side bottom/Friction coefficient=0.3",
                  "Boundaries/Side bottom/Velocity=0.01*cos(t); 0.005*sin(t)"})
              set.push_back(entry);
            set.push_back("Boundaries/bottom=" + side);
            SceneRun<2> run(filtered_block, set);
            const auto  before = run.totals().all;
            run.advance(0.1, 300);
            const auto totals = run.totals();
            // it has met both sides
            EXPECT_GT(std::abs(totals.side_impulse[0][0]),
                      0.1 * before.momentum.norm());
            EXPECT_GT(totals.side_impulse[2].norm(),
                      0.1 * before.momentum.norm());
            EXPECT_LT(totals.momentum_error, 1e-12);
          }
}



// On the floor under its weight.
TEST(FullMass, ReactionOfARestingBlockIsItsWeight)
{
  for (const string kernel : {"linear", "quadratic", "cubic"})
    for (const string transfer : {"fmpm", "xpic"})
      for (const string side : {"slip", "no slip"})
        {
          SCOPED_TRACE(kernel + ", " + transfer + ", " + side);
          auto set = filter(kernel, transfer, "4");
          for (const string entry : {"Body block/Box/Lower corner=3, 0",
                                     "Body block/Box/Upper corner=11, 4",
                                     "Body block/Initial velocity=0; 0",
                                     "Body block/Neo hookean/"
                                     "Young's modulus=4",
                                     "Loads/Gravity=0, -0.01",
                                     "Method/Damping rate=0.5"})
            set.push_back(entry);
          set.push_back("Boundaries/bottom=" + side);
          SceneRun<2> run(filtered_block, set);
          run.advance(0.2, 200);
          const double before = run.totals().side_impulse[2][1];
          run.advance(0.2, 50);
          const double weight   = 0.01 * run.totals().all.mass;
          const double reaction = run.totals().side_impulse[2][1] - before;
          EXPECT_NEAR(reaction, 10 * weight, 0.01 * 10 * weight);
          EXPECT_LT(run.totals().momentum_error, 1e-12);
        }
}



// The same seen by somebody who passes: side and block move by W more. Speeds
// are such that no point moves, so all changes of velocity are the same, the
// side does more work by W times its impulse, and as much is lost.
TEST(FullMass, LossesAreThoseOfSidesAtRest)
{
  constexpr double W = 3e-9;
  for (const string kernel : {"linear", "quadratic", "cubic"})
    for (const string transfer : {"fmpm", "xpic"})
      for (const string order : {"1", "2", "4"})
        {
          SCOPED_TRACE(kernel + ", " + transfer + "(" + order + ")");
          const auto totals_seen_from = [&](const double speed) {
            auto set = filter(kernel, transfer, order);
            for (const string entry :
                 {"Body block/Box/Lower corner=3, 0",
                  "Body block/Initial velocity=U + 1e-9*cos(y); 1e-9*sin(x)",
                  "Boundaries/bottom=velocity"})
              set.push_back(entry);
            set.push_back("Body block/Constants=V = 0, U = " + digits(speed));
            set.push_back("Boundaries/Side bottom/Velocity=" + digits(speed) +
                          "; 0");
            SceneRun<2> run(filtered_block, set);
            run.advance(0.1, 50);
            return run.totals();
          };
          const auto   rests = totals_seen_from(0), moves = totals_seen_from(W);
          const double impulse = rests.side_impulse[2][0];
          EXPECT_GT(std::abs(impulse), 1e-10);
          EXPECT_NEAR(moves.side_impulse[2][0],
                      impulse,
                      1e-5 * std::abs(impulse));
          EXPECT_NEAR(moves.boundary_work - rests.boundary_work,
                      W * impulse,
                      1e-5 * std::abs(W * impulse));
          EXPECT_GT(std::abs(rests.removed_by_transfer), 1e-19);
          EXPECT_NEAR(moves.removed_by_transfer,
                      rests.removed_by_transfer,
                      1e-5 * std::abs(rests.removed_by_transfer));
        }
}



// Whether all or some of the steps filter, in either frame, and whatever acts
// on the block. What is left swings with the step.
TEST(FullMass, WhatTheFilterTakesIsOnRecord)
{
  for (const string kernel : {"quadratic", "gimp", "cpdi"})
    for (const string transfer : {"fmpm", "xpic"})
      for (const string period : {"1", "5"})
        for (const string scene : {"free", "initial", "loaded", "on side"})
          {
            if (scene == "initial" && kernel != "quadratic")
              continue;
            SCOPED_TRACE(kernel + ", " + transfer + ", period " + period +
                         ", " + scene);
            auto set = filter(kernel, transfer, "4");
            set.push_back("Method/Transfer period=" + period);
            set.push_back("Method/Courant number=0.1");
            if (scene == "initial")
              set.push_back("Body block/Frame=initial");
            if (scene == "loaded")
              for (const string entry :
                   {"Loads/Gravity=0.0003, -0.0001",
                    "Loads/Face loads=pull",
                    "Loads/Face load pull/Body=block",
                    "Loads/Face load pull/Face=right",
                    "Loads/Face load pull/Traction=0.0003; 0.0001"})
                set.push_back(entry);
            if (scene == "on side")
              for (const string entry : {"Body block/Box/Lower corner=3, 0",
                                         "Body block/Box/Upper corner=15, 8",
                                         "Boundaries/bottom=no slip"})
                set.push_back(entry);
            SceneRun<2> run(filtered_block, set);
            run.advance_to(150);
            const auto totals = run.totals();
            EXPECT_GT(totals.removed_by_transfer + totals.contact_loss,
                      0.01 * totals.all.kinetic_energy);
            EXPECT_LT(std::abs(totals.energy_drift), 0.02);
          }
}



// Where points hardly reach a node the filter makes k times its velocity.
TEST(FullMass, StepsOfTheDefaultCourantNumberAreStable)
{
  for (const string kernel : {"quadratic", "cubic", "gimp", "cpgimp", "cpdi"})
    for (const string order : {"2", "4", "8"})
      {
        SCOPED_TRACE(kernel + ", order " + order);
        auto set = filter(kernel, "fmpm", order);
        set.push_back("Body block/Constants=U = 0.01, V = 0.007");
        SceneRun<2>  run(filtered_block, set);
        const double before = run.totals().all.kinetic_energy;
        run.advance_to(300);
        EXPECT_LT(run.totals().all.kinetic_energy, before);
      }
}



// Nodes that a block in free flight hardly touches: with the Courant number of
// explicit steps it was torn apart within four cells.
TEST(FullMass, SemiImplicitStepsAreStableInFlight)
{
  for (const string order : {"2", "4", "8"})
    {
      SCOPED_TRACE(order);
      auto entries = filter("linear", "fmpm", order);
      entries.insert(entries.end(),
                     {"Method/Time integration=semi-implicit",
                      "Body block/Locking treatment=cell",
                      "Body block/Initial velocity=1; 0.5"});
      SceneRun<2>  run(filtered_block, entries);
      const double before = run.totals().all.kinetic_energy;
      run.advance_to(8);
      EXPECT_NEAR(run.totals().all.kinetic_energy, before, 1e-9 * before);
    }
}
