// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/observables.h>
#include <limber/output/point_stress.h>

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



  TEST(PointStress, OfAProjectedBodyIsTheMeanOverTheCell)
  {
    SampleRun<2>       run(true);
    const PointView<2> points = run.points().view();
    set_pressures(points);
    PointStress<2> stress(run.state);
    for (unsigned int repeat = 0; repeat < 2; ++repeat)
      {
        stress.compute(*run.bodies[0]);
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const dealii::Point<2> place(points.position[0][p],
                                         points.position[1][p]);
            const double J = 1 - points.pressure[p] / run.bulk_modulus;
            EXPECT_NEAR(stress.pressure(p), expected_mean(place), 1e-8);
            EXPECT_NEAR(stress.point_pressure(p), points.pressure[p] / J, 1e-8);
            EXPECT_NEAR(stress.volume_ratio(p), J, 1e-14);
          }
      }
  }



  TEST(PointStress, WithoutTreatmentIsThatOfThePoint)
  {
    SampleRun<2>       run(false);
    const PointView<2> points = run.points().view();
    set_pressures(points);
    PointStress<2> stress(run.state);
    stress.compute(*run.bodies[0]);
    for (std::size_t p = 0; p < points.size; ++p)
      EXPECT_EQ(stress.pressure(p), stress.point_pressure(p));
  }



  TEST(PointStress, AroundNodesIsTheMeanOfThePointsNearThem)
  {
    for (const Treatment kind : {Treatment::node, Treatment::hybrid})
      {
        SampleRun<2>       run(kind);
        const PointView<2> points = run.points().view();
        set_pressures(points);
        PointStress<2> stress(run.state);

        // tents of the width of two cells around the nodes of the lattice
        const auto N = [&](const std::size_t p, const int i, const int j) {
          return std::max(0., 1 - std::abs(4 * points.position[0][p] - i)) *
                 std::max(0., 1 - std::abs(4 * points.position[1][p] - j));
        };
        double at_node[5][5];
        for (int i = 0; i < 5; ++i)
          for (int j = 0; j < 5; ++j)
            {
              double pressure = 0, volume = 0;
              for (std::size_t p = 0; p < points.size; ++p)
                {
                  const double tau = points.pressure[p];
                  pressure += N(p, i, j) * tau;
                  volume += N(p, i, j) * (1 - tau / run.bulk_modulus);
                }
              at_node[i][j] = volume > 0 ? pressure / volume : 0;
            }
        for (unsigned int repeat = 0; repeat < 2; ++repeat)
          {
            stress.compute(*run.bodies[0]);
            for (std::size_t p = 0; p < points.size; ++p)
              {
                double expected = 0;
                for (int i = 0; i < 5; ++i)
                  for (int j = 0; j < 5; ++j)
                    expected += N(p, i, j) * at_node[i][j];
                EXPECT_NEAR(stress.pressure(p), expected, 1e-8);
                EXPECT_NEAR(stress.point_pressure(p),
                            points.pressure[p] /
                              (1 - points.pressure[p] / run.bulk_modulus),
                            1e-8);
              }
          }
      }
  }



  TEST(PointStress, DeviatorIsAveragedAsFarAsTheTreatmentDoes)
  {
    for (const Treatment kind : {Treatment::node,
                                 Treatment::cell,
                                 Treatment::assumed_strain,
                                 Treatment::hybrid,
                                 Treatment::cell_shear,
                                 Treatment::cell_full})
      {
        SampleRun<2>       run(kind);
        const PointView<2> points = run.points().view();
        // no pressure: J is one, and means are those of four points
        for (std::size_t p = 0; p < points.size; ++p)
          for (unsigned int k = 0; k < 3; ++k)
            points.deviator[k][p] =
              100 * (k + 1) + std::sin(7 * k + 5 * points.position[0][p]) *
                                points.position[1][p];
        PointStress<2> stress(run.state);
        stress.compute(*run.bodies[0]);
        for (std::size_t p = 0; p < points.size; ++p)
          {
            std::array<double, 3> mean{};
            for (std::size_t q = 0; q < points.size; ++q)
              if (points.cell[q] == points.cell[p])
                for (unsigned int k = 0; k < 3; ++k)
                  mean[k] += 0.25 * points.deviator[k][q];
            const bool full  = kind == Treatment::cell_full;
            const bool shear = averages_shear_in_cells(kind);
            const auto value = [&](const unsigned int k, const bool averaged) {
              return averaged ? mean[k] : points.deviator[k][p];
            };
            const auto s = stress.deviator(p);
            EXPECT_NEAR(s[0][0], value(0, full), 1e-11);
            EXPECT_NEAR(s[1][1], value(1, full), 1e-11);
            EXPECT_NEAR(s[0][1], value(2, shear), 1e-11);
            EXPECT_NEAR(trace(s), 0, 1e-11);
            EXPECT_EQ(stress.point_deviator(p)[0][1], points.deviator[2][p]);
          }
      }
  }



  TEST(PointStress, ObservablesSeeTheSameMean)
  {
    SampleRun<2>  run(true);
    Observable<2> probe;
    probe.kind     = &observable_kind<2>("pressure");
    probe.body     = "block";
    probe.location = dealii::Point<2>(0.3, 0.7);
    auto second    = probe;
    second.kind    = &observable_kind<2>("stress");
    second.axis = second.second_axis = 1;
    run.problem.observables          = {probe, second};
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
