// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file What kernels and transfers do to waves, against closed formulas. A
 * bar between two walls has the frequency f of its first mode lowered by
 * df / f = -a theta^2, theta = pi / N, on N cells (folded and open knots agree
 * to this order); a wave that FMPM(k) passes on loses the share (1 - S)^k of
 * its amplitude in a step, with S the symbol of S+ S; PIC acts as a viscosity.
 */

using namespace limber;

namespace
{
  using std::string;

  /** A bar of unit cells between walls, of unit wave speed; nu = 0. */
  string
  bar(const unsigned int n, const string &velocity)
  {
    return R"(
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = )" +
           std::to_string(n) + R"(, 1
      end
      set Points per cell edge = 2
      set Initial velocity = )" +
           velocity + R"(
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = )" +
           std::to_string(n) + R"(, 1
      set Cells = )" +
           std::to_string(n) + R"(, 1
    end)";
  }



  struct Choice
  {
    string kernel, transfer;

    std::vector<string>
    entries() const
    {
      std::vector<string> result = {"Method/Kernel=" + kernel};
      if (transfer.substr(0, 4) == "fmpm" || transfer.substr(0, 4) == "xpic")
        {
          result.push_back("Method/Transfer=" + transfer.substr(0, 4));
          result.push_back("Method/Transfer order=" + transfer.substr(5));
        }
      else
        {
          result.push_back("Method/Transfer=" + transfer);
          result.push_back("Method/Stress update=musl");
        }
      return result;
    }
  };



  /** Of sin(theta x) in a velocity of the points between two places. */
  double
  share_of_wave(SceneRun<2> &run,
                const double theta,
                const double from,
                const double to,
                const int    component = 0)
  {
    double sum = 0, norm = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      if (const double x = run.position(p)[0]; x > from && x < to)
        {
          const double shape = std::sin(theta * x);
          sum += shape * run.velocity(p)[component];
          norm += shape * shape;
        }
    return sum / norm;
  }



  /**
   * f / f_exact - 1 of the first mode, from its first and its fifth zero: what
   * no node sees of the motion shifts both alike.
   */
  double
  frequency_error(const unsigned int n, const Choice &method)
  {
    const double k = dealii::numbers::PI / n;
    SceneRun<2> run(bar(n, "1e-6 * sin(pi * x / " + std::to_string(n) + "); 0"),
                    method.entries());
    const double        step  = 0.01;
    const auto          shape = [&]() { return share_of_wave(run, k, 0, n); };
    std::vector<double> zeros;
    double              before = shape();
    while (zeros.size() < 5)
      {
        run.advance(step);
        const double now = shape();
        if ((now > 0) != (before > 0))
          zeros.push_back(run.time - step * now / (now - before));
        before = now;
      }
    return 4 * dealii::numbers::PI / (k * (zeros[4] - zeros[0])) - 1;
  }
} // namespace



// Table B4: a = 0.1354, 0.260 and 0.333 with FLIP; with the full mass waves are
// as good as the functions of the nodes are.
TEST(Dispersion, LoweredFrequenciesFollowTheClosedFormula)
{
  struct Expected
  {
    Choice                    method;
    double                    a, tolerance;
    std::vector<unsigned int> cells = {8, 16};
  };
  for (const auto &[method, a, tolerance, cells] :
       {// the walls take from points what they bring, an error of order 1 / N
        Expected{{"linear", "flip"}, 0.1354, 0.006, {64}},
        Expected{{"quadratic", "flip"}, 0.260, 0.010},
        // the mass of the functions next to a wall is not that of mirrored
        // material, an error of order 1 / N as well
        Expected{{"cubic", "flip"}, 0.333, 0.012, {32}},
        // of points at a quarter of the cell, alpha = 9/16: 7/12 (1 - alpha) +
        // alpha / 12 - (1 - alpha)^2 / 16 of K and 3/16 of S, by halves; walls
        // do to them what they do to linear ones
        Expected{{"ddmp", "flip"}, 0.2388, 0.008, {64}},
        // domains that do not reach across the faces of cells, as those of
        // points at rest, see linear functions
        Expected{{"gimp", "flip"}, 0.1354, 0.006, {64}},
        Expected{{"cpgimp", "flip"}, 0.1354, 0.006, {64}},
        Expected{{"cpdi", "flip"}, 0.1354, 0.006, {64}},
        Expected{{"cpdi2", "flip"}, 0.1354, 0.006, {64}},
        Expected{{"linear", "fmpm 4"}, -0.052, 0.008},
        Expected{{"gimp", "fmpm 4"}, -0.052, 0.008},
        Expected{{"cpgimp", "fmpm 4"}, -0.052, 0.008},
        Expected{{"cpdi", "fmpm 4"}, -0.052, 0.008},
        Expected{{"cpdi2", "fmpm 4"}, -0.052, 0.008},
        // 7/12 (1 - alpha) + alpha / 12 - (1 - alpha)^2 / 16 less 3/16, by
        // halves
        Expected{{"ddmp", "fmpm 4"}, 0.0513, 0.004, {16}},
        Expected{{"quadratic", "fmpm 4"}, 0.0104, 0.004},
        Expected{{"cubic", "fmpm 4"}, 0.002, 0.004},
        Expected{{"quadratic", "xpic 4"}, 0.125, 0.02}})
    for (const unsigned int n : cells)
      {
        SCOPED_TRACE(method.kernel + ", " + method.transfer + ", " +
                     std::to_string(n) + " cells");
        const double theta = dealii::numbers::PI / n;
        EXPECT_NEAR(-frequency_error(n, method) / (theta * theta),
                    a,
                    tolerance);
      }
}



