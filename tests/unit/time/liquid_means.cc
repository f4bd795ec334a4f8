// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <map>

/** @file Liquids that share cells, in whole steps. */

using namespace limber;

namespace
{
  struct Liquid
  {
    std::string name, lower, upper;
    double      density = 1000, bulk_modulus = 1e6;
  };



  /** Liquids in a basin of cells of 1/8 m, three points along an edge. */
  std::string
  basin(const int dim, const std::vector<Liquid> &liquids)
  {
    std::string names, text;
    for (const Liquid &liquid : liquids)
      {
        const bool in_3d = dim == 3;
        names += (names.empty() ? "" : ", ") + liquid.name;
        text += "subsection Body " + liquid.name +
                "\n set Shape = box\n subsection Box\n set Lower corner = " +
                liquid.lower + (in_3d ? ", 0" : "") +
                "\n set Upper corner = " + liquid.upper +
                (in_3d ? ", 0.25" : "") +
                "\n end\n set Points per cell edge = 3\n"
                " set Initial velocity = 0.3*sin(7*x+3*y); 0.2*cos(5*x)*y" +
                (in_3d ? "; 0" : "") +
                "\n set Checkerboard control = 0\n"
                " set Material = newtonian fluid\n"
                " subsection Newtonian fluid\n set Density = " +
                digits(liquid.density) +
                "\n set Bulk modulus = " + digits(liquid.bulk_modulus) +
                "\n end\nend\n";
      }
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = " + names + "\n" + text +
           "subsection Grid\n set Upper corner = 1, 1" +
           (dim == 3 ? ", 0.25\n set Cells = 8, 8, 2" : "\n set Cells = 8, 8") +
           "\nend\nsubsection Loads\n set Gravity = 0, -9.81" +
           (dim == 3 ? ", 0" : "") + "\nend\n";
  }



  /** All places, in an order that does not depend on bodies. */
  template <int dim>
  std::vector<dealii::Point<dim>>
  places_after(SceneRun<dim> &run, const double end)
  {
    // by where they were at first
    std::vector<std::pair<dealii::Point<dim>, dealii::Point<dim>>> ways;
    std::vector<std::vector<dealii::Point<dim>>>                   first;
    for (unsigned int b = 0; b < run.bodies.size(); ++b)
      first.push_back(run.positions(b));
    run.advance_to(end);
    for (unsigned int b = 0; b < run.bodies.size(); ++b)
      {
        const auto last = run.positions(b);
        for (std::size_t p = 0; p < last.size(); ++p)
          ways.emplace_back(first[b][p], last[p]);
      }
    const auto key = [](const dealii::Point<dim> &x) {
      std::array<long, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = std::lround(x[d] * 1e6);
      return result;
    };
    std::sort(ways.begin(), ways.end(), [&](const auto &a, const auto &b) {
      return key(a.first) < key(b.first);
    });
    std::vector<dealii::Point<dim>> result;
    for (const auto &way : ways)
      result.push_back(way.second);
    return result;
  }



