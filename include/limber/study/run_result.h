// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_run_result_h
#define limber_study_run_result_h

#include <limber/study/child_process.h>
#include <limber/study/study_file.h>

#include <map>
#include <string>
#include <vector>

namespace limber
{
  /** Name, value and reference of a check, from summary.json. */
  struct RecordedCheck
  {
    std::string name;
    double      value = 0, reference = 0; // not a number: null in the file
  };

  /** What a run folder tells by its summary. */
  struct RecordedSummary
  {
    std::string                   verdict, failure, message;
    std::map<std::string, double> numbers; // all of the top level
    std::vector<RecordedCheck>    checks;
  };

  /** The statistics: columns by name. */
  using Table = std::map<std::string, std::vector<double>>;

  /** Throws FileError where it is missing or not understood. */
  RecordedSummary
  read_summary(const std::string &folder);

  /** Throws FileError likewise. */
  Table
  read_statistics(const std::string &folder);

  /** A measure of a finished run; value and, where there is one, reference. */
  struct Measured
  {
    double value = 0;
    double error = 0; // |value - reference| / scale, or the value itself
  };

  /**
   * Throws InputError: the run has no column, check, ... (@p what) of that
   * name, only @p known.
   */
  [[noreturn]] void
  refuse_name(const Measure                  &measure,
              const std::string              &name,
              const std::string              &what,
              const std::vector<std::string> &known);

  /**
   * Take a measure from a run folder. Throws InputError for a name that the
   * run does not have.
   */
  Measured
  take_measure(const Measure         &measure,
               const RecordedSummary &summary,
               const std::string     &folder);

  /**
   * How a run ended, in a word or two: "finished", or what went wrong:
   * "growing energy", "not finite", "inverted point", "lost points", "step too
   * small", "time limit", "refused", "file error", "crashed (signal 11)".
   */
  std::string
  outcome_of(const ChildEnd &end, const std::string &folder);
} // namespace limber

#endif