// No node sees velocities +1 and -1 of the points of a cell.
TEST(Dispersion, NullSpaceIsGoneAfterOneStep)
{
  for (const string kernel :
       {"linear", "quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2"})
    for (const string order : {"1", "2", "4", "16"})
      {
        SCOPED_TRACE(kernel + ", FMPM(" + order + ")");
        SceneRun<2> run(bar(8, "1e-6 * if(x - floor(x) < 0.5, 1, -1); 0"),
                        Choice{kernel, "fmpm " + order}.entries());
        const auto  size = [&]() {
          double result = 0;
          for (std::size_t p = 0; p < run.points().size; ++p)
            result += run.velocity(p).norm_square();
          return std::sqrt(result / run.points().size);
        };
        const double before = size();
        run.advance(1e-6);
        EXPECT_LT(size(), 1e-12 * before);
      }
}



// Dense points: S = (2 + c) / 3, (33 + 26 c + c2) / 60 and (1208 + 1191 c +
// 120 c2 + c3) / 2520. A step so short that stress does nothing leaves only the
// transfer.
TEST(Dispersion, FmpmLosesOfAWaveWhatItsOrderSays)
{
  constexpr unsigned int n = 32;
  const double theta       = dealii::numbers::PI / 8; // a wave of sixteen cells
  for (const string kernel : {"linear", "quadratic", "cubic"})
    {
      const double c = std::cos(theta), c2 = std::cos(2 * theta),
                   c3 = std::cos(3 * theta);
      const double S =
        kernel == "linear"    ? (2 + c) / 3 :
        kernel == "quadratic" ? (33 + 26 * c + c2) / 60 :
                                (1208 + 1191 * c + 120 * c2 + c3) / 2520;
      for (const unsigned int k : {1u, 2u, 3u})
        {
          SCOPED_TRACE(kernel + ", FMPM(" + std::to_string(k) + ")");
          auto entries = Choice{kernel, "fmpm " + std::to_string(k)}.entries();
          entries.push_back("Body bar/Points per cell edge=8, 1");
          SceneRun<2> run(bar(n, "1e-6 * sin(pi / 8 * x); 0"), entries);
          run.advance(1e-9); // from then on it is a wave of the nodes
          const double           before = share_of_wave(run, theta, 8, 24);
          constexpr unsigned int steps  = 4;
          run.advance(1e-9, steps);
          const double lost =
            1 - std::pow(share_of_wave(run, theta, 8, 24) / before, 1. / steps);
          EXPECT_NEAR(lost, std::pow(1 - S, k), 0.03 * std::pow(1 - S, k));
        }
    }
}



// nu = (p + 1) / 12 h^2 / dt with dense points, p being the degree, and with 2
// points per edge 3/16, 1/4 or 1/3; for waves along the bar as for shear.
TEST(Dispersion, PicIsAViscosity)
{
  const double theta = dealii::numbers::PI / 16;
  struct Expected
  {
    string kernel, points;
    double nu; // h^2 / dt
  };
  for (const auto &[kernel, points, expected] :
       {Expected{"linear", "2", 3. / 16},
        Expected{"linear", "8, 1", 1. / 6},
        Expected{"quadratic", "2", 1. / 4},
        Expected{"quadratic", "8, 1", 1. / 4},
        Expected{"cubic", "2", 1. / 3},
        Expected{"cubic", "8, 1", 1. / 3},
        // domains within cells, as above
        Expected{"gimp", "2", 3. / 16},
        Expected{"cpdi", "2", 3. / 16}})
    for (const int component : {0, 1})
      {
        SCOPED_TRACE(kernel + ", " + points +
                     (component == 1 ? " points, shear" : " points"));
        const string wave    = "1e-6 * sin(pi / 16 * x)";
        auto         entries = Choice{kernel, "pic"}.entries();
        entries.push_back("Body bar/Points per cell edge=" + points);
        entries.push_back("Boundaries/bottom=free");
        entries.push_back("Boundaries/top=free");
        SceneRun<2> run(bar(64, component == 0 ? wave + "; 0" : "0; " + wave),
                        entries);
        const auto  share = [&]() {
          return share_of_wave(run, theta, 16, 48, component);
        };
        const double           before = share();
        constexpr unsigned int steps  = 4;
        run.advance(1e-9, steps);
        const double nu = -std::log(share() / before) / (steps * theta * theta);
        EXPECT_NEAR(nu, expected, 0.03 * expected);
      }
}
