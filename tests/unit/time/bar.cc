// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file The axial vibration of a bar of length L, held at the left and free at
 * the right, in its first mode: u = v0 / w sin(k x) sin(w t), k = pi / 2L,
 * w = k c (prm/verification/bar.prm). So small that no point changes cell.
 */

using namespace limber;

namespace
{
  constexpr double length = 25, wave_speed = 10, v0 = 1e-6;
  constexpr double k      = 0.5 * dealii::numbers::PI / length;
  constexpr double omega  = k * wave_speed;
  constexpr double period = 2 * dealii::numbers::PI / omega;

  std::string
  bar(const unsigned int n_cells)
  {
    const std::string edge = digits(length / n_cells);
    return R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 25, )" +
           edge + R"(
      end
      set Initial velocity = 1e-6 * sin(pi * x / 50); 0
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = )" +
           digits(length + length / n_cells) + ", " + edge + R"(
      set Cells = )" +
           std::to_string(n_cells + 1) + R"(, 1
    end
    subsection Boundaries
      set right = free
    end)";
  }



  /** Displacement and velocity over their amplitudes. */
  using Motion = std::array<double, 2>;



  /** The motion of every point, by its place at the start. */
  std::vector<std::pair<double, Motion>>
  motion(const unsigned int n_cells,
         const std::string &order,
         const double       time,
         const unsigned int n_steps)
  {
    SceneRun<2> run(bar(n_cells), {"Method/Stress update=" + order});
    const auto  start = run.positions();
    run.advance(time / n_steps, n_steps);
    std::vector<std::pair<double, Motion>> result;
    for (std::size_t p = 0; p < start.size(); ++p)
      {
        const double x = start[run.bodies[0]->points.id(p)][0];
        result.push_back(
          {x,
           {{(run.position(p)[0] - x) * omega / v0, run.velocity(p)[0] / v0}}});
      }
    return result;
  }



  /** Root mean square errors of the points at x >= @p from. */
  Motion
  errors(const std::vector<std::pair<double, Motion>> &points,
         const double                                  time,
         const double                                  from = 0)
  {
    Motion   sum{};
    unsigned n = 0;
    for (const auto &[x, value] : points)
      if (x >= from)
        {
          const double shape = std::sin(k * x);
          sum[0] += std::pow(value[0] - shape * std::sin(omega * time), 2);
          sum[1] += std::pow(value[1] - shape * std::cos(omega * time), 2);
          ++n;
        }
    return {{std::sqrt(sum[0] / n), std::sqrt(sum[1] / n)}};
  }



  /** The share of the first mode in the motion. */
  Motion
  first_mode(const std::vector<std::pair<double, Motion>> &points)
  {
    Motion sum{};
    double norm = 0;
    for (const auto &[x, value] : points)
      {
        const double shape = std::sin(k * x);
        norm += shape * shape;
        for (unsigned int i = 0; i < 2; ++i)
          sum[i] += shape * value[i];
      }
    return {{sum[0] / norm, sum[1] / norm}};
  }
} // namespace



// The displacement of all points, and the velocity away from the wall: in the
// cell next to it FLIP points keep an error of the order of h.
TEST(Bar, SecondOrderInSpace)
{
  const double time = 0.85 * period;
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      std::vector<Motion> all, inside;
      for (const unsigned int n : {8u, 16u, 32u})
        {
          // dt ~ h^2, so that the first order in time does not show
          const auto points = motion(n, order, time, 20 * n * n);
          all.push_back(errors(points, time));
          inside.push_back(errors(points, time, length / 8));
        }
      for (unsigned int i = 0; i < 2; ++i)
        {
          EXPECT_GE(all[i][0] / all[i + 1][0], 3.2);
          EXPECT_GE(inside[i][1] / inside[i + 1][1], 3.2);
        }
      EXPECT_LT(all[2][0], 1e-3);
      EXPECT_LT(inside[2][1], 2e-3);
    }
}



