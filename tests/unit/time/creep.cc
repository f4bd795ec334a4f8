// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file A bar at 20 degrees to the grid is pulled at both ends by a constant
 * tension and moves through the grid. Its elastic strain should stay; what it
 * grows by for every cell that its points pass, over the elastic strain, is the
 * creep of the kernel (doc/theory/kernels.md has these numbers).
 */

using namespace limber;

namespace
{
  constexpr double edge = 0.05, speed = 0.5; // of cells, m; along x, m/s
  constexpr double angle   = dealii::numbers::PI / 9;
  constexpr double tension = 10, young = 1000; // Pa

  std::string
  pulled_bar()
  {
    const double c = std::cos(angle), s = std::sin(angle);
    const auto   corner = [&](const double along, const double across) {
      return digits(0.3 + along * c - across * s) + ", " +
             digits(0.2 + along * s + across * c);
    };
    const std::string ramp = " * if(t < 0.25, 0.5 - 0.5 * cos(4*pi*t), 1)";
    const auto        load =
      [&](const std::string &name, const std::string &face, const double sign) {
        return "subsection Face load " + name +
               "\n set Body = bar\n set Face = " + face +
               "\n set Traction = " + digits(sign * tension * c) + ramp + "; " +
               digits(sign * tension * s) + ramp + "\n end\n";
      };
    return R"(
    set Bodies = bar
    subsection Body bar
      set Shape = block
      subsection Block
        set Corners = )" +
           corner(0, 0) + "; " + corner(1, 0) + "; " + corner(1, 0.25) + "; " +
           corner(0, 0.25) + R"(
      end
      set Placement = fitted
      set Initial velocity = 0.5; 0
)" + rubber("1000", "0.3") +
           R"(
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 2.5, 1
      set Cells = 50, 20
    end
)" + free_sides +
           R"(    subsection Loads
      set Face loads = pull, hold
      )" + load("pull", "right", 1) +
           load("hold", "left", -1) + R"(
    end)";
  }



  /** The mean strain along the bar, from the places of its points. */
  double
  strain(SceneRun<2> &run, const std::vector<dealii::Point<2>> &start)
  {
    // slope of the displacement along the bar over the place in it
    double n = 0, x = 0, u = 0, xx = 0, xu = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      {
        const auto id = run.bodies[0]->points.id(p);
        if (id >= start.size()) // a part that was not there
          continue;
        const auto   X     = start[id];
        const auto   d     = run.position(p) - X;
        const double along = X[0] * std::cos(angle) + X[1] * std::sin(angle);
        const double moved = d[0] * std::cos(angle) + d[1] * std::sin(angle);
        n += 1;
        x += along;
        u += moved;
        xx += along * along;
        xu += along * moved;
      }
    return (n * xu - x * u) / (n * xx - x * x);
  }



  constexpr double begin = 0.3; // of the measurement, s

  /** By how much the strain grows until @p end, s, over the elastic strain. */
  double
  growth(
    SceneRun<2>                 &run,
    const double                 end,
    const std::function<void()> &after_each_step = []() {})
  {
    const auto start = run.positions();
    // over two periods of what the bar still vibrates
    const auto mean_strain_from = [&](const double time) {
      run.advance_to(time, after_each_step);
      double       sum = 0;
      unsigned int n   = 0;
      run.advance_to(time + 0.121, [&]() {
        after_each_step();
        sum += strain(run, start);
        ++n;
      });
      return sum / n;
    };
    const double before  = mean_strain_from(begin);
    const double after   = mean_strain_from(end);
    const double elastic = tension / young * (1 - 0.3 * 0.3);
    return (after - before) / elastic;
  }



  double
  creep_per_cell(const std::string &kernel,
                 const unsigned int points,
                 const std::string &order = "auto")
  {
    SceneRun<2>      run(pulled_bar(),
                    {"Method/Kernel=" + kernel,
                          "Method/Stress update=" + order,
                          "Body bar/Points per cell edge=" +
                            std::to_string(points)});
    constexpr double end    = 1.3;
    const double     result = growth(run, end) / ((end - begin) * speed / edge);
    std::printf("%s, %s, %u points along an edge: %.5f of the elastic strain "
                "per cell\n",
                kernel.c_str(),
                order.c_str(),
                points,
                result);
    return result;
  }



  /** On its way all points come to cells of half the size. */
  double
  growth_of_split_points(const std::string &kernel)
  {
    SceneRun<2>   run(pulled_bar(),
                    {"Method/Kernel=" + kernel,
                       "Body bar/Placement=regular", // equal domains
                       "Body bar/Points per cell edge=2",
                       "Grid/Upper corner=3, 1",
                       "Grid/Cells=60, 20",
                       "Grid/Levels=1",
                       "Grid/Refine=right",
                       "Grid/Refine right/Where=x - 1.55"});
    Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
    const auto    n_start = run.points().size;
    const double  result  = growth(run, 2.75, [&]() {
      if (!adaptation.is_due(run.integrator.largest_displacement()))
        return;
      const auto loaded = run.integrator.detached_pieces();
      if (!adaptation.adapt(run.time, Adaptation<2>::KeptPoints(1)))
        return;
      run.integrator.reinit();
      run.integrator.attach(loaded);
    });
    EXPECT_EQ(run.points().size, 4 * n_start);
    std::printf("%s, split points: %.5f of the elastic strain\n",
                kernel.c_str(),
                result);
    return result;
  }
} // namespace



