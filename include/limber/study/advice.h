// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_advice_h
#define limber_study_advice_h

#include <limber/problem/read_problem.h>

#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** Something that a scene could do without. */
  struct Advice
  {
    std::string what; // "Bulk modulus", for tests and headings
    std::string text; // what, why, which entry to change
    // Entries to set, from which the factor in CPU time follows by building
    // the scene; empty where the factor is known otherwise
    std::vector<std::string> settings;
    double                   factor = 1; // CPU time saved, if known otherwise
  };

  /**
   * Look at a scene. @p error: the relative error that is asked for. Formulas
   * and measured figures behind the advice are in
   * doc/guide/what_to_choose.md.
   */
  template <int dim>
  std::vector<Advice>
  advise(const SceneFile    &scene,
         const Problem<dim> &problem,
         const double        error,
         const double        first_step);
} // namespace limber

#endif
