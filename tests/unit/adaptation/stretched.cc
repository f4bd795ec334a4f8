// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/adaptation/stretched_points.h>

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
      set Upper corner = 20, 1)" +
           (deep ? ", 1" : "") + R"(
      set Cells = 20, 1)" +
           (deep ? ", 1" : "") + R"(
    end
    subsection Boundaries
      set right = free)" +
           sides + "\nend\n";
  }



  /** Of all points, by J, which is the stretch of a strip that keeps its width.
   */
  template <int dim>
  std::pair<double, double>
  stretches(SceneRun<dim> &run)
  {
    std::vector<double> J(run.points().size);
    run.bodies[0]->stress->volume_ratio(run.points(), J.data());
    return {*std::min_element(J.begin(), J.end()),
            *std::max_element(J.begin(), J.end())};
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



  template <int dim>
  void
  expect_whole(const std::string              &kernel,
               const double                    end,
               const unsigned int              n_points,
               const std::vector<std::string> &more = {})
  {
    SCOPED_TRACE(kernel + ", " + std::to_string(dim));
    std::vector<std::string> set = {"Method/Kernel=" + kernel};
    set.insert(set.end(), more.begin(), more.end());
    SceneRun<dim>   run(strip<dim>(), set);
    Adaptation<dim> adaptation(run.problem, run.grid, run.bodies);
    const auto      before  = run.totals().all;
    const auto      n_start = run.bodies[0]->points.size();
    fly_apart(run, &adaptation, end);
    const auto [smallest, largest] = stretches(run);
    EXPECT_NEAR(smallest, 1 + end, 1e-3 * (1 + end));
    EXPECT_NEAR(largest, 1 + end, 1e-3 * (1 + end));
    const auto after = run.totals().all;
    EXPECT_NEAR(after.mass, before.mass, 1e-12 * before.mass);
    EXPECT_NEAR(after.kinetic_energy,
                before.kinetic_energy,
                1e-5 * before.kinetic_energy);
    EXPECT_EQ(run.bodies[0]->points.size(), n_points);
    EXPECT_EQ(n_start + adaptation.state().points_added, n_points);
    const auto                   &ids = run.bodies[0]->points.all_ids();
    const std::set<std::uint64_t> different(ids.begin(), ids.end());
    EXPECT_EQ(different.size(), ids.size());
    EXPECT_EQ(*different.rbegin(), ids.size() - 1);
  }
} // namespace



// Two points per cell stand a cell apart at twice the length.
TEST(StretchedPoints, ComeApartWhereTheyAreNotHalved)
{
  SceneRun<2> run(strip<2>());
  fly_apart<2>(run, nullptr, 4);
  EXPECT_LT(stretches(run).first, 3.6);
}



// Half a cell becomes longer than 2/3 of it at the stretches 4/3 and 8/3: at 5
// there are four for each.
TEST(StretchedPoints, HoldTogetherWhereTheyAreHalved)
{
  expect_whole<2>("linear", 4, 8 * 4);
  expect_whole<3>("linear", 4, 16 * 4);
  expect_whole<2>("cpgimp", 4, 8 * 4);
  expect_whole<2>("cpdi", 4, 8 * 4);
  expect_whole<2>("linear", 4, 8 * 4, {"Body strip/Locking treatment=cell"});
}



namespace
{
  // Nodal masses and momenta of a block of stretched points.
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



  template <int dim>
  void
  expect_no_change_by_halves(const std::string &kernel)
  {
    SCOPED_TRACE(kernel + ", " + std::to_string(dim));
    const std::vector<std::string> set = {"Method/Kernel=" + kernel,
                                          "Method/Stress update=usl"};
    SceneRun<dim>                  run(strip<dim>(), set);
    fly_apart<dim>(run, nullptr, 0.5);
    const auto which = stretched_points<dim>(run.grid, *run.bodies[0], {});
    ASSERT_EQ(which.size(), run.points().size);
    for (const auto &division : which)
      {
        EXPECT_EQ(division.direction, 0u);
        EXPECT_NEAR(division.half_edge[0], 0.25 * 1.5, 1e-6);
        EXPECT_NEAR(division.half_edge.norm(), division.half_edge[0], 1e-12);
      }
    const auto before = nodal_records(run);
    const auto n      = run.points().size;
    run.bodies[0]->points.divide(which, n);
    EXPECT_TRUE(stretched_points<dim>(run.grid, *run.bodies[0], {}).empty());
    const auto   after = nodal_records(run);
    const double scale = *std::max_element(before.begin(), before.end());
    ASSERT_EQ(after.size(), before.size());
    // two steps of 1e-9 s apart
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(after[i], before[i], 1e-8 * scale);
  }
} // namespace



TEST(StretchedPoints, ChangeNothingThatTheGridSees)
{
  for (const std::string kernel : {"linear", "cpgimp"})
    {
      expect_no_change_by_halves<2>(kernel);
      expect_no_change_by_halves<3>(kernel);
    }
}



// A strip at 45 degrees that is drawn along itself: halves lie along it.
TEST(StretchedPoints, AreHalvedAlongTheirStretch)
{
  const std::string text = R"(
    set Bodies = strip
    subsection Body strip
      set Shape = block
      subsection Block
        set Corners = 2, 1; 5, 4; 4, 5; 1, 2
      end
      set Initial velocity = (x + y - 4)/2; (x + y - 4)/2
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
      set Upper corner = 12, 12
      set Cells = 12, 12
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end)";
  SceneRun<2>       run(text);
  const auto        n_start = run.points().size;
  fly_apart<2>(run, nullptr, 1.2);
  auto which = stretched_points<2>(run.grid, *run.bodies[0], {});
  ASSERT_GT(which.size(), n_start / 2);
  std::size_t along = 0;
  for (const auto &division : which)
    along += division.half_edge[0] > 0 && division.half_edge[1] > 0 &&
             std::abs(division.half_edge[0] - division.half_edge[1]) <
               0.25 * division.half_edge[0];
  EXPECT_GT(along, 9 * which.size() / 10);
  run.bodies[0]->points.divide(which, n_start);
  EXPECT_LT(stretched_points<2>(run.grid, *run.bodies[0], {}).size(),
            which.size() / 10);
}
