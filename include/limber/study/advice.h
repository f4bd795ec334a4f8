// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_advice_h
#define limber_study_advice_h

#include <limber/problem/read_problem.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** A possible saving in a scene. Whether it is harmless is decided by runs
   * with and without it (advice_runs.h). */
  struct Advice
  {
    std::string what;    // "Bulk modulus", for tests and headings
    std::string text;    // what could be spared, and why
    std::string changes; // what may become different, and how
    // Entries to set
    std::vector<std::string> settings;
    double                   memory = 0; // bytes saved, by estimate
    double      factor = 0; // CPU time saved, where it needs no run, and why:
    std::string ground;
    // Whether the discrete equations and their unknowns stay the same; a part
    // of the run is then enough to see that it is harmless.
    bool is_exact = false;
    // Number of cell crossings of a point up to which the advice holds (creep):
    // with linear functions each turns a share of the strain into a permanent
    // one, the more the fewer points a cell holds, and it adds up with the
    // length of the run.
    double longest_way = std::numeric_limits<double>::infinity();
  };

  /**
   * Possible savings in a scene. @p error: the relative error that is
   * acceptable; @p first_step of the scene as it is, s. Formulas behind the
   * choice are in doc/guide/what_to_choose.md.
   */
  template <int dim>
  std::vector<Advice>
  find_advice(const SceneFile    &scene,
              const Problem<dim> &problem,
              const double        error,
              const double        first_step);

  /** Advice to compute a plane problem, where nothing changes along an axis. */
  template <int dim>
  std::optional<Advice>
  advise_dimension(const Problem<dim> &problem);

  /** Advice to leave out parts of the box that nothing can reach. */
  template <int dim>
  std::optional<Advice>
  advise_box(const Problem<dim> &problem);

  /**
   * Advice for adaptive refinement: coarse cells where the box is empty, fine
   * ones that go along with all bodies; where that spares a tenth of the memory
   * at least and leaves functions, frames and schemes as they are.
   */
  template <int dim>
  std::optional<Advice>
  advise_levels(const SceneFile &scene, const Problem<dim> &problem);

  /**
   * Advice against levels that no refinement asks for where a point can get.
   */
  template <int dim>
  std::optional<Advice>
  advise_unused_levels(const Problem<dim> &problem);

  /** "0.5; 1" and the like, as the numbers of an entry. */
  std::string
  entry_of(const std::vector<double> &numbers);
} // namespace limber

#endif
