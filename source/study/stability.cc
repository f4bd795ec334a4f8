// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/study/study.h>
#include <limber/study/study_runs.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace limber
{
  namespace
  {
    /**
     * The one variation whose values are numbers, against which the largest
     * stable value can be drawn. Throws InputError where there is not just one.
     */
    std::string
    only_axis(const StudyFile &study)
    {
      std::vector<std::string> axes;
      for (const Variation &variation : study.variations)
        if (std::all_of(variation.choices.begin(),
                        variation.choices.end(),
                        [](const Choice &choice) {
                          return to_number(choice.label).has_value();
                        }))
          axes.push_back(variation.name);
      if (axes.size() != 1)
        throw InputError(
          "The study " + in_quotes(study.path) + " has " +
          (axes.empty() ? "no variation over numbers" :
                          counted(axes.size(), "variation") + " (" +
                            join(axes, ", ") + ")") +
          " to draw the largest stable value against. In section 'Chart', set "
          "'Horizontal axis' to the name of one.");
      return axes.front();
    }



    /**
     * The largest kinetic plus strain energy of a run over that of its start.
     * Throws InputError where it starts without any.
     */
    double
    energy_growth(const std::string &folder, const std::string &variant)
    {
      const Table  table   = read_statistics(folder);
      const auto  &kinetic = table.at("kinetic energy");
      const auto  &strain  = table.at("strain energy");
      const double start   = kinetic.front() + strain.front();
      if (!(start > 0))
        throw InputError("The variant " + in_quotes(variant) +
                         " starts without kinetic or strain energy, so its "
                         "growth cannot be told. Give its body a small "
                         "'Initial velocity'.");
      double largest = 0;
      for (std::size_t i = 0; i < kinetic.size(); ++i)
        {
          const double energy = kinetic[i] + strain[i];
          if (std::isnan(energy))
            return energy;
          largest = std::max(largest, energy);
        }
      return largest / start;
    }



    /** Bisection for the largest stable value of an entry in one variant. */
    class Bisection
    {
    public:
      Bisection(const StudyFile &study, const Variant &variant, StudyRuns &runs)
        : request(study.bisection)
        , variant(variant)
        , runs(runs)
      {}

      /** Nothing if the user has interrupted it. */
      std::optional<StudyRow>
      search()
      {
        StudyRow row{variant, "finished", "", 0, {}, {}};
        double   stable = request.lower, unstable = request.upper;
        // The upper end first: if it is stable, no search is needed.
        if (is_stable(unstable))
          return found(row, unstable, "stable up to " + brief(unstable));
        if (interrupted)
          return std::nullopt;
        if (!is_stable(stable) && !interrupted)
          {
            row.outcome = outcome;
            row.beyond  = outcome;
            return row;
          }
        while (!interrupted && unstable > stable * (1 + request.tolerance))
          {
            const double middle = std::sqrt(stable * unstable);
            (is_stable(middle) ? stable : unstable) = middle;
          }
        if (interrupted)
          return std::nullopt;
        return found(row, std::sqrt(stable * unstable), outcome);
      }

      unsigned int
      n_runs() const
      {
        return count;
      }

    private:
      static StudyRow
      found(StudyRow row, const double value, const std::string &beyond)
      {
        row.beyond   = beyond;
        row.measured = {{value, value}};
        return row;
      }

      bool
      is_stable(const double value)
      {
        const unsigned int interval = std::max(1u, request.steps / 200);
        const std::vector<std::string> settings = {
          request.entry + "=" + to_text(value),
          "End step=" + std::to_string(request.steps),
          "End time=1e100",
          "Output/Time interval=0",
          "Output/Point arrays=false",
          "Output/Statistics interval=" + std::to_string(interval)};
        const std::string subfolder = std::to_string(++count);
        const auto        end       = runs.run(variant, settings, subfolder);
        if (!end)
          {
            interrupted = true;
            return false;
          }
        const std::string folder = variant.folder + "." + subfolder;
        const std::string ended  = outcome_of(*end, folder);
        if (ended == "refused")
          throw InputError("The variant " + in_quotes(variant.name) +
                           " was refused with " + settings.front() + "; see " +
                           folder +
                           ".log. Usually the bounds in section 'Bisection' "
                           "are not admissible for the entry.");
        if (ended == "finished" &&
            energy_growth(folder, variant.name) <= request.growth)
          return true;
        outcome =
          ended == "finished" ? word_for(FailureKind::growing_energy) : ended;
        return false;
      }

      const BisectionRequest &request;
      const Variant          &variant;
      StudyRuns              &runs;
      unsigned int            count       = 0;
      bool                    interrupted = false;
      std::string             outcome; // of the last run that was not stable
    };



    std::string
    describe(const StudyReport &report,
             const StudyRow    &row,
             const unsigned int n_runs)
    {
      std::ostringstream text;
      text.precision(4);
      if (row.measured.empty())
        text << row.outcome << " already at " << report.study.bisection.lower;
      else
        {
          text << row.measured.front().value;
          const double formula = expected(report, row);
          if (std::isfinite(formula))
            text << " (closed form " << formula << ")";
          text << ", beyond: " << row.beyond;
        }
      text << ", " << counted(n_runs, "run");
      return text.str();
    }



    /** What the table says about the closed forms, where there are some. */
    std::string
    compare_closed_forms(const StudyReport &report)
    {
      std::ostringstream text;
      text.precision(3);
      for (std::size_t m = 0; m < report.study.methods.size(); ++m)
        {
          double worst = -1;
          for (const StudyRow &row : report.rows)
            if (row.variant.method == m && !row.measured.empty())
              {
                const double formula = expected(report, row);
                if (std::isfinite(formula) &&
                    row.beyond.rfind("stable", 0) != 0)
                  worst = std::max(
                    worst, std::abs(row.measured.front().value / formula - 1));
              }
          if (worst >= 0)
            text << report.study.methods[m].choice.label << ": within "
                 << 100 * worst << " % of the closed form\n";
        }
      return text.str();
    }
  } // namespace



  int
  run_stability(const StudyFile &asked, const StudyCall &call, Console &console)
  {
    StudyFile   study = asked;
    std::string entry = study.bisection.entry;
    entry             = entry.substr(entry.rfind('/') + 1);
    Measure measure;
    measure.name   = "largest stable " + entry;
    measure.source = MeasureSource::summary; // without error
    study.measures = {measure};
    if (study.horizontal_axis.empty())
      study.horizontal_axis = only_axis(study);

    StudyRuns runs(study, call, console);
    if (call.validate)
      return int(ExitCode::success);
    StudyReport report{study, {}, caption_of(call.command)};
    for (const Variant &variant : runs.variants())
      {
        Bisection  bisection(study, variant, runs);
        const auto row = bisection.search();
        if (!row)
          return runs.interrupted();
        report.rows.push_back(*row);
        runs.progress(variant, describe(report, *row, bisection.n_runs()));
      }
    const std::string findings = compare_closed_forms(report);
    write_report(report, findings);
    console.say(findings + "table in " + study.directory +
                "/study.csv and study.md\n" + draw_chart(study));
    return int(ExitCode::success);
  }
} // namespace limber
