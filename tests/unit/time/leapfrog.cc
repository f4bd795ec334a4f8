// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

/**
 * @file Steps in the initial frame leave strain and stress behind until
 * somebody looks (Integrator::synchronise). Looking must not change what
 * follows, and with `usavg` the steps are of second order.
 */

using namespace limber;

namespace
{
  // Held on the left, thrown about; on cells of 1 m
  const std::string thrown_block = R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Upper corner = 3, 2
      end
      set Points per cell edge = 2
      set Initial velocity = 0.1*x*y; -0.2*x + 0.05*x*x
)" + rubber("1", "0.3") + R"(
      set Frame = initial
    end
    subsection Grid
      set Upper corner = 6, 4
      set Cells = 6, 4
    end
    subsection Boundaries
      set left = no slip
      set right = free
      set bottom = free
      set top = free
    end)";



  std::vector<std::string>
  settings(const std::string &kernel, const std::string &order)
  {
    return {"Method/Kernel=" + kernel,
            "Method/Stress update=" + order,
            "Body block/Locking treatment=cell"};
  }



  double
  distance(const std::vector<dealii::Point<2>> &a,
           const std::vector<dealii::Point<2>> &b)
  {
    double result = 0;
    for (std::size_t p = 0; p < a.size(); ++p)
      result = std::max(result, (a[p] - b[p]).norm());
    return result;
  }
} // namespace



TEST(Leapfrog, LookingChangesNothing)
{
  for (const std::string kernel : {"linear", "quadratic", "cubic"})
    for (const std::string order : {"usl", "musl", "usavg"})
      {
        SCOPED_TRACE(kernel + ", " + order);
        SceneRun<2>        looked_at(thrown_block, settings(kernel, order));
        SceneRun<2>        left_alone(thrown_block, settings(kernel, order));
        const unsigned int n = 60;
        for (unsigned int k = 0; k < n; ++k)
          looked_at.advance(0.05);
        left_alone.advance(0.05, n);
        EXPECT_LT(distance(looked_at.positions(), left_alone.positions()),
                  1e-12);
        const auto a = looked_at.points(), b = left_alone.points();
        for (std::size_t p = 0; p < a.size; ++p)
          ASSERT_NEAR(a.pressure[p], b.pressure[p], 1e-12);
        const auto E = looked_at.totals().all, F = left_alone.totals().all;
        EXPECT_NEAR(E.kinetic_energy, F.kinetic_energy, 1e-12);
        EXPECT_NEAR(E.strain_energy, F.strain_energy, 1e-12);
      }
}



// Contact constrains the velocity that is kept from one step to the next.
TEST(Leapfrog, LookingAtAnImpactChangesNothing)
{
  for (const std::string order : {"musl", "usavg"})
    {
      SCOPED_TRACE(order);
      auto variant = settings("linear", order);
      variant.insert(variant.end(),
                     {"Boundaries/left=separating",
                      "Body block/Box/Lower corner=0.1, 0",
                      "Body block/Initial velocity=-0.2; 0.03*x"});
      SceneRun<2> looked_at(thrown_block, variant);
      SceneRun<2> left_alone(thrown_block, variant);
      ASSERT_TRUE(looked_at.problem.sides[0].meets_surfaces);
      constexpr unsigned int n = 120;
      for (unsigned int k = 0; k < n; ++k)
        looked_at.advance(0.05);
      left_alone.advance(0.05, n);
      EXPECT_LT(distance(looked_at.positions(), left_alone.positions()), 1e-12);
      const auto E = looked_at.totals(), F = left_alone.totals();
      EXPECT_GT(E.side_impulse[0][0], 0.1);
      EXPECT_NEAR(E.all.kinetic_energy, F.all.kinetic_energy, 1e-12);
      EXPECT_NEAR(E.all.strain_energy, F.all.strain_energy, 1e-12);
      EXPECT_NEAR(E.contact_loss, F.contact_loss, 1e-12);
      EXPECT_NEAR(E.energy_drift, F.energy_drift, 1e-12);
      EXPECT_LT(std::abs(E.energy_drift), 0.02);
    }
}



TEST(Leapfrog, BothEndsAreOfSecondOrderInTime)
{
  for (const std::string kernel : {"linear", "quadratic", "cubic"})
    {
      SCOPED_TRACE(kernel);
      std::vector<std::vector<dealii::Point<2>>> ends;
      for (const unsigned int n : {50u, 100u, 200u})
        {
          SceneRun<2> run(thrown_block, settings(kernel, "usavg"));
          run.advance(5. / n, n);
          ends.push_back(run.positions());
        }
      EXPECT_NEAR(distance(ends[0], ends[1]) / distance(ends[1], ends[2]),
                  4,
                  0.3);
    }
}
