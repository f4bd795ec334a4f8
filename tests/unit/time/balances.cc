// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Sides and loads: impulses, work, and the motions that they must cause,
 * on blocks that rest on or slide along the lowest side of the box.
 */

using namespace limber;

namespace
{
  // 2 m x 1 m on the floor, 2000 kg/m
  const std::string block_on_floor = R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 1, 0
        set Upper corner = 3, 1
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
      end
    end
    subsection Grid
      set Upper corner = 6, 3
      set Cells = 24, 12
    end
    subsection Boundaries
      set left = free
      set right = free
      set top = free
      set bottom = slip
      subsection Side bottom
        set Friction coefficient = 0.3
        set Velocity = 0.5; 0
      end
    end)";

  constexpr double mass = 2000, g = 10;

  // 4 m x 1 m held at the left, without Poisson's effect
  const std::string loaded_bar = R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 4, 1
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = 5, 1
      set Cells = 20, 4
    end
    subsection Boundaries
      set right = free
    end
    subsection Loads
      set Face loads = pull
      subsection Face load pull
        set Body = bar
        set Face = right
        set Constants = p = 100, period = 0.50596442562694)";



  /** Mean displacement over X over one period after a slow rise. */
  double
  mean_strain(const std::string &load)
  {
    SceneRun<2>  run(loaded_bar + "\n" + load + "\nend\nend\n");
    const auto   start  = run.positions();
    const double period = 16 / std::sqrt(1000.);
    run.advance_to(4 * period);
    double             sum = 0;
    const unsigned int n   = 200;
    for (unsigned int k = 0; k < n; ++k)
      {
        run.advance(period / n);
        const auto now    = run.positions();
        double     strain = 0;
        for (std::size_t p = 0; p < now.size(); ++p)
          strain += (now[p] - start[p])[0] / start[p][0] / now.size();
        sum += strain / n;
      }
    EXPECT_LT(run.totals().momentum_error, 1e-12);
    EXPECT_LT(std::abs(run.totals().energy_drift), 0.05);
    return sum;
  }
} // namespace



namespace
{
  /** What a block has left when it has dropped on the floor. */
  struct Drop
  {
    double        drift_falling  = 0; // last before the contact
    double        drift          = 0; // largest since
    double        momentum_error = 0;
    double        lowest         = 1e300; // of the centre of mass, m
    unsigned long n_lost         = 0;

    Drop(const std::vector<std::string> &variant,
         const double                    courant_number,
         const std::string              &cells)
    {
      std::vector<std::string> set = {"Body block/Box/Lower corner=1, 1",
                                      "Body block/Box/Upper corner=3, 2",
                                      "Loads/Gravity=0, -10",
                                      "Method/Courant number=" +
                                        digits(courant_number),
                                      "Grid/Cells=" + cells};
      set.insert(set.end(), variant.begin(), variant.end());
      SceneRun<2> run(block_on_floor, set);
      run.advance_to(0.8, [&]() {
        const auto   totals = run.totals();
        const double error  = std::abs(totals.energy_drift);
        if (run.time < 0.3)
          drift_falling = error;
        else
          drift = std::max(drift, error);
        momentum_error = std::max(momentum_error, totals.momentum_error);
        lowest         = std::min(lowest, totals.centre_of_mass[1]);
        n_lost         = totals.lost_points;
      });
    }
  };
} // namespace



// The floor acts through the lowest row of cells, so the block stops while its
// lower edge is still up to h above the floor. What the points of that row lose
// then follows from the velocity that they give back; USF, where they do not,
// knows it only up to the order of h. USL is left out: it does not survive
// points that enter cells (theory, 6.1).
TEST(Balances, DropOnSlipFloor)
{
  for (const std::string order : {"usf", "musl", "usavg"})
    for (const std::string treatment : {"none", "cell"})
      {
        SCOPED_TRACE(order + ", " + treatment);
        const std::vector<std::string> variant = {
          "Method/Stress update=" + order,
          "Body block/Locking treatment=" + treatment};
        const Drop coarse(variant, 0.4, "24, 12"),
          short_steps(variant, 0.1, "24, 12"),
          small_cells(variant, 0.1, "48, 24");
        for (const Drop *const drop : {&coarse, &short_steps, &small_cells})
          {
            EXPECT_LT(drop->momentum_error, 1e-12);
            EXPECT_LT(drop->lowest, 0.65); // it has arrived
            EXPECT_LT(drop->drift, 0.04);
            EXPECT_EQ(drop->n_lost, 0u);
          }
        if (order == "usavg") // free fall is exact
          EXPECT_LT(coarse.drift_falling, 1e-12);
        else
          EXPECT_GE(coarse.drift_falling / short_steps.drift_falling, 3.2);
        if (order == "usf")
          {
            EXPECT_GE(short_steps.drift / small_cells.drift, 1.6);
          }
        else
          for (const Drop *const drop : {&short_steps, &small_cells})
            {
              EXPECT_LT(drop->drift, 0.01);
            }
      }
}



