// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_h
#define limber_study_study_h

#include <limber/base/console.h>
#include <limber/study/report.h>

#include <functional>
#include <string>
#include <vector>

namespace limber
{
  /** How the user called a study. */
  struct StudyCall
  {
    bool                resume   = false;
    bool                validate = false; // list the variants, run nothing
    std::vector<double> error_levels;     // besides those of the file
    std::string         command;          // as typed, for captions
  };

  /**
   * Run all variants, one after the other, and report. A variant that fails is
   * a result; returns success, or stopped_by_signal + n where the user has
   * interrupted it. Throws InputError before anything has been run.
   */
  int
  run_study(const StudyFile &study, const StudyCall &call, Console &console);

  /** The same with a bisection for every variant. */
  int
  run_stability(const StudyFile &study,
                const StudyCall &call,
                Console         &console);
} // namespace limber

#endif
