// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/observables.h>
#include <limber/output/point_pressure.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    /** A pressure that differs from point to point, known from the place. */
    void
    set_pressures(const PointView<2> &points)
    {
      for (std::size_t p = 0; p < points.size; ++p)
        points.pressure[p] =
          1e5 * (points.position[0][p] + 3 * points.position[1][p]);
    }



    /** sum V p / sum V over the four points of the cell around a place. */
    double
    expected_mean(const dealii::Point<2> &place)
    {
      double pressure = 0, volume = 0;
      for (const double dx : {-0.0625, 0.0625})
        for (const double dy : {-0.0625, 0.0625})
          {
            const double x   = std::floor(place[0] * 4) / 4 + 0.125 + dx;
            const double y   = std::floor(place[1] * 4) / 4 + 0.125 + dy;
            const double tau = 1e5 * (x + 3 * y);
            pressure += tau;
            volume += 1 - tau / SampleRun<2>::bulk_modulus;
          }
      return pressure / volume;
    }
  } // namespace



  TEST(PointPressure, OfAProjectedBodyIsTheMeanOverTheCell)
  {
    SampleRun<2>       run(true);
    const PointView<2> points = run.points().view();
    set_pressures(points);
    PointPressure<2> pressure(run.grid);
    for (unsigned int repeat = 0; repeat < 2; ++repeat)
      {
        pressure.compute(*run.bodies[0]);
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const dealii::Point<2> place(points.position[0][p],
                                         points.position[1][p]);
            const double J = 1 - points.pressure[p] / run.bulk_modulus;
            EXPECT_NEAR(pressure.pressure(p), expected_mean(place), 1e-8);
            EXPECT_NEAR(pressure.point_pressure(p),
                        points.pressure[p] / J,
                        1e-8);
            EXPECT_NEAR(pressure.volume_ratio(p), J, 1e-14);
          }
      }
  }



  TEST(PointPressure, WithoutTreatmentIsThatOfThePoint)
  {
    SampleRun<2>       run(false);
    const PointView<2> points = run.points().view();
    set_pressures(points);
    PointPressure<2> pressure(run.grid);
    pressure.compute(*run.bodies[0]);
    for (std::size_t p = 0; p < points.size; ++p)
      EXPECT_EQ(pressure.pressure(p), pressure.point_pressure(p));
  }



  TEST(PointPressure, ObservablesSeeTheSameMean)
  {
    SampleRun<2>  run(true);
    Observable<2> probe;
    probe.kind     = ObservableKind::pressure;
    probe.body     = "block";
    probe.location = dealii::Point<2>(0.3, 0.7);
    auto stress    = probe;
    stress.kind    = ObservableKind::stress;
    stress.axis = stress.second_axis = 1;
    run.problem.observables          = {probe, stress};
    Observables<2> observables(run.state);

    const PointView<2> points = run.points().view();
    set_pressures(points);
    for (std::size_t p = 0; p < points.size; ++p)
      points.deviator[1][p] = 500 * (1 - points.pressure[p] / run.bulk_modulus);
    const auto values = observables.evaluate(run.state, run.totals);
    EXPECT_NEAR(values[0], expected_mean(probe.location), 1e-8);
    EXPECT_NEAR(values[1], 500 - expected_mean(probe.location), 1e-8);
  }
} // namespace limber::test
