// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/study/report.h>
#include <limber/study/run_result.h>

#include <gtest/gtest.h>

using namespace limber;

namespace
{
  /** Rows of one measure; an error of -1 stands for a variant that failed. */
  StudyReport
  report_of(const std::vector<std::array<double, 3>> &method_cost_error)
  {
    StudyReport report;
    Measure     measure;
    measure.name          = "frequency";
    report.study.measures = {measure};
    report.study.methods  = {{{"locked", {}}, Runner::points, {}},
                             {{"cured", {}}, Runner::points, {}}};
    for (const auto &[method, cost, error] : method_cost_error)
      {
        StudyRow row;
        row.variant.method = std::size_t(method);
        row.variant.name =
          (method == 0 ? "locked, " : "cured, ") + std::to_string(int(cost));
        row.outcome                  = error < 0 ? "not finite" : "finished";
        row.costs[Cost::cpu_seconds] = cost;
        if (error >= 0)
          row.measured = {{0, error}};
        report.rows.push_back(row);
      }
    return report;
  }
} // namespace



TEST(StudyReport, ParetoFront)
{
  const auto report = report_of({{{0, 1, 0.5}},
                                 {{0, 2, 0.5}},    // dearer, not better
                                 {{1, 2, 0.1}},    // better
                                 {{1, 3, 0.2}},    // dearer and worse
                                 {{1, 4, -1}},     // has failed
                                 {{0, 8, 0.01}}}); // dearest and best
  EXPECT_EQ(pareto_front(report, 0),
            (std::vector<bool>{true, false, true, false, false, true}));
}



TEST(StudyReport, ProblemsAreNotComparedWithEachOther)
{
  // Of two bodies the second costs ten times as much.
  auto report =
    report_of({{{0, 1, 0.01}}, {{0, 10, 0.5}}, {{1, 2, 0.02}}, {{1, 20, 0.2}}});
  report.study.variations = {{"body", {{"small", {}}, {"large", {}}}, true}};
  for (std::size_t r = 0; r < report.rows.size(); ++r)
    report.rows[r].variant.choices = {r % 2};
  EXPECT_EQ(pareto_front(report, 0),
            (std::vector<bool>{true, true, false, true}));
  const std::string text = cheapest_variants(report, {0.3});
  EXPECT_NE(text.find("body small, frequency, error 0.3: cheapest is 'locked, "
                      "1' with 0.01"),
            std::string::npos)
    << text;
  EXPECT_NE(text.find("body large, frequency, error 0.3: cheapest is 'cured, "
                      "20' with 0.2"),
            std::string::npos)
    << text;
  EXPECT_NE(text.find("locked: not reached, the smallest error is 0.5"),
            std::string::npos)
    << text;
}



TEST(StudyReport, CheapestForAnError)
{
  const auto report =
    report_of({{{0, 1, 0.5}}, {{0, 40, 0.09}}, {{1, 2, 0.1}}, {{1, 1, -1}}});
  const std::string text = cheapest_variants(report, {0.1, 0.01});
  EXPECT_NE(text.find("error 0.1: cheapest is 'cured, 2' with 0.1, 2 CPU"),
            std::string::npos)
    << text;
  EXPECT_NE(text.find("locked: 20 times as much, with 'locked, 40'"),
            std::string::npos)
    << text;
  EXPECT_NE(text.find("error 0.01: reached by no variant; the smallest error "
                      "is 0.09"),
            std::string::npos)
    << text;
}



// Front of one run, height of another: only the error is the same question.
TEST(StudyMeasure, OfSeveralChecksIsTheWorstErrorAlone)
{
  RecordedSummary summary;
  summary.checks = {{"front", 4.1, 4.}, {"height", 0.5, 1.}};
  Measure measure;
  measure.source    = MeasureSource::check;
  measure.of        = {"front", "height"};
  const auto of_two = take_measure(measure, summary, ".");
  EXPECT_DOUBLE_EQ(of_two.error, 0.5);
  EXPECT_DOUBLE_EQ(of_two.value, 0.5);
  measure.of        = {"front"};
  const auto of_one = take_measure(measure, summary, ".");
  EXPECT_NEAR(of_one.error, 0.025, 1e-12);
  EXPECT_DOUBLE_EQ(of_one.value, 4.1);
}
