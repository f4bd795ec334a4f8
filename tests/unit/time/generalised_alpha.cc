// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/time/generalised_alpha.h>

#include <gtest/gtest.h>
#include <support/held_strip.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file Implicit steps that damp what is faster than they are (J. Chung, G. M.
 * Hulbert, J. Appl. Mech. 60, 1993).
 */

using namespace limber;

namespace
{
  constexpr double bar_length = 25, speed_of_sound = 10;
  // of a bar that is held at one end, 1/s
  constexpr double lowest_frequency =
    0.5 * dealii::numbers::PI / bar_length * speed_of_sound;

  /** A bar along x, held at the left, of this many cells: E = 100, rho = 1. */
  std::string
  held_bar(const unsigned int n_cells, const std::string &velocity)
  {
    const std::string edge = digits(bar_length / n_cells);
    return R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 25, )" +
           edge + R"(
      end
      set Initial velocity = )" +
           velocity + R"(; 0
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = )" +
           digits(bar_length + bar_length / n_cells) + ", " + edge + R"(
      set Cells = )" +
           std::to_string(n_cells + 1) + R"(, 1
    end
    subsection Boundaries
      set right = free
    end
    subsection Method
      set Time integration = implicit
      set Newton tolerance = 1e-10
    end)";
  }

  const std::string lowest_mode = "1e-3 * sin(pi * x / 50)";

  std::vector<std::string>
  with_radius(const double                    radius,
              const double                    step,
              const std::vector<std::string> &more = {})
  {
    std::vector<std::string> result = {"Method/Time integration=implicit",
                                       "Method/Spectral radius at infinity=" +
                                         digits(radius),
                                       "Method/Time step=" + digits(step)};
    result.insert(result.end(), more.begin(), more.end());
    return result;
  }

  /** Shares of the lowest mode in displacement and velocity. */
  std::array<double, 2>
  share_of_lowest_mode(SceneRun<2>                         &run,
                       const std::vector<dealii::Point<2>> &start)
  {
    std::array<double, 2> sum{};
    double                norm = 0;
    for (std::size_t p = 0; p < start.size(); ++p)
      {
        const double x = start[run.bodies[0]->points.id(p)][0];
        const double shape =
          std::sin(0.5 * dealii::numbers::PI / bar_length * x);
        norm += shape * shape;
        sum[0] += shape * (run.position(p)[0] - x);
        sum[1] += shape * run.velocity(p)[0];
      }
    return {{sum[0] / norm, sum[1] / norm}};
  }
} // namespace



// Newmark's trapezoidal rule to the last bit, whatever acceleration there is.
TEST(GeneralisedAlpha, IsTheTrapezoidalRuleAtOne)
{
  const GeneralisedAlpha scheme(1);
  const double           m = 0.37, u = 0.0123, v = -1.71, a = 31.4, dt = 0.0171;
  EXPECT_FALSE(scheme.needs_acceleration());
  EXPECT_EQ(scheme.share_of_beginning(), 1);
  EXPECT_EQ(scheme.inertia() * m / (dt * dt), 4 * m / (dt * dt));
  EXPECT_EQ(scheme.ahead(v, a, dt), dt * v);
  EXPECT_EQ(scheme.velocity(u, v, a, dt), 2 * u / dt - v);
}



// The formulas in use are those of Chung and Hulbert with their parameters.
TEST(GeneralisedAlpha, SolvesTheEquationsOfChungAndHulbert)
{
  for (const double r : {0., 0.3, 0.8, 1.})
    {
      const double am = (2 * r - 1) / (r + 1), af = r / (r + 1);
      const double gamma = 0.5 - am + af;
      const double beta  = 0.25 * (1 - am + af) * (1 - am + af);
      const double m = 0.37, v0 = -1.71, a0 = 31.4, dt = 0.0171;
      const double F0 = 4.1, F1 = -7.3;

      const GeneralisedAlpha scheme(r);
      const double           u =
        scheme.ahead(v0, a0, dt) + (F1 + scheme.share_of_beginning() * F0) /
                                     (scheme.inertia() * m / (dt * dt));
      const double a1 = scheme.acceleration(u, v0, a0, dt);
      EXPECT_NEAR(m * ((1 - am) * a1 + am * a0),
                  (1 - af) * F1 + af * F0,
                  1e-12);
      EXPECT_NEAR(u,
                  dt * v0 + dt * dt * ((0.5 - beta) * a0 + beta * a1),
                  1e-15);
      EXPECT_NEAR(scheme.velocity(u, v0, a0, dt),
                  v0 + dt * ((1 - gamma) * a0 + gamma * a1),
                  1e-13);
    }
}



