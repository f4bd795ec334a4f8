// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_summary_h
#define limber_output_summary_h

#include <limber/output/checks.h>
#include <limber/output/health.h>

#include <string>
#include <utility>
#include <vector>

namespace limber
{
  /** How a run ended and what it took, for scripts. */
  struct Summary
  {
    // "finished", "check missed", "unstable", "failed", "stopped", "wall time"
    std::string verdict;
    std::string message; // why, where it did not finish
    // of an unstable or failed run, in a word or two: word_for(FailureKind)
    std::string failure;
    std::string suspected; // what it has most likely fallen into, see Diagnosis
    unsigned long steps             = 0;
    unsigned long points            = 0; // at the end
    unsigned long lost_points       = 0;
    unsigned long put_back          = 0; // how often a point, see Ledger
    unsigned int  ranks             = 1;
    double        end_time          = 0; // reached, s
    double        wall_seconds      = 0;
    double        cpu_seconds       = 0; // sum over ranks
    double        ns_per_point_step = 0; // wall time of a core, output excluded
    double        memory_bytes      = 0; // largest, sum over ranks
    double        bytes_per_point   = 0;
    double        energy_drift      = 0;
    double        momentum_error    = 0;
    // Share of the largest memory that each part took when it was built
    std::vector<std::pair<std::string, double>> memory;
    // Share of the time that each verb of the step took
    std::vector<std::pair<std::string, double>> verbs;
    // How often criteria were asked, the mesh changed, points split, and the
    // time that it took, s; cells and points by level, in lines. Empty where
    // all cells are equal.
    std::vector<std::pair<std::string, double>> adaptation;
    std::string                                 levels;
    std::vector<CheckResult>                    checks;
    std::vector<HealthLine>                     health;
    std::vector<std::string>                    warnings;
  };



  /** The text of summary.json; what is not finite becomes null. */
  std::string
  to_json(const Summary &summary);

  /** Write summary.json into the run folder; throws FileError. One rank. */
  void
  write_summary(const std::string &folder, const Summary &summary);
} // namespace limber

#endif
