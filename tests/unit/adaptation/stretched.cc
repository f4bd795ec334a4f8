// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/adaptation/stretched_points.h>
#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <algorithm>
#include <set>

/**
 * @file Points that become two where they are stretched: what must stay to the
 * last digits, and that a solid no longer comes apart on the grid.
 */

using namespace limber;

namespace
{
  /**
   * A strip without Poisson's effect, so soft that it flies apart freely: every
   * point is stretched by 1 + t along x.
   */
  template <int dim>
  std::string
  strip()
  {
    const bool        deep  = dim == 3;
    const std::string sides = deep ? "\n set front = slip" : "";
    return "set Dimension = " + std::to_string(dim) + R"(
    set Bodies = strip
    subsection Body strip
      subsection Box
        set Upper corner = 2, 1)" +
           (deep ? ", 1" : "") + R"(
      end
      set Initial velocity = x; 0)" +
           (deep ? "; 0" : "") + R"(
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e-3
        set Poisson's ratio = 0
      end
      set Split stretched points = true
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 40, 1)" +
           (deep ? ", 1" : "") + R"(
      set Cells = 40, 1)" +
           (deep ? ", 1" : "") + R"(
    end
    subsection Boundaries
      set right = free)" +
           sides + "\nend\n";
  }



  /** The smallest and the largest J, which is the stretch, of the points that
   * are not near the ends of the strip. */
  template <int dim>
  std::pair<double, double>
  stretches(SceneRun<dim> &run)
  {
    std::vector<double> J(run.points().size);
    run.bodies[0]->stress->volume_ratio(run.points(), J.data());
    double left = 1e300, right = 0;
    for (std::size_t p = 0; p < J.size(); ++p)
      {
        left  = std::min(left, run.position(p)[0]);
        right = std::max(right, run.position(p)[0]);
      }
    std::pair<double, double> result(1e300, 0);
    for (std::size_t p = 0; p < J.size(); ++p)
      if (const double place = (run.position(p)[0] - left) / (right - left);
          place > 0.2 && place < 0.8)
        {
          result.first  = std::min(result.first, J[p]);
          result.second = std::max(result.second, J[p]);
        }
    return result;
  }



  template <int dim>
  void
  fly_apart(SceneRun<dim> &run, Adaptation<dim> *adaptation, const double end)
  {
    const typename Adaptation<dim>::KeptPoints kept(1);
    run.advance_to(end, [&]() {
      if (adaptation != nullptr &&
          adaptation->is_due(run.integrator.largest_displacement()) &&
          adaptation->adapt(run.time, kept))
        run.integrator.reinit();
    });
  }



  /** A strip that flies apart is stretched everywhere, at most so much more
   * than on average: points cross cells in every other step. */
  template <int dim>
  void
  expect_whole(const std::string              &kernel,
               const double                    scatter,
               const std::vector<std::string> &more = {})
  {
    SCOPED_TRACE(kernel + ", " + std::to_string(dim));
    std::vector<std::string> set = {"Method/Kernel=" + kernel};
    set.insert(set.end(), more.begin(), more.end());
    SceneRun<dim>    run(strip<dim>(), set);
    Adaptation<dim>  adaptation(run.problem, run.grid, run.bodies);
    const auto       before  = run.totals().all;
    const auto       n_start = run.bodies[0]->points.size();
    constexpr double end     = 8;
    fly_apart(run, &adaptation, end);
    const auto [smallest, largest] = stretches(run);
    EXPECT_GT(smallest, 0.85 * (1 + end));
    EXPECT_LT(largest, (1 + scatter) * (1 + end));
    const auto after = run.totals().all;
    EXPECT_NEAR(after.mass, before.mass, 1e-12 * before.mass);
    const auto n = run.bodies[0]->points.size();
    EXPECT_GE(n, 6 * n_start);
    EXPECT_LE(n, 18 * n_start);
    EXPECT_EQ(n_start + adaptation.state().points_added, n);
    const auto                   &ids = run.bodies[0]->points.all_ids();
    const std::set<std::uint64_t> different(ids.begin(), ids.end());
    EXPECT_EQ(different.size(), n);
    EXPECT_EQ(*different.rbegin(), n - 1);
  }
} // namespace



// Two points per cell stand a cell apart at twice the length; once they share
// no node, they are stretched no further.
TEST(StretchedPoints, ComeApartWhereTheyAreNotDivided)
{
  SceneRun<2> run(strip<2>());
  fly_apart<2>(run, nullptr, 8);
  EXPECT_LT(stretches(run).first, 4);
}



// Half a cell becomes longer than 2/3 of it at the stretches 4/3, 8/3 and 16/3,
// so that there are eight points for each at 9, and sixteen where the velocity
// scatters.
TEST(StretchedPoints, HoldTogetherWhereTheyAreDivided)
{
  expect_whole<2>("linear", 0.6);
  expect_whole<3>("linear", 0.6);
  expect_whole<2>("quadratic", 0.25);
  expect_whole<2>("cpgimp", 0.45);
  expect_whole<2>("cpdi", 0.45);
  expect_whole<2>("linear", 0.6, {"Body strip/Locking treatment=cell"});
}



namespace
{
  const std::vector<std::string> one_point_per_cell =
    {"Body strip/Points per cell edge=1", "Method/Stress update=usl"};



  // Masses, forces and momenta.
  template <int dim>
  std::vector<double>
  nodal_records(SceneRun<dim> &run)
  {
    run.integrator.reinit();
    run.advance(1e-9);
    std::vector<double> result;
    for (std::uint32_t node = 0; node < run.nodes.table.n(); ++node)
      {
        const double *const record = run.nodes.record(node);
        result.insert(result.end(), record, record + 1 + 2 * dim);
      }
    return result;
  }



