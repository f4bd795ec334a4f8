// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <limits>

/**
 * @file The longest stable step of a bar in one cell, found by bisection on
 * the integrator, against the eigenvalues of the map of one step. With the
 * natural coordinates xi of points of equal mass, xb = <xi>, var = <xi^2> -
 * xb^2 and the Courant number C = c dt / h:
 *
 *   free      USL        C^2 = 4 xb (1 - xb) / (2 - var / (xb (1 - xb)))
 *             USF, MUSL  C^2 = 4 (xb (1 - xb))^2 / var
 *   clamped   USL        C^2 = 4 xb / (2 - <xi^2> / xb)
 *             USF, MUSL  C^2 = 4 xb^2 / <xi^2>
 *
 * Clamped means that the inner node, xi = 0, belongs to a heavy body.
 */

using namespace limber;

namespace
{
  // Ten times as wide as long: shear across the strip, which round-off excites,
  // then has a far longer critical step.
  const std::string strip = R"(
    subsection Body bar
      subsection Box
        set Lower corner = 1, 0
        set Upper corner = 2, 10
      end
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
        set Poisson's ratio = 0
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 3, 10
      set Cells = 3, 1
    end
    subsection Boundaries
      set left = free
      set right = free
    end)";

  const std::string bar_alone = R"(
    set Bodies = bar)";

  const std::string bar_and_anchor = R"(
    set Bodies = bar, anchor
    subsection Body anchor
      subsection Box
        set Lower corner = 0, 0
        set Upper corner = 1, 10
      end
      subsection Linear elastic
        set Density = 1e14
        set Young's modulus = 1
        set Poisson's ratio = 0
      end
    end)";



  struct Case
  {
    std::string         name;
    std::vector<double> xi; // of the points
  };

  const std::vector<Case> cases = {{"1 at 0.5", {0.5}},
                                   {"1 at 0.25", {0.25}},
                                   {"1 at 0.01", {0.01}},
                                   {"2 at 0.25, 0.75", {0.25, 0.75}},
                                   {"4 uniform", {0.125, 0.375, 0.625, 0.875}},
                                   {"2 uniform in [0, 0.1]", {0.025, 0.075}}};



  struct Moments
  {
    explicit Moments(const std::vector<double> &xi)
    {
      for (const double x : xi)
        {
          mean += x / xi.size();
          square += x * x / xi.size();
        }
    }

    double mean = 0, square = 0;
  };



  /** C at which the map of one step starts to grow; infinite: never. */
  double
  critical_courant_number(const std::vector<double> &xi,
                          const std::string         &order,
                          const bool                 clamped)
  {
    const Moments m(xi);
    const double  spread   = m.mean * (1 - m.mean);
    const double  variance = m.square - m.mean * m.mean;
    if (order == "usl")
      return clamped ? std::sqrt(4 * m.mean / (2 - m.square / m.mean)) :
                       std::sqrt(4 * spread / (2 - variance / spread));
    if (clamped)
      return 2 * m.mean / std::sqrt(m.square);
    // one point alone has no spread, up to round-off
    return variance > 1e-15 ? 2 * spread / std::sqrt(variance) :
                              std::numeric_limits<double>::infinity();
  }



  /** Tiny amplitudes, so that no point moves noticeably. */
  void
  set_state(SceneRun<2> &run, const std::vector<double> &xi, const bool clamped)
  {
    constexpr double   amplitude = 1e-12;
    const PointView<2> points    = run.points();
    const double       centre    = clamped ? 0 : Moments(xi).mean;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        // Points come in deal.II's order: along x first, then across.
        const double x        = xi[run.bodies[0]->points.id(p) % xi.size()];
        points.position[0][p] = 1 + x;
        points.velocity[0][p] = amplitude * (x - centre);
        points.pressure[p]    = -amplitude / 3;
        points.deviator[0][p] = amplitude * 2 / 3;
        points.deviator[1][p] = -amplitude / 3;
      }
  }



  bool
  is_stable(const Case        &c,
            const std::string &order,
            const bool         clamped,
            const double       courant_number)
  {
    SceneRun<2> run((clamped ? bar_and_anchor : bar_alone) + strip,
                    {"Body bar/Points per cell edge=" +
                       std::to_string(c.xi.size()) + ", 2",
                     "Method/Stress update=" + order});
    set_state(run, c.xi, clamped);
    const auto size = [&]() {
      const PointView<2> points = run.points();
      double             result = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        result = std::max({result,
                           std::abs(points.velocity[0][p]),
                           std::abs(points.deviator[0][p])});
      return result;
    };
    const double start = size();
    try
      {
        for (unsigned int n = 0; n < 2000; ++n)
          {
            run.advance(courant_number);
            if (!(size() < 1e3 * start))
              return false;
          }
      }
    catch (const ComputationError &)
      {
        return false;
      }
    return true;
  }



  double
  bisect(const Case &c, const std::string &order, const bool clamped)
  {
    double stable = 0.02, unstable = 5;
    EXPECT_TRUE(is_stable(c, order, clamped, stable));
    EXPECT_FALSE(is_stable(c, order, clamped, unstable));
    while (unstable - stable > 1e-3 * stable)
      {
        const double middle = 0.5 * (stable + unstable);
        (is_stable(c, order, clamped, middle) ? stable : unstable) = middle;
      }
    return 0.5 * (stable + unstable);
  }



  void
  compare_all(const bool clamped)
  {
    for (const std::string &order : stress_update_orders)
      for (const Case &c : cases)
        {
          SCOPED_TRACE(order + ", " + c.name);
          const double expected = critical_courant_number(c.xi, order, clamped);
          if (expected > 100)
            EXPECT_TRUE(is_stable(c, order, clamped, 20)) << "without limit";
          else
            {
              const double measured = bisect(c, order, clamped);
              EXPECT_NEAR(measured, expected, 0.01 * expected);
              testing::Test::RecordProperty((order + " " + c.name).c_str(),
                                            std::to_string(measured));
            }
        }
  }
} // namespace



TEST(OneCell, FreeCellIsStableUpToTheClosedLimit)
{
  compare_all(/*clamped=*/false);
}



TEST(OneCell, ClampedCellIsStableUpToTheClosedLimit)
{
  compare_all(/*clamped=*/true);
}
