// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_compare_h
#define limber_study_compare_h

#include <limber/base/console.h>

#include <string>
#include <vector>

namespace limber
{
  /**
   * `limber compare RUN OTHER`: displacement, velocity, pressure and stress of
   * the material points of a run (or the nodes of a reference) against those
   * of OTHER at the same initial place and time, and the observables of both.
   * OTHER is the folder of a reference, that of another run with the same
   * body, or the word 'exact' for the formulas in section 'Exact solution' of
   * the run's scene. Writes comparison and comparison.json into the folder of
   * the run. @p words: what stands behind 'compare'. Throws a Failure. For
   * one rank.
   */
  int
  run_compare(const std::vector<std::string> &words, Console &console);
} // namespace limber

#endif