  // One point in each cell, which is longer than 2/3 of it from the start.
  template <int dim>
  void
  expect_no_change_by_division(const std::string &kernel)
  {
    SCOPED_TRACE(kernel + ", " + std::to_string(dim));
    std::vector<std::string> set = one_point_per_cell;
    set.insert(set.end(),
               {"Method/Kernel=" + kernel,
                dim == 2 ? "Body strip/Initial velocity=1; 0" :
                           "Body strip/Initial velocity=1; 0; 0"});
    SceneRun<dim> whole(strip<dim>(), set), parts(strip<dim>(), set);
    for (auto *const run : {&whole, &parts})
      for (std::size_t p = 0; p < run->points().size; ++p)
        run->points().pressure[p] = 1 + p;
    const auto which = stretched_points<dim>(parts.grid, *parts.bodies[0], {});
    ASSERT_EQ(which.size(), parts.points().size);
    for (const auto &division : which)
      {
        EXPECT_EQ(division.direction, 0u);
        EXPECT_NEAR(division.half_edge[0], 0.5, 1e-12);
        EXPECT_NEAR(division.half_edge.norm(), 0.5, 1e-12);
        EXPECT_NEAR(division.rate, 0, 1e-12);
      }
    const double more = parts.bodies[0]->points.divide(which, which.size());
    EXPECT_EQ(more, 0);
    EXPECT_EQ(parts.points().size, 2 * which.size());
    const auto   before = nodal_records(whole), after = nodal_records(parts);
    const double scale = *std::max_element(before.begin(), before.end());
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(after[i], before[i], 1e-13 * scale);
  }
} // namespace



TEST(StretchedPoints, ChangeNothingThatTheGridSeesWithinTheirCells)
{
  for (const std::string kernel : {"linear", "cpgimp"})
    {
      expect_no_change_by_division<2>(kernel);
      expect_no_change_by_division<3>(kernel);
    }
}



// Momentum and its moment stay; parts have the velocities of the places where
// they are, and so more kinetic energy than the point showed, which is told.
TEST(StretchedPoints, PartAsTheMaterialDoes)
{
  for (const unsigned int parts : {2, 3})
    {
      std::vector<std::string> set = one_point_per_cell;
      set.emplace_back("Body strip/Initial velocity=x - 0.3*y; 0.2*x");
      SceneRun<2> run(strip<2>(), set);
      const auto  sums = [&run]() {
        std::array<double, 4> result{}; // momentum, its moment, energy
        for (std::size_t p = 0; p < run.points().size; ++p)
          {
            const double m = run.points().mass[p];
            const auto   x = run.position(p);
            const auto   v = run.velocity(p);
            result[0] += m * v[0];
            result[1] += m * v[1];
            result[2] += m * (x[0] * v[1] - x[1] * v[0]);
            result[3] += 0.5 * m * v.norm_square();
          }
        return result;
      };
      const auto before = sums();
      auto       which  = stretched_points<2>(run.grid, *run.bodies[0], {});
      ASSERT_EQ(which.size(), 2u);
      for (auto &division : which)
        {
          division.parts = parts;
          // All points are in one row, so that nothing is known of it.
          EXPECT_EQ(division.rate, 0);
          division.rate = 1;
        }
      const double more  = run.bodies[0]->points.divide(which, 2);
      const auto   after = sums();
      for (unsigned int k = 0; k < 3; ++k)
        EXPECT_NEAR(after[k], before[k], 1e-12 * std::abs(before[3]));
      // 2000 kg in parts 1/4 or 0 and 1/3 m from the middle
      EXPECT_NEAR(more, parts == 2 ? 62.5 : 2000. / 27, 1e-9);
      EXPECT_NEAR(after[3], before[3] + more, 1e-12 * after[3]);
    }
}



// Those of a linear field, from the points around, whose rows are at 1/4 and
// 3/4 of each cell.
TEST(StretchedPoints, SeeALinearFieldAroundThem)
{
  SceneRun<2> run(strip<2>(), {"Body strip/Points per cell edge=1, 2"});
  const auto  which = stretched_points<2>(run.grid, *run.bodies[0], {});
  ASSERT_EQ(which.size(), 4u);
  for (const auto &division : which)
    EXPECT_NEAR(division.rate, 1, 1e-12);
}



// A strip at 45 degrees that is drawn along itself.
TEST(StretchedPoints, HoldTogetherAcrossTheGrid)
{
  const std::string text = R"(
    set Bodies = strip
    subsection Body strip
      set Shape = block
      subsection Block
        set Corners = 2, 1; 5, 4; 4, 5; 1, 2
      end
      set Initial velocity = (x + y - 6)/2; (x + y - 6)/2
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e-3
        set Poisson's ratio = 0
      end
      set Placement = regular
      set Split stretched points = true
      set Locking treatment = none
    end
    subsection Grid
      set Lower corner = -24, -24
      set Upper corner = 36, 36
      set Cells = 60, 60
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end)";
  SceneRun<2>       whole(text), parts(text);
  Adaptation<2>     adaptation(parts.problem, parts.grid, parts.bodies);
  fly_apart<2>(whole, nullptr, 8);
  fly_apart<2>(parts, &adaptation, 8);
  EXPECT_LT(stretches(whole).first, 4.5);
  EXPECT_GT(stretches(parts).first, 8);
}



TEST(StretchedPoints, AreRefusedInTheInitialFrame)
{
  try
    {
      SceneRun<2> run(strip<2>(), {"Body strip/Frame=initial"});
      FAIL() << "The scene was accepted.";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("nothing comes apart"),
                std::string::npos)
        << error.what();
    }
}
