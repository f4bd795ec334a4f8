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
  /**
   * Something that a scene could perhaps do without. Whether it can is what
   * runs with and without it say (advice_runs.h).
   */
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
    // Where the discrete equations and their unknowns stay the same; a part of
    // the run is enough to see that.
    bool is_exact = false;
    // Cells that the points may pass. Linear functions turn a share of the
    // strain into a permanent one at each crossing, the more the fewer points
    // a cell holds, and it adds up with the length of the run.
    double longest_way = std::numeric_limits<double>::infinity();
  };

  /**
   * Look at a scene for what may be spared. @p error: the relative error that
   * is asked for; @p first_step of the scene as it is, s. Formulas behind the
   * choice are in doc/guide/what_to_choose.md.
   */
  template <int dim>
  std::vector<Advice>
  find_advice(const SceneFile    &scene,
              const Problem<dim> &problem,
              const double        error,
              const double        first_step);

  /** That for the third dimension, where nothing changes along an axis. */
  template <int dim>
  std::optional<Advice>
  advise_dimension(const Problem<dim> &problem);

  /** That for a box that nothing can reach. */
  template <int dim>
  std::optional<Advice>
  advise_box(const Problem<dim> &problem);

  /**
   * Coarse cells where the box is empty, with fine ones that go along with all
   * bodies: where that spares a tenth of the memory at least and leaves
   * functions, frames and schemes as they are.
   */
  template <int dim>
  std::optional<Advice>
  advise_levels(const SceneFile &scene, const Problem<dim> &problem);

  /** That for levels which no refinement asks for where a point can get. */
  template <int dim>
  std::optional<Advice>
  advise_unused_levels(const Problem<dim> &problem);

  /** "0.5; 1" and the like, as the numbers of an entry. */
  std::string
  entry_of(const std::vector<double> &numbers);
} // namespace limber

#endif