// The lowest vibration of a bar: errors go down with the square of the step,
// and the shortest steps give the exact motion but for the cells' error.
TEST(GeneralisedAlpha, IsOfSecondOrder)
{
  const double time = 0.85 * 2 * dealii::numbers::PI / lowest_frequency;
  for (const double radius : {1., 0.8, 0.5, 0.})
    {
      SCOPED_TRACE(radius);
      std::vector<std::array<double, 2>> m;
      for (const unsigned int n : {100u, 200u, 400u, 800u})
        {
          SceneRun<2> run(held_bar(32, lowest_mode),
                          with_radius(radius, time / n));
          const auto  start = run.positions();
          run.advance(time / n, n);
          m.push_back(share_of_lowest_mode(run, start));
        }
      const std::array<double, 2> exact{
        {1e-3 / lowest_frequency * std::sin(lowest_frequency * time),
         1e-3 * std::cos(lowest_frequency * time)}};
      for (unsigned int k = 0; k < 2; ++k)
        {
          for (unsigned int i = 0; i < 2; ++i)
            {
              const double ratio =
                (m[i][k] - m[i + 1][k]) / (m[i + 1][k] - m[i + 2][k]);
              EXPECT_NEAR(ratio, 4, 0.6);
            }
          EXPECT_NEAR(m[3][k] / exact[k], 1, 5e-3);
        }
    }
}



// A step multiplies displacement, velocity and acceleration of an oscillator by
// a matrix whose eigenvalues become -r, all three, if it is fast.
TEST(GeneralisedAlpha, RadiusIsThatOfFastOscillators)
{
  const double m = 0.37, dt = 0.0171, k = 1e12 * m / (dt * dt);
  for (const double r : {0., 0.2, 0.5, 0.8, 0.9, 1.})
    {
      const GeneralisedAlpha scheme(r);
      dealii::Tensor<2, 3>   matrix;
      for (unsigned int i = 0; i < 3; ++i)
        {
          // a step from one of the three, each of the size of x = 1
          const double x = i == 0, v = (i == 1) / dt, a = (i == 2) / (dt * dt);
          const double inertia = scheme.inertia() * m / (dt * dt);
          const double u       = (inertia * scheme.ahead(v, a, dt) -
                            (1 + scheme.share_of_beginning()) * k * x) /
                           (inertia + k);
          matrix[0][i] = x + u;
          matrix[1][i] = scheme.velocity(u, v, a, dt) * dt;
          matrix[2][i] = scheme.acceleration(u, v, a, dt) * dt * dt;
        }
      EXPECT_NEAR(trace(matrix), -3 * r, 1e-9) << r;
      EXPECT_NEAR(determinant(matrix), -r * r * r, 1e-9) << r;
    }
}



// Vibrations that pass thirty times in a step are multiplied by three roots -r,
// so that of displacements x(n+3) = c2 x(n+2) + c1 x(n+1) - r^3 x(n), which six
// of them tell.
TEST(GeneralisedAlpha, SpectralRadiusIsMeasured)
{
  const double step = 200 / lowest_frequency;
  for (const double radius : {0.5, 0.2})
    {
      SceneRun<2>         run(held_bar(64, lowest_mode),
                      with_radius(radius,
                                  step,
                                  {"Method/Newton tolerance=1e-7"}));
      const auto          start = run.positions();
      std::vector<double> x;
      for (unsigned int n = 0; n < 6; ++n)
        {
          run.advance(step);
          x.push_back(share_of_lowest_mode(run, start)[0]);
        }
      EXPECT_NE(run.integrator.effort().find("halved: 0"), std::string::npos);
      dealii::Tensor<2, 3> values;
      dealii::Tensor<1, 3> next;
      for (unsigned int i = 0; i < 3; ++i)
        {
          next[i] = x[i + 3];
          for (unsigned int j = 0; j < 3; ++j)
            values[i][j] = x[i + j];
        }
      const double product  = (dealii::invert(values) * next)[0];
      const double measured = -std::cbrt(product);
      EXPECT_NEAR(measured, radius, 0.01);
    }
}



// Continuously next to one, where points carry accelerations without effect.
TEST(GeneralisedAlpha, TendsToTheTrapezoidalRule)
{
  const auto end = [](const double radius) {
    SceneRun<2> run(held_strip,
                    with_radius(radius,
                                0.1,
                                {"Method/Newton tolerance=1e-11",
                                 "Body strip/Frame=initial",
                                 "Body strip/Initial velocity=0; x*x/40"}));
    run.advance(0.1, 20);
    return run.positions();
  };
  const auto rule = end(1), nearly = end(1 - 1e-8), damped = end(0.8);
  double     furthest = 0, furthest_damped = 0;
  for (std::size_t p = 0; p < rule.size(); ++p)
    {
      furthest        = std::max(furthest, rule[p].distance(nearly[p]));
      furthest_damped = std::max(furthest_damped, rule[p].distance(damped[p]));
    }
  EXPECT_LT(furthest, 1e-6);
  EXPECT_GT(furthest_damped, 1e-4);
}



// What is damped is on record: a bar that is let go in a sharp step of the
// velocity loses energy, and the balance closes but for the strain (1e-4) by
// which forces are not linear.
TEST(GeneralisedAlpha, DampingIsOnRecord)
{
  double former = 0;
  for (const double radius : {1., 0.8, 0.})
    {
      SceneRun<2> run(held_bar(32, "1e-3 * sin(7 * pi * x / 50)"),
                      with_radius(radius, 0.25));
      run.advance(0.25, 40);
      const auto totals = run.totals();
      EXPECT_LT(std::abs(totals.energy_drift), 1e-4);
      EXPECT_LT(std::abs(totals.momentum_error), 1e-9);
      EXPECT_GT(totals.dissipated, former);
      former = totals.dissipated;
      EXPECT_EQ(run.integrator.effort().find("generalised-alpha") !=
                  std::string::npos,
                radius < 1);
    }
}



