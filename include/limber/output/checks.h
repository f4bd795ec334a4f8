// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_checks_h
#define limber_output_checks_h

#include <limber/problem/problem.h>

#include <limits>
#include <string>
#include <vector>

namespace limber
{
  /** A check of the scene at the end of a run. */
  struct CheckResult
  {
    std::string name, observable;
    double      value     = 0;
    double      reference = 0;
    double      tolerance = 0; // largest admissible difference
    bool        passed    = false;

    /** The line of the end of a run: value, reference, verdict. */
    std::string
    text() const;
  };



  /** The row nearest to the time of a check so far; plain data, for
   * checkpoints. */
  struct CheckedValue
  {
    double distance = std::numeric_limits<double>::infinity(); // s
    double value    = std::numeric_limits<double>::quiet_NaN();
  };



  /** Compares observables with the reference values of the scene. */
  class Checks
  {
  public:
    /** @p observables: names in the order of the values of a row. */
    Checks(const std::vector<Check>       &checks,
           const std::vector<std::string> &observables);

    /** The times at which rows are wanted, s, ascending. */
    std::vector<double>
    times() const;

    /** A further row; the last one counts for checks at the end. */
    void
    add(const double time, const std::vector<double> &values);

    /** In the order of the scene. NaN does not pass. */
    std::vector<CheckResult>
    results() const;

    const std::vector<CheckedValue> &
    state() const
    {
      return found;
    }

    void
    restore(const std::vector<CheckedValue> &state)
    {
      found = state;
    }

  private:
    const std::vector<Check>  checks;
    std::vector<unsigned int> column; // of each check's observable
    std::vector<CheckedValue> found;
  };
} // namespace limber

#endif
