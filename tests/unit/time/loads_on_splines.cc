// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>

/**
 * @file Loads on faces of bodies with splines whose points cross cells: nodes
 * beyond the face that hardly any mass reaches get the stress of the point next
 * to them, and have to get no more of the load than that.
 */

using namespace limber;

namespace
{
  std::string
  pulled_bar(const std::string &kernel,
             const std::string &left,
             const std::string &right,
             const std::string &rest_of_body,
             const std::string &traction,
             const std::string &rest)
  {
    return R"(
    set Bodies = bar
    subsection Body bar
      set Placement = fitted
      set Frame = current
      subsection Box
        set Lower corner = )" +
           left + R"(, 0.3
        set Upper corner = )" +
           right + ", 0.55\nend\n" + rest_of_body + R"(
    end
    subsection Grid
      set Upper corner = 2.85, 0.85
      set Cells = 57, 17
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end
    subsection Loads
      set Face loads = pull, hold
      subsection Face load pull
        set Body = bar
        set Face = right
        set Traction = )" +
           traction + R"(; 0
      end
      subsection Face load hold
        set Body = bar
        set Face = left
        set Traction = -()" +
           traction + R"(); 0
      end
    end
    subsection Method
      set Kernel = )" +
           kernel + "\n" + rest + "\nend\n";
  }
} // namespace



// The outermost points have just entered cells: their own stress is all that
// the nodes beyond them feel.
TEST(LoadsOnSplines, ATractionHoldsTheStressThatItBrings)
{
  for (const std::string kernel : {"quadratic", "cubic"})
    {
      SceneRun<2> run(pulled_bar(kernel,
                                 "0.292",
                                 "1.308",
                                 R"(set Initial stress = xx: 10
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1000
        set Poisson's ratio = 0
      end)",
                                 "10",
                                 ""));
      run.advance_to(0.01);
      double fastest = 0;
      for (std::size_t p = 0; p < run.points().size; ++p)
        fastest = std::max(fastest, run.velocity(p).norm());
      const double speed_of_wave = 10 / std::sqrt(1000.);
      EXPECT_LT(fastest, 0.02 * speed_of_wave) << kernel;
    }
}



// A nominal stress of 0.3 E, which comes on in half a second: 0.355 m of
// elongation between two places (cpdi). The blend removes the waves that grow
// in splines under such a stress; without the balance at the ends these tear
// off all the same.
TEST(LoadsOnSplines, TheEndsOfAMovingBarUnderTensionStayOnIt)
{
  SceneRun<2>       run(pulled_bar("quadratic",
                             "0.3",
                             "1.3",
                             R"(set Initial velocity = 0.5; 0
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1
        set Young's modulus = 1000
        set Poisson's ratio = 0.3
      end)",
                             "300*if(t < 0.5, 8*t^3*(10 - 30*t + 24*t^2), 1)",
                             "set Blend time = 0.02"));
  const auto        start = run.positions();
  const std::size_t n     = start.size();
  const auto        at    = [&](const double x) {
    const dealii::Point<2> place(x, 0.425);
    const auto             nearest =
      std::min_element(start.begin(),
                       start.end(),
                       [&](const auto &a, const auto &b) {
                         return a.distance(place) < b.distance(place);
                       });
    return static_cast<std::size_t>(nearest - start.begin());
  };
  const std::size_t left = at(0.35), right = at(1.25);
  run.advance_to(2);
  ASSERT_EQ(run.points().size, n) << "points are lost";
  const auto   end = run.positions();
  const double elongation =
    end[right][0] - end[left][0] - (start[right][0] - start[left][0]);
  EXPECT_NEAR(elongation, 0.355, 0.03);
}
