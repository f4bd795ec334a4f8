// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/time_scale.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/** @file How fast the formulas of a scene change. */

using namespace limber;

namespace
{
  double
  scale_of(const std::vector<std::string> &changes)
  {
    return time_scale_of_formulas(
      read_problem<2>(SceneFile(ParameterText{R"(
        set Bodies = block
        subsection Body block
          set Points per cell edge = 2
        end)",
                                              FileFormat::prm,
                                              "scene"},
                                changes)));
  }
} // namespace



// Whatever drives, and however many periods the run has.
TEST(TimeScale, IsOneOverTheFrequency)
{
  for (const std::string end : {"1", "10", "1000"})
    for (const auto &changes : std::vector<std::vector<std::string>>{
           {"Loads/Body force=3*sin(20*t); 0"},
           {"Loads/Body force=0; 3 + x*sin(20*t)"},
           {"Boundaries/left=velocity",
            "Boundaries/Side left/Velocity=0.01*sin(20*t); 0"},
           {"Obstacles=rod",
            "Obstacle rod/Shape=half-space",
            "Obstacle rod/Half-space/Point=0, -2",
            "Obstacle rod/Half-space/Normal=0, 1",
            "Obstacle rod/Displacement=0; 0.1*sin(20*t)"}})
      {
        auto with_end = changes;
        with_end.push_back("End time=" + end);
        SCOPED_TRACE(changes.back() + ", " + end);
        // one period is 0.3 s
        EXPECT_NEAR(scale_of(with_end), 0.05, 0.002);
      }
}



TEST(TimeScale, IsThatOfJumpsAndRampsToo)
{
  EXPECT_EQ(scale_of({}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(scale_of({"Loads/Body force=3*x; 1"}),
            std::numeric_limits<double>::infinity());
  // a ramp over the whole run: 1 / sqrt(12) of it
  EXPECT_NEAR(scale_of({"End time=2", "Loads/Body force=3*t; 0"}),
              2 / std::sqrt(12.),
              0.01);
  // a jump: the mean of what lies between two samples and the run
  const double of_jump =
    scale_of({"End time=2", "Loads/Body force=if(t < 1, 0, 1); 0"});
  EXPECT_NEAR(of_jump, 0.05, 0.03);
}
