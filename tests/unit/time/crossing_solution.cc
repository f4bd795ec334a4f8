// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file A manufactured solution that takes points through cells: a neo-Hookean
 * square between slip walls moves by
 *
 *   x = X + a sin(2 pi X),  y = Y - a sin(2 pi Y),  a = A sin(pi t), A = 0.05.
 *
 * With the stretches F = dx/dX, H = dy/dY and J = F H the stress along x is
 *
 *   P = tau / F = K/2 (F H^2 - 1/F) + mu/3 J^(-2/3) (2 F - (H^2 + 1) / F),
 *
 * and the balance of momentum asks for the body force b = d2x/dt2 - dP/dX
 * (density 1), which points get as a kick before each step, at the place where
 * they should be. At t = 1 all is back.
 */

using namespace limber;

namespace
{
  constexpr double crossing_amplitude = 0.05; // A, m

  std::string
  crossing_square(const unsigned int n)
  {
    const std::string cells = std::to_string(n);
    return R"(
    set Bodies = square
    subsection Body square
      subsection Box
        set Upper corner = 1, 1
      end
      set Points per cell edge = 3
      set Initial velocity = 0.05*pi*sin(2*pi*x); -0.05*pi*sin(2*pi*y)
)" + rubber("1", "0.3") +
           R"(
      set Frame = current
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 1, 1
      set Cells = )" +
           cells + ", " + cells + R"(
    end
    subsection Method
      set Transfer order = 4
    end)";
  }



  /** b along a direction with the amplitude a, across one with -a. */
  double
  crossing_force(const double X, const double Y, const double a)
  {
    constexpr double k = 2 * dealii::numbers::PI, K = 1 / 1.2, mu = 1 / 2.6;
    const double     F = 1 + k * a * std::cos(k * X);
    const double     H = 1 - k * a * std::cos(k * Y);
    const double     dP_dF =
      K / 2 * (H * H + 1 / (F * F)) +
      mu / 9 * std::pow(F * H, -2. / 3) * (2 + 5 * (H * H + 1) / (F * F));
    return a * std::sin(k * X) * k * k * (dP_dF - 0.25);
  }



  /** The largest error of all points after half a period, over A. */
  double
  crossing_error(const std::string &kernel,
                 const std::string &transfer,
                 const unsigned int n)
  {
    SceneRun<2> run(crossing_square(n),
                    {"Method/Kernel=" + kernel,
                     "Method/Transfer=" + transfer,
                     std::string("Method/Stress update=") +
                       (transfer == "fmpm" || kernel.substr(0, 4) == "cpdi" ?
                          "usl" :
                          "musl")});
    const auto  start = run.positions();
    const auto  a     = [&]() {
      return crossing_amplitude * std::sin(dealii::numbers::PI * run.time);
    };
    // dt ~ h^2, for the first order in time not to show
    const unsigned int n_steps = 5 * n * n / 8;
    const double       step    = 1. / n_steps;
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        const PointView<2> view = run.points();
        // velocities are those of the middle of a step
        const double length = (k == 0 ? 0.5 : 1) * step;
        for (std::size_t p = 0; p < view.size; ++p)
          {
            const auto &X = start[run.bodies[0]->points.id(p)];
            view.velocity[0][p] += length * crossing_force(X[0], X[1], a());
            view.velocity[1][p] += length * crossing_force(X[1], X[0], -a());
          }
        run.advance(step);
      }
    const auto end    = run.positions();
    double     result = 0;
    for (std::size_t p = 0; p < end.size(); ++p)
      result =
        std::max(result, (end[p] - start[p]).norm() / crossing_amplitude);
    std::printf(
      "%s, %s, h = 1/%u: %.4f\n", kernel.c_str(), transfer.c_str(), n, result);
    return result;
  }



  void
  expect_order(const std::string               &kernel,
               const std::string               &transfer,
               const std::vector<unsigned int> &grids,
               const double                     order)
  {
    std::vector<double> e;
    for (const unsigned int n : grids)
      e.push_back(crossing_error(kernel, transfer, n));
    for (std::size_t k = 1; k < e.size(); ++k)
      EXPECT_GE(std::log2(e[k - 1] / e[k]), order);
  }
} // namespace



TEST(CrossingSolution, LinearFunctionsStall)
{
  EXPECT_GT(crossing_error("linear", "flip", 32),
            crossing_error("linear", "flip", 16));
}



// Until they come down to what cells err that sample points at uneven
// distances, about half a percent: FMPM does with eight cells, FLIP is close to
// it with 32.
TEST(CrossingSolution, SplinesAreOfSecondOrder)
{
  expect_order("quadratic", "flip", {8, 16}, 1.8);
  expect_order("quadratic", "aflip", {8, 16}, 1.8);
  EXPECT_LT(crossing_error("quadratic", "flip", 32), 0.02);
  const double coarse = crossing_error("quadratic", "fmpm", 4);
  for (const unsigned int n : {8u, 16u, 32u})
    EXPECT_LT(crossing_error("quadratic", "fmpm", n), coarse / 11);
}



TEST(CrossingSolution, CubicSplinesAreOfSecondOrder)
{
  expect_order("cubic", "flip", {8, 16}, 1.8);
  expect_order("cubic", "fmpm", {4, 8}, 1.8);
}



// The boxes of GIMP sample linear functions continuously.
TEST(CrossingSolution, BoxesAreOfFirstOrderAtLeast)
{
  for (const std::string kernel : {"gimp", "cpgimp"})
    expect_order(kernel, "flip", {8, 16}, 1);
}



// What is continuous are the gradients; points still sample them unevenly.
TEST(CrossingSolution, DualDomainsErrLessThanLinearFunctions)
{
  EXPECT_LT(crossing_error("ddmp", "flip", 16),
            0.5 * crossing_error("linear", "flip", 16));
}



TEST(CrossingSolution, ConvectedDomainsAreOfSecondOrder)
{
  for (const std::string kernel : {"cpdi", "cpdi2"})
    {
      EXPECT_LT(crossing_error(kernel, "flip", 8), 0.12) << kernel;
      expect_order(kernel, "flip", {16, 32}, 1.8);
    }
}
