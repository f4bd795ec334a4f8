// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_report_h
#define limber_study_report_h

#include <limber/study/run_result.h>
#include <limber/study/variants.h>

#include <map>
#include <string>
#include <vector>

/**
 * @file Results of a study: a table for programs (study.csv), one for people
 * (study.md), what a drawing program needs beside the first (study.json), and
 * sentences.
 */
namespace limber
{
  /** What a variant has given. */
  struct StudyRow
  {
    Variant                variant;
    std::string            outcome; // "finished", or what went wrong
    std::string            beyond;  // outcome just above a largest stable value
    int                    exit_code = 0;
    std::map<Cost, double> costs;    // of a run that has left a summary
    std::vector<Measured>  measured; // one per measure, if it has finished
  };

  struct StudyReport
  {
    StudyFile             study;
    std::vector<StudyRow> rows;
    std::string           caption; // machine, version, command
  };

  /** What the method's formula says for this variant, or not a number. */
  double
  expected(const StudyReport &report, const StudyRow &row);

  /** Pareto front: rows that no other one beats in both cost and error, by
   * measure. */
  std::vector<bool>
  pareto_front(const StudyReport &report, const std::size_t measure);

  /**
   * For each level the cheapest variant with an error not above it, and what
   * every other method needs for it: lines of text.
   */
  std::string
  cheapest_variants(const StudyReport         &report,
                    const std::vector<double> &levels);

  /** Processor, cores, version, revision, day, command. */
  std::string
  caption_of(const std::string &command);

  /**
   * Write study.csv, study.json and study.md into the folder of the study;
   * @p findings: sentences for the latter. Throws FileError.
   */
  void
  write_report(const StudyReport &report, const std::string &findings);

  /**
   * Have contrib/plot/plot_study.py draw study.svg and study.png. Returns what
   * to tell the user: where the chart is, or how to make it elsewhere.
   */
  std::string
  draw_chart(const StudyFile &study);
} // namespace limber

#endif