TEST(Creep, OfABarUnderTensionThatMovesThroughTheGrid)
{
  // the ratchet of linear functions
  EXPECT_GT(creep_per_cell("linear", 2), 0.1);
  EXPECT_GT(creep_per_cell("linear", 3), 0.02);
  // smooth functions
  EXPECT_LT(std::abs(creep_per_cell("quadratic", 2)), 0.01);
  EXPECT_LT(std::abs(creep_per_cell("quadratic", 3)), 0.001);
  EXPECT_LT(std::abs(creep_per_cell("cubic", 2)), 0.001);
  EXPECT_LT(std::abs(creep_per_cell("cubic", 3)), 0.0005);
}



// Domains that get load where they get stress do not.
TEST(Creep, OfConvectedDomainsIsNone)
{
  for (const std::string order : {"usf", "usl", "musl", "usavg"})
    for (const unsigned int points : {2, 3})
      for (const std::string kernel : {"cpdi", "cpdi2"})
        EXPECT_LT(std::abs(creep_per_cell(kernel, points, order)), 1e-4)
          << kernel << ", " << order << ", " << points;
}



// Gradients are continuous, but points sample what is not smooth.
TEST(Creep, OfDualDomainsIsATenthOfThatOfLinearFunctions)
{
  for (const std::string order : {"musl", "usavg"})
    {
      EXPECT_LT(std::abs(creep_per_cell("ddmp", 2, order)), 0.025) << order;
      EXPECT_LT(std::abs(creep_per_cell("ddmp", 3, order)), 0.01) << order;
    }
}



// Boxes of fixed size leave gaps where the bar is longer: some tenths of a per
// cent, a fiftieth of what linear functions do.
TEST(Creep, OfBoxesIsSmall)
{
  for (const std::string kernel : {"gimp", "cpgimp"})
    {
      EXPECT_LT(std::abs(creep_per_cell(kernel, 2)), 0.01) << kernel;
      EXPECT_LT(std::abs(creep_per_cell(kernel, 3)), 0.005) << kernel;
    }
}



// Their domains fill the former one. Where they did not, the bar grew by 38 and
// 15 %; now by 2 and 4 %.
TEST(Creep, OfDomainsThatAreSplitIsSmall)
{
  EXPECT_LT(std::abs(growth_of_split_points("cpdi")), 0.05);
  EXPECT_LT(std::abs(growth_of_split_points("gimp")), 0.08);
}
