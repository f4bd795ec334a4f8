// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/checks.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace limber
{
  std::string
  CheckResult::text() const
  {
    std::ostringstream text;
    text << "check " << name << ": ";
    if (std::isnan(value)) // a frequency, say, in less than a period
      text << "no value yet";
    else
      text << value;
    text << ", reference " << reference << " +- " << tolerance
         << (passed ? ", passed" : ", MISSED");
    return text.str();
  }



  Checks::Checks(const std::vector<Check>       &checks,
                 const std::vector<std::string> &observables)
    : checks(checks)
    , found(checks.size())
  {
    for (const Check &check : checks)
      {
        const auto place =
          std::find(observables.begin(), observables.end(), check.observable);
        if (place == observables.end())
          throw std::logic_error("no observable " + check.observable);
        column.push_back(place - observables.begin());
      }
  }



  std::vector<double>
  Checks::times() const
  {
    std::vector<double> result;
    for (const Check &check : checks)
      if (check.at_time)
        result.push_back(*check.at_time);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }



  void
  Checks::add(const double time, const std::vector<double> &values)
  {
    for (unsigned int c = 0; c < checks.size(); ++c)
      {
        const bool   at_end = !checks[c].at_time;
        const double distance =
          at_end ? 0 : std::abs(time - *checks[c].at_time);
        if (at_end || distance < found[c].distance)
          found[c] = {distance, values[column[c]]};
      }
  }



  std::vector<CheckResult>
  Checks::results() const
  {
    std::vector<CheckResult> results;
    for (unsigned int c = 0; c < checks.size(); ++c)
      {
        const Check &check = checks[c];
        CheckResult  result;
        result.name       = check.name;
        result.observable = check.observable;
        result.value      = found[c].value;
        result.reference  = check.reference;
        result.tolerance  = check.tolerance;
        result.passed =
          !std::isnan(result.value) &&
          std::abs(result.value - check.reference) <= check.tolerance;
        results.push_back(result);
      }
    return results;
  }
} // namespace limber
