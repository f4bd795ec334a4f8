// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file What the transfers between points and grid do to a wave of velocity
 * cos(k x), without any stress. Two points per cell edge at the quarters give
 * the symbol 0.625 + 0.375 cos(k h) per step of PIC, a viscosity of 3 h^2 /
 * (16 dt) for long waves, and a null space that FLIP does not see.
 */

using namespace limber;

namespace
{
  constexpr unsigned int n_cells = 16;
  constexpr double       step    = 1e-3;  // s
  constexpr double       speed   = 1e-12; // m/s: no point moves

  // The ends are free: a cosine is even there, so they change nothing.
  const std::string wave_strip = R"(
    set Bodies = fluid
    subsection Body fluid
      subsection Box
        set Upper corner = 16, 1
      end
      set Points per cell edge = 2
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 1e-9
      end
    end
    subsection Grid
      set Upper corner = 16, 1
      set Cells = 16, 1
    end
    subsection Boundaries
      set left = free
      set right = free
    end)";



  /** The wave as the grid sees it: interpolated between its nodes. */
  double
  wave(const double kh, const double x)
  {
    const double node = std::floor(x), xi = x - node;
    return (1 - xi) * std::cos(kh * node) + xi * std::cos(kh * (node + 1));
  }



  void
  set_wave(SceneRun<2> &run, const double kh)
  {
    const PointView<2> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      points.velocity[0][p] = speed * wave(kh, points.position[0][p]);
  }



  /** The largest and the smallest share of the wave left at a point. */
  std::pair<double, double>
  amplitude(SceneRun<2> &run, const double kh)
  {
    const PointView<2>        points = run.points();
    std::pair<double, double> result(1e300, -1e300);
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const double start = wave(kh, points.position[0][p]);
        if (std::abs(start) < 1e-3)
          continue;
        const double share = points.velocity[0][p] / (speed * start);
        result.first       = std::min(result.first, share);
        result.second      = std::max(result.second, share);
      }
    return result;
  }



  double
  symbol(const double kh)
  {
    return 0.625 + 0.375 * std::cos(kh);
  }



  /**
   * Velocities (+1, -1) of the two columns of points in every cell, turned at
   * the ends such that their nodes have no momentum either.
   */
  void
  set_null_mode(SceneRun<2> &run)
  {
    const PointView<2> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const double       x    = points.position[0][p];
        const unsigned int cell = x;
        const bool         low  = x - cell < 0.5;
        double             v    = low ? 1 : -1;
        if (cell == 0)
          v = low ? 0.25 : -0.75;
        if (cell == n_cells - 1)
          v = low ? 0.75 : -0.25;
        points.velocity[0][p] = speed * v;
      }
  }
} // namespace



TEST(VelocityWaves, PicMultipliesByTheSymbol)
{
  const double                                 pi       = dealii::numbers::PI;
  const std::vector<std::pair<double, double>> expected = {{pi / 8, 0.9715},
                                                           {pi / 4, 0.8901},
                                                           {pi / 2, 0.6250},
                                                           {pi, 0.25}};
  for (const std::string &order : stress_update_orders)
    for (const auto &[kh, share] : expected)
      {
        SCOPED_TRACE(order + ", k h = " + std::to_string(kh));
        SceneRun<2> run(wave_strip,
                        {"Method/Transfer=pic",
                         "Method/Stress update=" + order});
        set_wave(run, kh);
        // The first step takes the wave from the points to the grid as the
        // interpolation of its nodal values.
        run.advance(step);
        const auto [lowest, highest] = amplitude(run, kh);
        EXPECT_NEAR(lowest, symbol(kh), 1e-9);
        EXPECT_NEAR(highest, symbol(kh), 1e-9);
        EXPECT_NEAR(lowest, share, 1e-3 * share);
      }
}



TEST(VelocityWaves, PicIsAViscosity)
{
  const double       kh = dealii::numbers::PI / 8; // < 0.4
  const unsigned int n  = 40;
  for (const double blend_time : {0., 4 * step})
    {
      SceneRun<2> run(wave_strip,
                      {std::string("Method/Transfer=") +
                         (blend_time > 0 ? "flip" : "pic"),
                       "Method/Blend time=" + std::to_string(blend_time)});
      set_wave(run, kh);
      run.advance(step, n);
      const double share     = blend_time > 0 ? step / blend_time : 1;
      const double viscosity = share * 3. / (16 * step);
      const double rate      = -std::log(amplitude(run, kh).first) / (n * step);
      EXPECT_NEAR(rate, viscosity * kh * kh, 0.05 * viscosity * kh * kh);
    }
}



TEST(VelocityWaves, FlipKeepsEveryWave)
{
  for (const double kh : {0.25, 0.5, 1.})
    {
      SceneRun<2> run(wave_strip);
      set_wave(run, kh * dealii::numbers::PI);
      run.advance(step, 1000);
      EXPECT_NEAR(amplitude(run, kh * dealii::numbers::PI).first, 1, 1e-10);
      EXPECT_NEAR(amplitude(run, kh * dealii::numbers::PI).second, 1, 1e-10);
    }
}



TEST(VelocityWaves, NullModeIsKeptByFlipAndRemovedByPic)
{
  for (const std::string &order : stress_update_orders)
    {
      SCOPED_TRACE(order);
      const auto share_of_energy = [&](const std::string &transfer,
                                       const double       blend_time,
                                       const unsigned int n) {
        SceneRun<2> run(wave_strip,
                        {"Method/Transfer=" + transfer,
                         "Method/Blend time=" + std::to_string(blend_time),
                         "Method/Stress update=" + order});
        set_null_mode(run);
        const double before = run.totals().all.kinetic_energy;
        run.advance(step, n);
        return run.totals().all.kinetic_energy / before;
      };
      EXPECT_NEAR(share_of_energy("flip", 0, 1000), 1, 1e-12);
      EXPECT_NEAR(share_of_energy("aflip", 0, 1000), 1, 1e-12);
      EXPECT_LT(share_of_energy("pic", 0, 1), 1e-24);
      // APIC takes velocity from the grid and keeps the gradient there: none.
      EXPECT_LT(share_of_energy("apic", 0, 1), 1e-24);
      const double alpha = 1 - step / 0.05;
      for (const unsigned int n : {1u, 10u, 100u})
        for (const std::string transfer : {"flip", "aflip"})
          EXPECT_NEAR(share_of_energy(transfer, 0.05, n) /
                        std::pow(alpha, 2 * n),
                      1,
                      1e-10);
    }
}