// In large motion as with the trapezoidal rule (NewtonSteps).
TEST(GeneralisedAlpha, SwingingStripBalancesItsEnergy)
{
  for (const double step : {0.2, 0.1})
    {
      SceneRun<2> run(held_strip,
                      with_radius(0.8,
                                  step,
                                  {"Body strip/Frame=initial",
                                   "Body strip/Initial velocity=0; x*x/40"}));
      run.totals();
      run.advance(step, std::lround(10 / step));
      const auto totals = run.totals();
      EXPECT_LT(std::abs(totals.energy_drift), 5e-3);
    }
}



// A side that moves faster and faster takes the bar along: momentum comes from
// it alone, and at last, after twenty swings in steps that damp them, all moves
// as it does, stretched by its own inertia.
TEST(GeneralisedAlpha, SidesThatMoveAreFollowed)
{
  const double acceleration = 1e-3, end = 200;
  SceneRun<2>  run(held_bar(16, "0"),
                  with_radius(0.2,
                              2,
                              {"Boundaries/left=velocity",
                                "Boundaries/Side left/Velocity=" +
                                  digits(acceleration) + "*t; 0",
                                "Body bar/Frame=initial"}));
  const auto   start = run.positions();
  run.totals();
  run.advance(2, std::lround(end / 2));
  const auto totals = run.totals();
  EXPECT_LT(std::abs(totals.momentum_error), 1e-9);
  EXPECT_LT(std::abs(totals.energy_drift), 1e-3);
  for (std::size_t p = 0; p < start.size(); ++p)
    EXPECT_NEAR(run.velocity(p)[0],
                acceleration * end,
                1e-3 * acceleration * end);
}



// The lowest vibration of a bar takes 21 steps, its ninth one and a quarter.
// The trapezoidal rule keeps both, but for what points do not get of short
// waves; generalised-alpha the lowest alone.
TEST(GeneralisedAlpha, FastVibrationsVanishAndSlowOnesStay)
{
  const double step = 0.3 / lowest_frequency;
  struct Shares
  {
    double slow, fast; // largest velocities of three swings, after two
  };
  const auto vibrate = [&](const double radius) {
    SceneRun<2> run(held_bar(128,
                             "1e-4 * (sin(pi * x / 50) + sin(17 * pi * x / "
                             "50))"),
                    with_radius(radius, step));
    const auto  start = run.positions();
    const auto  share = [&](const double number) {
      double sum = 0, norm = 0;
      for (std::size_t p = 0; p < start.size(); ++p)
        {
          const double shape = std::sin(number * dealii::numbers::PI / 50 *
                                        start[run.bodies[0]->points.id(p)][0]);
          norm += shape * shape;
          sum += shape * run.velocity(p)[0] / 1e-4;
        }
      return std::abs(sum / norm);
    };
    Shares result{0, 0};
    run.advance(step, 42);
    for (unsigned int n = 0; n < 63; ++n)
      {
        run.advance(step);
        result.slow = std::max(result.slow, share(1));
        result.fast = std::max(result.fast, share(17));
      }
    return result;
  };
  const Shares rule = vibrate(1), damped = vibrate(0.5);
  EXPECT_GT(rule.fast, 0.1);
  EXPECT_LT(damped.fast, 0.02);
  EXPECT_NEAR(damped.slow, rule.slow, 0.05);
}



// A bar flies against a wall: behind the front the stress is rho c v. In steps
// in which it passes eight cells the trapezoidal rule leaves waves behind the
// front that generalised-alpha takes away; mean and front stay.
TEST(GeneralisedAlpha, NoiseOfAStruckBarVanishes)
{
  const double       v = 1e-3, pressure = 1 * speed_of_sound * v / 3;
  const unsigned int n_cells = 128, cells_a_step = 8;
  const double step   = cells_a_step * bar_length / n_cells / speed_of_sound;
  double       former = 0, first = 0;
  for (const double radius : {1., 0.8, 0.5, 0.})
    {
      SceneRun<2> run(held_bar(n_cells, digits(-v)), with_radius(radius, step));
      run.advance(step, n_cells * 3 / 4 / cells_a_step);
      const auto points = run.points();
      double     mean = 0, square = 0, behind = 0, n = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const double share = points.pressure[p] / pressure;
          behind += share / points.size; // where the front is, over the length
          if (points.position[0][p] < 0.6 * bar_length)
            {
              mean += share;
              square += share * share;
              ++n;
            }
        }
      mean /= n;
      const double noise = std::sqrt(square / n - mean * mean);
      EXPECT_NEAR(mean, 1, 0.04);
      EXPECT_NEAR(behind, 0.75, 0.01);
      if (radius == 1)
        first = former = noise;
      else
        EXPECT_LT(noise, former);
      former = noise;
    }
  EXPECT_LT(former, 0.5 * first);
}