TEST(Balances, FrictionDecelerates)
{
  for (const std::string order : {"usf", "musl", "usavg"})
    {
      SCOPED_TRACE(order);
      SceneRun<2> run(block_on_floor,
                      {"Body block/Initial velocity=2; 0",
                       "Boundaries/bottom=friction",
                       "Loads/Gravity=0, -10",
                       "Method/Blend time=0.02",
                       "Method/Stress update=" + order});
      run.advance_to(0.1);
      const double before = run.totals().all.momentum[0];
      run.advance_to(0.4);
      const double after = run.totals().all.momentum[0];
      EXPECT_NEAR((before - after) / (mass * 0.3), 0.3 * g, 0.02 * 0.3 * g);
      EXPECT_LT(run.totals().momentum_error, 1e-12);

      // 2 m/s are used up after 0.67 s; then it stays.
      run.advance_to(1.5);
      EXPECT_NEAR(run.totals().all.momentum[0] / mass, 0, 0.02);
    }
}



TEST(Balances, MovingAndStickingFloorsTakeTheBlockAlong)
{
  for (const std::string order : {"usf", "musl", "usavg"})
    for (const std::string floor : {"velocity", "no slip"})
      {
        SCOPED_TRACE(order + ", " + floor);
        SceneRun<2> run(block_on_floor,
                        {"Body block/Initial velocity=0.2; 0",
                         "Boundaries/bottom=" + floor,
                         "Method/Blend time=0.005",
                         "Method/Stress update=" + order});
        run.advance_to(3);
        double sum = 0;
        for (unsigned int k = 0; k < 1000; ++k)
          {
            run.advance(1e-3);
            sum += run.totals().all.momentum[0] / mass / 1000;
          }
        EXPECT_NEAR(sum, floor == "velocity" ? 0.5 : 0, 0.005);
        EXPECT_LT(run.totals().momentum_error, 1e-12);
      }
}



// Struck sideways, with points at the floor that shall not move at all. What
// they bring there is not taken from them in every step.
TEST(Balances, AFloorTakesNoEnergyInTheInitialFrame)
{
  for (const std::string order : {"musl", "usavg"})
    for (const std::string kernel : {"linear", "quadratic", "cubic"})
      {
        SCOPED_TRACE(order + ", " + kernel);
        SceneRun<2>  run(block_on_floor,
                        {"Body block/Initial velocity=0.2; 0",
                          "Body block/Frame=initial",
                          "Method/Courant number=0.2",
                          "Method/Kernel=" + kernel,
                          "Boundaries/bottom=no slip",
                          "Method/Stress update=" + order});
        const double before = run.totals().all.kinetic_energy;
        run.advance_to(2);
        run.integrator.synchronise();
        const auto totals = run.totals();
        EXPECT_NEAR(totals.all.kinetic_energy + totals.all.strain_energy,
                    before,
                    0.01 * before);
        EXPECT_EQ(totals.boundary_work, 0);
        EXPECT_GT(std::abs(totals.side_impulse[2][0]), 0.1 * mass * 0.2);
        EXPECT_LT(totals.momentum_error, 1e-12);
      }
}



TEST(Balances, ReactionOfARestingBlockIsItsWeight)
{
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      SceneRun<2> run(block_on_floor,
                      {"Loads/Gravity=0, -10",
                       "Method/Blend time=0.005",
                       "Method/Stress update=" + order});
      run.advance_to(2);
      const double before = run.totals().side_impulse[2][1];
      run.advance_to(3);
      const double reaction = run.totals().side_impulse[2][1] - before;
      EXPECT_NEAR(reaction, mass * g, 0.01 * mass * g);
    }
}



// F L / (E A), free of oscillation after a rise over whole periods.
TEST(Balances, TractionAndPressureStrainABar)
{
  const double pull = mean_strain("set Traction = p*min(t/(4*period), 1); 0");
  const double push = mean_strain("set Pressure = p*min(t/(4*period), 1)");
  EXPECT_NEAR(pull, 1e-4, 1e-6);
  EXPECT_NEAR(push, -1e-4, 1e-6);
}