// Symplectic Euler: the velocity of a point is that of the middle of a step,
// so it is of first order. The displacement is, too, with USF; with USL and
// MUSL what remains of it is a hundred times smaller. With half of the strain
// at either end of the step both are of second order.
TEST(Bar, OrderInTime)
{
  const double time = 0.85 * period;
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      std::vector<Motion> m;
      for (const unsigned int n : {200u, 400u, 800u, 1600u})
        m.push_back(first_mode(motion(16, order, time, n)));
      if (order == "usavg")
        {
          for (unsigned int i = 0; i < 2; ++i)
            for (unsigned int k = 0; k < 2; ++k)
              EXPECT_NEAR((m[i][k] - m[i + 1][k]) / (m[i + 1][k] - m[i + 2][k]),
                          4,
                          0.6);
          continue;
        }
      for (unsigned int i = 0; i < 2; ++i)
        {
          const double shape_error = m[i][0] - m[i + 1][0];
          const double ratio =
            (m[i][1] - m[i + 1][1]) / (m[i + 1][1] - m[i + 2][1]);
          EXPECT_NEAR(ratio, 2, 0.1);
          if (order == "usf")
            EXPECT_NEAR(shape_error / (m[i + 1][0] - m[i + 2][0]), 2, 0.1);
          else
            EXPECT_LT(std::abs(shape_error),
                      0.05 * std::abs(m[i][1] - m[i + 1][1]));
        }
    }
}



// All points of a cell with 'cell' have the same change of volume, so as long
// as they stay in it the mean is what each of them has, and to put it in its
// place or to tend to it changes nothing, whenever in a step the strain is
// taken.
TEST(Bar, HistoriesOfPointsThatStayMayBeReplaced)
{
  for (const std::string &order : stress_update_orders)
    for (const std::vector<std::string> &history :
         std::vector<std::vector<std::string>>{{"replace"},
                                               {"crossing"},
                                               {"relax", "Relaxation time=1"}})
      {
        SCOPED_TRACE(order + ", " + history.front());
        const auto velocities = [&](const std::vector<std::string> &entries) {
          std::vector<std::string> overrides = {
            "Method/Stress update=" + order, "Body bar/Locking treatment=cell"};
          for (const std::string &entry : entries)
            overrides.push_back("Body bar/" + entry);
          SceneRun<2> run(bar(16), overrides);
          run.advance(0.02 * period / 16, 400);
          std::vector<double> result;
          for (std::size_t p = 0; p < run.points().size; ++p)
            result.push_back(run.velocity(p)[0]);
          return result;
        };
        auto replaced    = history;
        replaced.front() = "History=" + history.front();
        const auto a     = velocities({});
        const auto b     = velocities(replaced);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t p = 0; p < a.size(); ++p)
          EXPECT_NEAR(a[p], b[p], 1e-11 * v0);
      }
}



// Theory, 6.9. The wall does no work; what little the ledger books is lost by
// points whose velocity is against the wall. What the balance leaves swings
// with the bar, as it does with symplectic Euler, and does not grow.
TEST(Bar, EnergyIsKeptForTenPeriods)
{
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      std::vector<double> largest_drift;
      for (const double courant_number : {0.4, 0.2})
        {
          SceneRun<2>  run(bar(32), {"Method/Stress update=" + order});
          const double start = run.totals().all.total_energy();
          const double step  = courant_number * length / 32 / wave_speed;
          largest_drift.push_back(0);
          while (run.time < 10 * period)
            {
              run.advance(step, 5);
              largest_drift.back() =
                std::max(largest_drift.back(),
                         std::abs(run.totals().energy_drift));
            }
          const auto totals = run.totals();
          EXPECT_LT(std::abs(totals.boundary_work), 1e-4 * start);
          EXPECT_LT(totals.momentum_error, 1e-12);
          const double half_step_angle = 0.5 * omega * step;
          EXPECT_LT(largest_drift.back(),
                    order == "usavg" ? 2 * half_step_angle * half_step_angle :
                                       1.2 * half_step_angle);
        }
      if (order != "usavg")
        {
          EXPECT_NEAR(largest_drift[0] / largest_drift[1], 2, 0.2);
        }
    }
}
