// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/output/files.h>
#include <limber/simulation/signals.h>
#include <limber/study/study.h>
#include <limber/study/study_runs.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace limber
{
  namespace
  {
    /** Costs and measures of a run, from its folder. */
    StudyRow
    row_from(const StudyFile &study,
             const Variant   &variant,
             const ChildEnd  &end)
    {
      StudyRow row{
        variant, outcome_of(end, variant.folder), "", end.exit_code, {}, {}};
      if (!std::filesystem::exists(variant.folder + "/summary.json"))
        return row;
      const RecordedSummary summary = read_summary(variant.folder);
      const auto            number  = [&](const char *const name) {
        const auto found = summary.numbers.find(name);
        return found == summary.numbers.end() ? std::nan("") : found->second;
      };
      row.costs = {{Cost::cpu_seconds, number("cpu_seconds")},
                   {Cost::wall_seconds, number("wall_seconds")},
                   {Cost::memory, number("memory_bytes")},
                   {Cost::steps, number("steps")}};
      if (row.outcome == "finished")
        for (const Measure &measure : study.measures)
          row.measured.push_back(
            take_measure(measure, summary, variant.folder));
      return row;
    }



    std::string
    describe(const StudyFile &study, const StudyRow &row)
    {
      std::ostringstream text;
      text.precision(3);
      text << row.outcome;
      for (std::size_t m = 0; m < row.measured.size(); ++m)
        {
          const Measure &measure = study.measures[m];
          text << ", " << measure.name << " " << row.measured[m].value;
          if (measure.has_error())
            text << " (error " << row.measured[m].error << ")";
        }
      const auto cost = row.costs.find(study.cost);
      if (cost != row.costs.end())
        text << ", " << cost->second << " " << name_of(study.cost);
      return text.str();
    }
  } // namespace



  int
  run_study(const StudyFile &study, const StudyCall &call, Console &console)
  {
    if (study.measures.empty())
      throw InputError("The study " + study.path +
                       " measures nothing: the list 'Measures' is empty. "
                       "Write 'set Measures = frequency' and a section "
                       "'Measure frequency'.");
    StudyRuns runs(study, call, console);
    if (call.validate)
      return int(ExitCode::success);

    if (!runs.prepare_comparison())
      return runs.interrupted();
    StudyReport report{study, {}, caption_of(call.command)};
    for (const Variant &variant : runs.variants())
      {
        const auto end = runs.run(variant);
        if (!end)
          return runs.interrupted();
        if (is_compared(study) &&
            outcome_of(*end, variant.folder) == "finished" &&
            !runs.compare(variant))
          return runs.interrupted();
        report.rows.push_back(row_from(study, variant, *end));
        runs.progress(variant, describe(study, report.rows.back()));
      }

    std::vector<double> levels = study.error_levels;
    for (const double level : call.error_levels)
      if (std::find(levels.begin(), levels.end(), level) == levels.end())
        levels.push_back(level);
    const std::string findings =
      study.horizontal_axis.empty() ? cheapest_variants(report, levels) : "";
    write_report(report, findings);
    console.say(findings + "table in " + study.directory +
                "/study.csv and study.md\n" + draw_chart(study));
    return int(ExitCode::success);
  }
} // namespace limber
