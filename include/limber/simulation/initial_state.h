// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_initial_state_h
#define limber_simulation_initial_state_h

#include <limber/problem/problem.h>
#include <limber/stress/stress_update.h>

namespace limber
{
  /** Initial stress and history of the points of a body, by the formulas of the
   * scene or in equilibrium with gravity. */
  template <int dim>
  class InitialState
  {
  public:
    InitialState(const Problem<dim>      &problem,
                 const Body<dim>         &body,
                 const StressUpdate<dim> &law);

    /** Throws InputError where a formula gives what cannot be. */
    PointStart<dim>
    at(const dealii::Point<dim> &place) const;

    /** Throws where the law does not admit the state of at() there. */
    [[noreturn]] void
    refuse(const dealii::Point<dim> &place) const;

  private:
    void
    set_variables(const dealii::Point<dim> &place,
                  PointStart<dim>          &start) const;

    void
    set_components(const dealii::Point<dim> &place,
                   PointStart<dim>          &start) const;

    void
    set_geostatic(const dealii::Point<dim> &place,
                  PointStart<dim>          &start) const;

    /** The head rho_0 g z below the highest place of the body, Pa. */
    double
    head(const dealii::Point<dim> &place) const;

    const Problem<dim>      &problem;
    const Body<dim>         &body;
    const StressUpdate<dim> &law;
    double                   highest = 0; // largest -g . x in the body, m^2/s^2
  };
} // namespace limber

#endif
