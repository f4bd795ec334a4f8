// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/totals.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace limber::test
{
  TEST(Totals, SumsOverTheBodyAreThoseOfItsPoints)
  {
    SampleRun<2> run(false);
    run.problem.loads.gravity[1] = -10;
    PointView<2> points          = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[0][p] = 2;
        points.pressure[p]    = 1000;
      }
    const Totals<2> totals = Balance<2>(run.state).evaluate(run.state);

    EXPECT_EQ(totals.points, 32u);
    EXPECT_EQ(totals.cells, 16u);
    EXPECT_NEAR(totals.all.mass, 500, 1e-10);
    EXPECT_NEAR(totals.all.momentum[0], 1000, 1e-10);
    EXPECT_NEAR(totals.all.kinetic_energy, 1000, 1e-10);
    EXPECT_NEAR(totals.centre_of_mass[0], 0.25, 1e-14);
    EXPECT_NEAR(totals.centre_of_mass[1], 0.5, 1e-14);
    EXPECT_NEAR(totals.all.gravitational_energy, 2500, 1e-10);
    EXPECT_NEAR(totals.all.strain_energy,
                0.5 * 1e6 / (2 * run.bulk_modulus),
                1e-10);
    EXPECT_NEAR(totals.largest_speed, 2, 1e-14);
    EXPECT_NEAR(totals.smallest_volume, 1 - 1000 / run.bulk_modulus, 1e-14);
    EXPECT_EQ(totals.energy_drift, 0);
    EXPECT_EQ(totals.momentum_error, 0);
  }



  TEST(Totals, NothingMovesAndNothingIsDividedByZero)
  {
    SampleRun<3>    run(false);
    const Totals<3> totals = Balance<3>(run.state).evaluate(run.state);
    EXPECT_EQ(totals.energy_drift, 0);
    EXPECT_EQ(totals.momentum_error, 0);
    EXPECT_EQ(totals.active_nodes, 0u);
  }



  /** Each step adds its own round-off to strains and velocities. */
  TEST(Totals, RoundOffOfManyStepsIsNoDrift)
  {
    SampleRun<2> run(false);
    Balance<2>   balance(run.state);
    const auto   points = run.points().view();
    const double wave_speed =
      std::sqrt(run.state.bodies[0]->stress->wave_speed_squared(points));
    for (std::size_t p = 0; p < points.size; ++p)
      points.velocity[0][p] =
        500 * std::numeric_limits<double>::epsilon() * wave_speed;
    EXPECT_GT(balance.evaluate(run.state).energy_drift, 0.9);
    run.state.step = 2000;
    EXPECT_LT(balance.evaluate(run.state).energy_drift, 0.1);
  }



  /** Free fall: what gravity does is accounted for, a loss is noticed. */
  TEST(Totals, BalanceClosesInFreeFallAndTellsALossFromADrift)
  {
    SampleRun<2> run(false);
    run.problem.loads.gravity[1] = -10;
    Balance<2> balance(run.state);

    const double time = 0.02, fall = 0.5 * 10 * time * time;
    PointView<2> points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[1][p] = -10 * time;
        points.position[1][p] -= fall;
      }
    const double own_mass               = run.points().size() * run.point_mass;
    run.state.ledger.gravity_impulse[1] = -own_mass * 10 * time;
    Totals<2> totals                    = balance.evaluate(run.state);
    EXPECT_NEAR(totals.energy_drift, 0, 1e-12);
    EXPECT_NEAR(totals.momentum_error, 0, 1e-14);
    EXPECT_NEAR(totals.removed_by_transfer, 0, 1e-10);

    // Points that lose what the ledger does not name: that is drift.
    for (std::size_t p = 0; p < points.size; ++p)
      points.velocity[1][p] *= 0.5;
    const double loss = 0.75 * 500 * 10 * fall;
    EXPECT_LT(balance.evaluate(run.state).energy_drift, -0.1);

    // The same loss, named: by the transfer.
    run.state.ledger.transfer = own_mass * loss / 500;
    totals                    = balance.evaluate(run.state);
    EXPECT_NEAR(totals.energy_drift, 0, 1e-12);
    EXPECT_NEAR(totals.removed_by_transfer, loss, 1e-10);
    EXPECT_NEAR(totals.momentum_error, 0.5, 1e-12);
    EXPECT_NEAR(balance.state().momentum_scale, 500 * 10 * time, 1e-10);
  }



  /** A stretching body, at rest as a whole and as a moving observer sees it. */
  TEST(Totals, InnerScaleIsThatOfAnyObserver)
  {
    std::array<double, 2> energy, inner, unexplained;
    for (const unsigned int seen : {0, 1})
      {
        SampleRun<2> run(false);
        PointView<2> points = run.points().view();
        const auto   move   = [&](const double rate) {
          for (std::size_t p = 0; p < points.size; ++p)
            points.velocity[0][p] =
              rate * (points.position[0][p] - 0.25) + 100. * seen;
        };
        move(2);
        Balance<2> balance(run.state);
        balance.evaluate(run.state);
        move(1); // half of the loss is on record
        run.state.ledger.contact = 6;
        const Totals<2> totals   = balance.evaluate(run.state);
        energy[seen]             = balance.state().energy_scale;
        inner[seen]              = balance.state().inner_scale;
        unexplained[seen]        = totals.unexplained_energy;
      }
    EXPECT_GT(inner[0], 1);
    EXPECT_NEAR(inner[0], energy[0], 1e-10);
    EXPECT_NEAR(inner[1], inner[0], 1e-6);
    // up to the round-off of 2.5 MJ
    EXPECT_NEAR(unexplained[1], unexplained[0], 1e-6);
    EXPECT_GT(energy[1], 1e6);
  }



  /** A ball that a floor stops has given its energy of flight to its strain. */
  TEST(Totals, InnerScaleHoldsWhatWallsTurnIntoInnerEnergy)
  {
    SampleRun<2> run(false);
    PointView<2> points = run.points().view();
    const auto   move   = [&](const double speed) {
      for (std::size_t p = 0; p < points.size; ++p)
        points.velocity[0][p] = speed;
    };
    move(2);
    Balance<2> balance(run.state);
    balance.evaluate(run.state);
    EXPECT_LT(balance.state().inner_scale, 1e-6);
    move(0);
    run.state.ledger.contact = 1000 * run.points().size() / 32.;
    balance.evaluate(run.state);
    EXPECT_NEAR(balance.state().inner_scale, 1000, 1e-9);
  }



  /** A body in free fall, which nothing strains: the last step is a short one,
   * and its half is not what the potential leaves open. */
  TEST(Totals, FreeFallIsJudgedByWhatGravityGave)
  {
    SampleRun<2> run(false);
    run.problem.loads.gravity[1] = -10;
    run.problem.method.order     = StressUpdateOrder::musl;
    Balance<2>       balance(run.state);
    PointView<2>     points = run.points().view();
    constexpr double step   = 0.01;
    for (int n = 0; n < 6; ++n)
      {
        for (std::size_t p = 0; p < points.size; ++p)
          {
            points.velocity[1][p] -= 10 * step;
            points.position[1][p] += step * points.velocity[1][p];
          }
        ++run.state.step;
        run.state.time += step;
        run.state.step_size = step;
      }
    const double of_fall = 0.5 * 500 * 0.6 * 0.6;
    Totals<2>    totals  = balance.evaluate(run.state);
    EXPECT_NEAR(totals.all.kinetic_energy, of_fall, 1e-10);
    EXPECT_LT(std::abs(totals.unexplained_energy), 1e-12 * of_fall);
    EXPECT_NEAR(balance.state().inner_scale, 0.01 * of_fall, 1e-10);

    // and what is missing is still told
    for (std::size_t p = 0; p < points.size; ++p)
      points.velocity[1][p] *= 0.9;
    totals = balance.evaluate(run.state);
    EXPECT_LT(totals.unexplained_energy, -balance.state().inner_scale);
  }



  /** Tractions that pull at two ends have no sum but round-off. */
  TEST(Totals, RoundOffOfLoadsInBalanceIsNoErrorOfMomentum)
  {
    SampleRun<2> run(false);
    Balance<2>   balance(run.state);
    const auto   points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      points.pressure[p] = 1000;
    run.state.ledger.load_impulse[0] = 1e-13;
    const Totals<2> totals           = balance.evaluate(run.state);
    EXPECT_GT(totals.all.strain_energy, 0);
    EXPECT_LT(totals.momentum_error, 1e-13);
    EXPECT_NEAR(balance.state().momentum_scale,
                std::sqrt(2 * 500 * totals.all.strain_energy),
                1e-10);
  }
} // namespace limber::test
