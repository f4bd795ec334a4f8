// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/observables.h>
#include <limber/output/outermost.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <cmath>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    Observable<2>
    observe(const std::string &kind, const unsigned int axis = 0)
    {
      Observable<2> observable;
      observable.name     = "probe";
      observable.kind     = &observable_kind<2>(kind);
      observable.body     = "block";
      observable.axis     = axis;
      observable.location = dealii::Point<2>(0.44, 0.95);
      return observable;
    }
  } // namespace



  TEST(Frequency, OfASineIsFoundFromItsZeros)
  {
    ZeroCrossings crossings;
    const double  frequency = 3.7, step = 1e-3;
    for (unsigned int i = 0; i < 2000; ++i)
      {
        const double time = i * step;
        crossings.add(time,
                      std::sin(2 * dealii::numbers::PI * frequency * time));
        EXPECT_EQ(std::isnan(crossings.frequency()), time < 1 / frequency);
      }
    EXPECT_NEAR(crossings.frequency(), frequency, 1e-6);
  }



  TEST(Frequency, DoesNotCountRestAtZeroNorWhatIsNotANumber)
  {
    ZeroCrossings crossings;
    crossings.add(0, 0);
    crossings.add(1, 2);
    crossings.add(2, std::numeric_limits<double>::quiet_NaN());
    crossings.add(3, -2);
    crossings.add(4, 0);
    crossings.add(5, 0);
    crossings.add(6, 1);
    EXPECT_EQ(crossings.count, 2u);
    EXPECT_DOUBLE_EQ(crossings.first, 2);
    EXPECT_DOUBLE_EQ(crossings.last, 5);
  }



  // Noise of a seventh of the swing crosses zero several times on the way.
  TEST(Frequency, NoiseAboutZeroIsNoSwing)
  {
    ZeroCrossings crossings;
    const double  pi = dealii::numbers::PI;
    for (unsigned int i = 0; i <= 4000; ++i)
      crossings.add(i * 1e-3,
                    std::sin(2 * pi * 1.3 * i * 1e-3 + 0.1) +
                      0.15 * std::sin(2 * pi * 87.1 * i * 1e-3));
    EXPECT_EQ(crossings.count, 10u);
    EXPECT_NEAR(crossings.frequency(), 1.3, 0.01);

    // once up and down is a half swing, a ripple of it is none
    ZeroCrossings few;
    for (const double value : {1., -0.1, 0.2, -0.1, 1., -1.})
      few.add(few.last_time + 1, value);
    EXPECT_EQ(few.count, 1u);
    EXPECT_DOUBLE_EQ(few.first, few.last);
  }



  TEST(Observables, FollowTheNearestPointWhereverItIsSorted)
  {
    SampleRun<2> run(false);
    run.problem.observables             = {observe("displacement", 0),
                                           observe("position", 1),
                                           observe("velocity", 0),
                                           observe("pressure"),
                                           observe("stress", 0)};
    run.problem.observables[2].positive = false;
    Observables<2> observables(run.state);
    EXPECT_EQ(observables.state().tracked.size(), 1u);

    PointView<2> points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[0][p] = points.position[0][p];
        points.position[0][p] += 0.05;
        points.pressure[p]    = 1e5;
        points.deviator[0][p] = 2e5;
      }
    for (unsigned int round = 0; round < 3; ++round)
      {
        const auto   values = observables.evaluate(run.state, run.totals);
        const double J      = 1 - 1e5 / run.bulk_modulus;
        EXPECT_NEAR(values[0], 0.05, 1e-14);
        EXPECT_NEAR(values[1], 0.9375, 1e-14);
        EXPECT_NEAR(values[2], -0.4375, 1e-14);
        EXPECT_NEAR(values[3], 1e5 / J, 1e-8);
        EXPECT_NEAR(values[4], 1e5 / J, 1e-8);
        run.points().sort_by_cell();
      }
  }



  // Its forces are those of P = sigma, without J.
  TEST(Observables, OfSmallStrainInTheInitialFrameAreTheStressOfTheLaw)
  {
    for (const bool projected : {false, true})
      {
        SampleRun<2> run(projected);
        run.problem.bodies[0].frame = Frame::initial;
        run.problem.observables = {observe("pressure"), observe("stress", 0)};
        Observables<2>     observables(run.state);
        const PointView<2> points = run.points().view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            points.pressure[p]    = 1e5;
            points.deviator[0][p] = 3e5;
          }
        const auto values = observables.evaluate(run.state, run.totals);
        EXPECT_NEAR(values[0], 1e5, 1e-8) << projected;
        EXPECT_NEAR(values[1], 2e5, 1e-8) << projected;
      }
  }



  TEST(Observables, ContinueFromACheckpoint)
  {
    SampleRun<2> run(false);
    run.problem.observables = {observe("displacement", 1)};
    const Observables<2> before(run.state);
    PointView<2>         points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      points.position[1][p] -= 0.01;
    Observables<2> after(run.state);
    after.restore(before.state());
    EXPECT_NEAR(after.evaluate(run.state, run.totals)[0], -0.01, 1e-14);
  }



  TEST(Observables, OfALostPointAreNotNumbers)
  {
    SampleRun<2> run(false);
    run.problem.observables = {observe("displacement"), observe("pressure")};
    Observables<2> observables(run.state);
    PointView<2>   points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      points.cell[p] = invalid_cell;
    run.points().remove_lost();
    for (unsigned int row = 0; row < 2; ++row)
      for (const double value : observables.evaluate(run.state, run.totals))
        EXPECT_TRUE(std::isnan(value));
    EXPECT_TRUE(observables.state().tracked[0].lost);
  }



  TEST(Observables, ExtremesReachHalfASpacingBeyondThePoints)
  {
    SampleRun<2> run(false);
    auto         lowest = observe("extreme coordinate", 0);
    lowest.positive     = false;
    auto within         = observe("extreme coordinate", 0);
    within.within =
      std::make_pair(dealii::Point<2>(0, 0), dealii::Point<2>(0.2, 1));
    auto nothing = within;
    nothing.within =
      std::make_pair(dealii::Point<2>(0.8, 0), dealii::Point<2>(1, 1));
    run.problem.observables = {observe("extreme coordinate", 0),
                               lowest,
                               within,
                               nothing};
    const auto values =
      Observables<2>(run.state).evaluate(run.state, run.totals);
    EXPECT_NEAR(values[0], 0.5, 1e-14);
    EXPECT_NEAR(values[1], 0, 1e-14);
    EXPECT_NEAR(values[2], 0.25, 1e-14);
    EXPECT_TRUE(std::isnan(values[3]));
  }



  TEST(Observables, ExtremesAreStretchedAsTheMaterialIs)
  {
    SceneRun<2>    run(R"(
      set Bodies = bar
      subsection Body bar
        subsection Box
          set Lower corner = 0.25, 0
          set Upper corner = 1, 0.5
        end
        set Frame = initial
        set Material = neo hookean
      end
      subsection Grid
        set Upper corner = 2, 1
        set Cells = 8, 4
      end
      set Observables = high
      subsection Observable high
        set Type = extreme coordinate
        set Direction = x
      end)");
    PointView<2>   points  = run.state().bodies[0]->points.view();
    constexpr auto stretch = 1.5;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.position[0][p] *= stretch;
        points.deformation[0][p] = stretch;
      }
    EXPECT_NEAR(
      Observables<2>(run.state()).evaluate(run.state(), run.totals())[0],
      1.5,
      1e-14);
  }



  TEST(Observables, OutermostLeavesOutAShareOfTheMass)
  {
    PlacesOfMass places;
    for (unsigned int i = 1; i <= 100; ++i)
      places.emplace_back(-50 + 0.01 * i, 2);
    places.emplace_back(1e3, 1); // thrown far ahead, half as heavy
    const auto at = [&](const double share) {
      return outermost(places, share, MPI_COMM_SELF);
    };
    EXPECT_EQ(at(0), 1e3);
    EXPECT_NEAR(at(0.5 / 201), 1e3, 1e-8);
    EXPECT_NEAR(at(1.5 / 201), -49, 1e-8);
    EXPECT_NEAR(at(12.0 / 201), -49.05, 1e-8);
    EXPECT_NEAR(at(1), -49.99, 1e-8);
    EXPECT_TRUE(std::isnan(outermost({}, 0.1, MPI_COMM_SELF)));
    EXPECT_NEAR(outermost({{3, 1}, {3, 2}}, 0.1, MPI_COMM_SELF), 3, 1e-14);
  }



  TEST(Observables, ExtremesLeaveOutAShareOfTheMass)
  {
    SampleRun<2> run(false);
    auto         most       = observe("extreme coordinate", 0);
    most.share_beyond       = 0.4;
    run.problem.observables = {most};
    // one of four columns of points lies beyond the end of the next one
    EXPECT_NEAR(Observables<2>(run.state).evaluate(run.state, run.totals)[0],
                0.375,
                1e-10);
  }



  // Points of Gauss stand nearer to the ends of their cells than even ones.
  TEST(Observables, ExtremesOfPointsOfGaussAreThoseOfTheBody)
  {
    for (const std::string n : {"1", "2", "3"})
      {
        SceneRun<2> run(R"(
          set Bodies = bar
          subsection Body bar
            subsection Box
              set Lower corner = 0.25, 0
              set Upper corner = 1, 0.5
            end
            set Placement = gauss
            set Material = neo hookean
          end
          subsection Grid
            set Upper corner = 2, 1
            set Cells = 8, 4
          end
          set Observables = low, high
          subsection Observable low
            set Type = extreme coordinate
            set Direction = -x
          end
          subsection Observable high
            set Type = extreme coordinate
            set Direction = x
          end)",
                        {"Body bar/Frame=initial",
                         "Body bar/Points per cell edge=" + n});
        const auto  values =
          Observables<2>(run.state()).evaluate(run.state(), run.totals());
        EXPECT_NEAR(values[0], 0.25, 1e-14) << n;
        EXPECT_NEAR(values[1], 1, 1e-14) << n;
      }
  }



  TEST(Observables, ReactionForceIsTheMeanSinceTheRowBefore)
  {
    SampleRun<2> run(false);
    auto         force      = observe("reaction force", 1);
    force.side              = 2;
    run.problem.observables = {force};
    Observables<2> observables(run.state);

    Totals<2> totals          = run.totals;
    totals.side_impulse[2][1] = 7;
    EXPECT_EQ(observables.evaluate(run.state, totals)[0], 0);
    run.state.time            = 0.5;
    totals.side_impulse[2][1] = 10;
    EXPECT_NEAR(observables.evaluate(run.state, totals)[0], -6, 1e-14);
  }



  TEST(Observables, FrequencyIsThatOfTheNamedObservable)
  {
    SampleRun<2>  run(false);
    Observable<2> frequency = observe("frequency");
    frequency.name          = "tone";
    frequency.observable    = "probe";
    run.problem.observables = {frequency, observe("velocity", 1)};
    Observables<2> observables(run.state);
    PointView<2>   points = run.points().view();
    double         found  = 0;
    for (unsigned int i = 0; i <= 200; ++i)
      {
        run.state.time = 0.01 * i;
        for (std::size_t p = 0; p < points.size; ++p)
          points.velocity[1][p] = std::cos(10 * run.state.time);
        found = observables.evaluate(run.state, run.totals)[0];
      }
    EXPECT_NEAR(found, 10 / (2 * dealii::numbers::PI), 1e-4);
  }



  TEST(Observables, OfARegionAreMassAndMeansOfWhatIsInItNow)
  {
    SampleRun<2> run(false);
    auto         observables_within = [&](const dealii::Point<2> &lower,
                                  const dealii::Point<2> &upper) {
      std::vector<Observable<2>> result = {observe("mass within"),
                                           observe("mean velocity", 1),
                                           observe("mean pressure"),
                                           observe("mean stress", 0)};
      for (auto &observable : result)
        observable.within = std::make_pair(lower, upper);
      return result;
    };
    run.problem.observables =
      observables_within(dealii::Point<2>(0.25, 0), dealii::Point<2>(0.5, 0.5));
    Observables<2> observables(run.state);
    PointView<2>   points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.velocity[1][p] = points.position[0][p];
        points.pressure[p]    = 1e5 * points.position[1][p];
        points.deviator[0][p] = 2e5;
      }
    const auto values = observables.evaluate(run.state, run.totals);
    // Eight points at x = 0.3125 and 0.4375, y from 0.0625 to 0.4375
    EXPECT_NEAR(values[0], 8 * run.point_mass, 1e-12);
    EXPECT_NEAR(values[1], 0.375, 1e-14);
    double volume = 0, pressure = 0, stress = 0;
    for (const double y : {0.0625, 0.1875, 0.3125, 0.4375})
      {
        volume += 1 - 1e5 * y / run.bulk_modulus;
        pressure += 1e5 * y; // J p
        stress += 2e5 - 1e5 * y;
      }
    EXPECT_NEAR(values[2], pressure / volume, 1e-8);
    EXPECT_NEAR(values[3], stress / volume, 1e-8);

    run.problem.observables =
      observables_within(dealii::Point<2>(0.7, 0), dealii::Point<2>(1, 1));
    const auto of_none =
      Observables<2>(run.state).evaluate(run.state, run.totals);
    EXPECT_EQ(of_none[0], 0);
    EXPECT_TRUE(std::isnan(of_none[1]));
    EXPECT_EQ(of_none[2], 0);
  }



  // Linear between rows.
  TEST(Observables, MeansAndExtremesAreThoseOfTheRowsFromATimeOn)
  {
    SampleRun<2> run(false);
    run.problem.observables = {observe("velocity", 1)};
    for (const std::string kind :
         {"mean over time", "largest so far", "smallest so far"})
      {
        Observable<2> column = observe(kind);
        column.name          = kind;
        column.observable    = "probe";
        column.from_time     = 1;
        run.problem.observables.push_back(column);
      }
    Observables<2>      observables(run.state);
    PointView<2>        points = run.points().view();
    std::vector<double> values;
    for (const double time : {0., 1., 1.5, 3.})
      {
        run.state.time = time;
        for (std::size_t p = 0; p < points.size; ++p)
          points.velocity[1][p] = (time - 2) * (time - 2) - 5;
        if (time == 3)
          { // as from a checkpoint
            Observables<2> resumed(run.state);
            resumed.restore(observables.state());
            values = resumed.evaluate(run.state, run.totals);
          }
        else
          values = observables.evaluate(run.state, run.totals);
        if (time == 0)
          for (unsigned int i = 1; i <= 3; ++i)
            EXPECT_TRUE(std::isnan(values[i]));
      }
    EXPECT_NEAR(values[1],
                ((-4 - 4.75) / 2 * 0.5 + (-4.75 - 4) / 2 * 1.5) / 2,
                1e-14);
    EXPECT_EQ(values[2], -4);
    EXPECT_EQ(values[3], -4.75);
  }
} // namespace limber::test