  // The line between them, 11/24 m, is within cells.
  template <int dim>
  void
  expect_one_liquid(const std::string &integration)
  {
    const std::vector<std::string> steps = {"Method/Time integration=" +
                                            integration};
    // In explicit steps density control is for one body in a field of nodes.
    std::vector<std::string> alone = steps;
    if (integration == "explicit")
      alone.push_back("Body water/Density control=0");
    // The density control takes the volume of one liquid from the density in
    // one cell, which is that around to 1/K.
    const double  K = integration == "explicit" ? 1e6 : 2e9;
    SceneRun<dim> whole(basin(dim, {{"water", "0, 0", "0.75, 0.5", 1000, K}}),
                        alone);
    SceneRun<dim> halves(
      basin(dim,
            {{"left", "0, 0", "0.45833333333333331, 0.5", 1000, K},
             {"right", "0.45833333333333331, 0", "0.75, 0.5", 1000, K}}),
      steps);
    const double end      = 0.1;
    const auto   expected = places_after(whole, end);
    const auto   found    = places_after(halves, end);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t p = 0; p < found.size(); ++p)
      {
        ASSERT_LT(found[p].distance(expected[p]), 1e-9) << expected[p];
      }
    EXPECT_EQ(whole.n_done, halves.n_done);
  }



  /** Of the volume ratios in cells that both are in, by body. */
  std::map<std::uint32_t, std::array<double, 2>>
  mean_pressures(SceneRun<2> &run)
  {
    std::map<std::uint32_t, std::array<std::array<double, 2>, 2>> sums;
    for (unsigned int b = 0; b < 2; ++b)
      {
        const PointView<2> points = run.points(b);
        for (std::size_t p = 0; p < points.size; ++p)
          {
            auto &of_body = sums[points.cell[p]][b];
            of_body[0] += points.mass[p];
            of_body[1] += points.mass[p] * points.pressure[p];
          }
      }
    std::map<std::uint32_t, std::array<double, 2>> result;
    for (const auto &[cell, of_bodies] : sums)
      if (of_bodies[0][0] > 0 && of_bodies[1][0] > 0)
        result[cell] = {{of_bodies[0][1] / of_bodies[0][0],
                         of_bodies[1][1] / of_bodies[1][0]}};
    return result;
  }
} // namespace



TEST(LiquidMeans, PartsOfALiquidMoveAsOne)
{
  for (const std::string integration : {"explicit", "semi-implicit"})
    {
      SCOPED_TRACE(integration);
      expect_one_liquid<2>(integration);
      expect_one_liquid<3>(integration);
    }
}



// Without pressure at first, and in so short a step that nothing of second
// order is seen, all they have is what their share of the divergence has made.
TEST(LiquidMeans, PressuresOfUnlikeLiquidsGrowAlike)
{
  const std::vector<Liquid> liquids = {
    {"heavy", "0, 0", "0.45833333333333331, 0.5", 3000, 2e7},
    {"light", "0.45833333333333331, 0", "0.75, 0.5", 1000, 1e6}};
  SceneRun<2> run(basin(2, liquids));
  run.advance(1e-7);
  const auto pressures = mean_pressures(run);
  ASSERT_GE(pressures.size(), 4u);
  double largest = 0;
  for (const auto &[cell, of_bodies] : pressures)
    largest = std::max(largest, std::abs(of_bodies[0]));
  ASSERT_GT(largest, 0.01);
  for (const auto &[cell, of_bodies] : pressures)
    EXPECT_NEAR(of_bodies[0], of_bodies[1], 1e-5 * largest);

  SceneRun<2> implicit(basin(2, liquids),
                       {"Method/Time integration=semi-implicit"});
  implicit.advance(1e-2);
  for (const auto &[cell, of_bodies] : mean_pressures(implicit))
    EXPECT_NEAR(of_bodies[0], of_bodies[1], 1e-9 * std::abs(of_bodies[0]));
}



// Strain and force are transposes: what unlike liquids take up is what their
// forces do, but for the error of the step, which falls with it.
TEST(LiquidMeans, EnergyOfUnlikeLiquidsIsKept)
{
  const auto drift_with = [](const double step) {
    SceneRun<2> run(
      basin(2,
            {{"heavy", "0, 0", "0.45833333333333331, 0.5", 3000, 2e7},
             {"light", "0.45833333333333331, 0", "0.75, 0.5", 1000, 1e6}}),
      {"Method/Time integration=explicit",
       "Body heavy/Hourglass control=0",
       "Body light/Hourglass control=0"});
    run.advance(step, std::lround(2e-3 / step));
    return std::abs(run.totals().energy_drift);
  };
  const double coarse = drift_with(1e-4), fine = drift_with(2.5e-5);
  EXPECT_LT(fine, 0.35 * coarse); // a quarter to first order
}
