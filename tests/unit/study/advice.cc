// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/study/advice_runs.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace limber;

/** @file Which advice two runs bear out, and which they do not. */
namespace
{
  Trial
  trial_of(const double       amplitude,
           const double       cpu,
           const std::string &outcome = "finished")
  {
    Trial trial;
    trial.outcome = outcome;
    trial.cpu     = cpu;
    for (unsigned int i = 0; i <= 100; ++i)
      {
        const double time = 0.01 * i;
        trial.table["time"].push_back(time);
        trial.table["tip"].push_back(5 + amplitude * std::sin(6 * time));
        trial.table["largest velocity"].push_back(0.5);
      }
    trial.until  = 1;
    trial.checks = {{"end", amplitude, 1}};
    return trial;
  }



  Problem<2>
  watched_problem()
  {
    Problem<2>    problem;
    Observable<2> tip;
    tip.name = "tip";
    tip.kind = &observable_kind<2>("displacement");
    problem.observables.push_back(tip);
    problem.checks.push_back({"end", "tip", {}, 1, 0.05});
    return problem;
  }



  Judgement
  judge(const Advice &advice, const Trial &changed, const double way)
  {
    const Effect effect =
      compare_trials(watched_problem(), trial_of(1, 2), changed);
    return judge_advice(advice, changed, effect, 0.01, way).judgement;
  }
} // namespace



TEST(Advice, ChangesAreHeldAgainstTheMotionAndNotAgainstThePlace)
{
  const Effect effect =
    compare_trials(watched_problem(), trial_of(1, 2), trial_of(1.02, 1));
  EXPECT_NEAR(effect.change, 0.02, 1e-12);
  EXPECT_NEAR(effect.factor, 2, 1e-12);
  EXPECT_TRUE(effect.is_whole);
  EXPECT_EQ(effect.missed_check, "");
}



TEST(Advice, SmallChangesThatSaveTimeAreAdvised)
{
  EXPECT_EQ(judge({}, trial_of(1.002, 1), 0), Judgement::advised);
  EXPECT_EQ(judge({}, trial_of(1.02, 1), 0), Judgement::trade);
  EXPECT_EQ(judge({}, trial_of(std::nan(""), 1), 0), Judgement::refused);
}



TEST(Advice, WhatFailsOrSavesNothingIsRefused)
{
  EXPECT_EQ(judge({}, trial_of(1, 1, "growing energy"), 0), Judgement::refused);
  EXPECT_EQ(judge({}, trial_of(1, 2), 0), Judgement::refused);
  EXPECT_EQ(judge({}, trial_of(1.2, 1), 0), Judgement::refused); // the check
}



TEST(Advice, WhatIsNotKnownToTheEndIsATrade)
{
  Advice exact;
  exact.is_exact = true;
  EXPECT_EQ(judge({}, trial_of(1, 1, "time limit"), 0), Judgement::trade);
  EXPECT_EQ(judge(exact, trial_of(1, 1, "time limit"), 0), Judgement::advised);
}



TEST(Advice, PointsThatPassCellsForbidFewer)
{
  Advice fewer;
  fewer.longest_way = 0.25;
  const double way  = longest_way(trial_of(1, 1).table, 1);
  EXPECT_NEAR(way, 0.5, 1e-12);
  EXPECT_EQ(judge(fewer, trial_of(1, 1), way), Judgement::trade);
  EXPECT_EQ(judge(fewer, trial_of(1, 1), 0.2), Judgement::advised);
}
