// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_file_h
#define limber_study_study_file_h

#include <limber/base/functions.h>
#include <limber/base/parameters.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

/**
 * @file The description of a study, as plain data: a scene, what is varied,
 * measured and compared, and the measure of cost. `limber study` measures every
 * variant; `limber stability` seeks for each the largest stable value of an
 * entry.
 */
namespace limber
{
  /** A choice with a name: the entries of the scene that make it. */
  struct Choice
  {
    std::string              label;
    std::vector<std::string> settings; // "Section/Name=value"
  };

  /** What a variant is run by. */
  enum class Runner
  {
    points,   // limber scene.prm
    reference // limber reference scene.prm
  };

  /** A line of the chart. */
  struct StudyMethod
  {
    Choice choice;
    Runner runner = Runner::points;
    // What the measure is expected to be, as a formula of x, the number on the
    // horizontal axis; empty: not known
    Formula<2> closed_form;
  };

  /** Entries and the values that they take in turn. */
  struct Variation
  {
    std::string         name;
    std::vector<Choice> choices;
    // Another choice is another problem: costs are not compared across them.
    bool is_problem = false;
  };

  /** Where a measure is taken from. */
  enum class MeasureSource
  {
    check,
    column,
    summary,
    comparison // relative L2 error against what the study compares with
  };

  /** How a column over time becomes one number. */
  enum class Reduction
  {
    last,
    largest,
    smallest,
    largest_magnitude,
    last_over_first,
    largest_over_first,
    amplitude_per_step
  };

  /** A number that is taken from every run. */
  struct Measure
  {
    std::string   name;
    MeasureSource source = MeasureSource::check;
    // Names of checks, of which the worst counts; of columns, which are added
    // up; of a number of summary.json
    std::vector<std::string> of;
    Reduction                reduction = Reduction::last; // of columns
    double from_time  = 0; // s; earlier and later rows do not count
    double until_time = std::numeric_limits<double>::infinity();
    // |value - reference| / scale is the error. Without reference: the value
    std::optional<double> reference;
    std::optional<double> scale; // empty: |reference|

    /** Whether it is an error, not a mere number. */
    bool
    has_error() const
    {
      return reference || source == MeasureSource::check ||
             source == MeasureSource::comparison;
    }
  };

  /** What runs are compared with, at the same initial places and times. */
  enum class Standard
  {
    reference, // the scene by finite elements
    points,    // another run of the scene
    exact      // the formulas of its section 'Exact solution'
  };

  struct ComparisonRequest
  {
    Standard                 with = Standard::reference;
    std::vector<std::string> settings; // of the reference or the other run
  };

  enum class Cost
  {
    cpu_seconds,
    wall_seconds,
    memory,
    steps
  };

  /** What `limber stability` does with every variant. */
  struct BisectionRequest
  {
    std::string  entry; // whose largest stable value is sought
    double       lower = 0, upper = 0;
    double       tolerance = 0.005; // relative width of the bracket at the end
    unsigned int steps     = 1000;  // a stable run does them all
    double       growth    = 100;   // of energy; more is not stable
  };

  /** A study with all its variations, measures and options. */
  struct StudyFile
  {
    std::string              path; // as the user typed it
    std::string              title;
    std::string              scene; // path
    std::string              directory;
    bool                     replace = false; // what a former study left there
    std::vector<std::string> settings;        // for all variants
    std::vector<StudyMethod> methods;
    std::vector<Variation>   variations;
    std::vector<Measure>     measures;
    ComparisonRequest        comparison; // for measures that ask for it
    std::vector<double>      error_levels;
    Cost                     cost       = Cost::cpu_seconds;
    double                   time_limit = 600; // s, wall time of one run
    // Name of the variation on the horizontal axis; empty: the cost
    std::string horizontal_axis;
    std::string horizontal_label; // what stands at the axis
    std::string vertical_label;
    std::string logarithmic = "both"; // "horizontal", "vertical", "none"
    // Names of what the chart draws, empty: all; the table has all
    std::vector<std::string> drawn_methods, drawn_measures;
    BisectionRequest         bisection;
    bool                     is_short = false;
  };

  /** Whether a measure asks for a comparison. */
  bool
  is_compared(const StudyFile &study);

  /** "CPU seconds", "wall seconds", "memory", "steps". */
  std::string
  name_of(const Cost cost);

  /**
   * Declare the entries of a study in @p parameters and give them the values
   * of file and command line. Throws InputError.
   */
  void
  read_entries(const std::string              &path,
               const std::vector<std::string> &overrides,
               Parameters                     &parameters);

  /**
   * Read a study. @p overrides are "Section/Name=value" from the command
   * line; @p take_short: the short lists, where the study has them. Paths in
   * the file are relative to its folder. Throws InputError.
   */
  StudyFile
  read_study(const std::string              &path,
             const std::vector<std::string> &overrides,
             const bool                      take_short);

  /** All entries that a study may have, as a template or for the manual. */
  void
  print_study_parameters(std::ostream &out, const PrintStyle style);
} // namespace limber

#endif