TEST(Balances, ConstantBodyForceIsGravity)
{
  for (const std::string &order : stress_update_orders)
    {
      SceneRun<2> gravity(block_on_floor,
                          {"Loads/Gravity=1, -10",
                           "Method/Stress update=" + order});
      SceneRun<2> formula(block_on_floor,
                          {"Loads/Body force=1; -10",
                           "Method/Stress update=" + order});
      gravity.advance(1e-3, 300);
      formula.advance(1e-3, 300);
      const auto a = gravity.positions(), b = formula.positions();
      for (std::size_t p = 0; p < a.size(); ++p)
        EXPECT_NEAR((a[p] - b[p]).norm(), 0, 1e-11);

      // The work of the formula is what gravity gives up.
      const auto with = gravity.totals(), without = formula.totals();
      EXPECT_NEAR(without.energy_drift, with.energy_drift, 0.02);
      EXPECT_LT(without.momentum_error, 1e-12);
    }
}



// A force of the material goes along with it: a body that leaves the half of
// the box in which it was pushed at its start is pushed on.
TEST(Balances, BodyForceAtTheInitialPlace)
{
  const auto gain = [](const std::string &integration,
                       const std::string &frame,
                       const std::string &place) {
    SceneRun<2>  run(block_on_floor,
                    {"Method/Time integration=" + integration,
                      "Method/Time step=1e-3",
                      "Body block/Frame=" + frame,
                      "Body block/Initial velocity=10; 0",
                      "Body block/Box/Lower corner=0.5, 1",
                      "Body block/Box/Upper corner=1, 1.5",
                      "Loads/Body force=if(x < 1.5, 2, -2); 0",
                      "Loads/Body force at=" + place,
                      "Boundaries/left=free",
                      "Boundaries/right=free",
                      "Boundaries/bottom=free",
                      "Boundaries/top=free"});
    const double before = run.totals().all.momentum[0];
    run.advance(1e-3, 200);
    EXPECT_LT(run.totals().momentum_error, 1e-12);
    return (run.totals().all.momentum[0] - before) / run.totals().all.mass;
  };
  for (const std::string frame : {"current", "initial"})
    {
      SCOPED_TRACE(frame);
      EXPECT_NEAR(gain("explicit", frame, "initial place"), 0.4, 1e-9);
      EXPECT_NEAR(gain("implicit", frame, "initial place"), 0.4, 1e-9);
      EXPECT_LT(gain("explicit", frame, "present place"), 0.1);
    }
}



// A free body loses its velocity as exp(-alpha t), for any alpha dt.
TEST(Balances, DampingIsExactInFreeFlight)
{
  for (const std::string &order : stress_update_orders)
    for (const double rate : {0.5, 4e4})
      {
        SCOPED_TRACE(order + ", " + digits(rate));
        SceneRun<2>  run(block_on_floor,
                        {"Body block/Initial velocity=0.3; 0.2",
                          "Body block/Box/Lower corner=1, 1",
                          "Body block/Box/Upper corner=3, 2",
                          "Method/Damping rate=" + digits(rate),
                          "Method/Stress update=" + order});
        const double energy = run.totals().all.kinetic_energy;
        run.advance(1e-3, 200);
        const double left   = std::exp(-rate * run.time);
        const auto   totals = run.totals();
        EXPECT_NEAR(totals.all.momentum[0] / mass, 0.3 * left, 1e-12);
        EXPECT_NEAR(totals.all.momentum[1] / mass, 0.2 * left, 1e-12);
        EXPECT_NEAR(totals.dissipated,
                    energy * (1 - left * left),
                    1e-11 * energy);
        EXPECT_LT(std::abs(totals.energy_drift), 1e-11);
        EXPECT_LT(totals.momentum_error, 1e-11);
      }
}



// A bar under a sudden load comes to rest; half of the work of the load is
// left as strain energy.
TEST(Balances, DampingTakesTheEnergyOfASuddenLoad)
{
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      SceneRun<2> run(loaded_bar + "\nset Traction = p; 0\nend\nend\n",
                      {"Method/Damping rate=30",
                       "Method/Stress update=" + order});
      run.advance_to(2);
      const auto totals = run.totals();
      // F^2 L / (2 E A) under F = 100 N
      EXPECT_NEAR(totals.all.strain_energy, 0.02, 2e-4);
      EXPECT_NEAR(totals.load_work, 0.04, 4e-4);
      EXPECT_NEAR(totals.dissipated, 0.02, 8e-4);
      EXPECT_LT(totals.all.kinetic_energy, 1e-6);
      EXPECT_LT(std::abs(totals.energy_drift), order == "usl" ? 2e-2 : 5e-3);
      EXPECT_LT(totals.momentum_error, 1e-12);
    }
}
