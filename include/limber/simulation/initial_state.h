// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_initial_state_h
#define limber_simulation_initial_state_h

#include <limber/problem/problem.h>
#include <limber/stress/stress_update.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace limber
{
  /**
   * Initial stress and history of the points of a body, by the formulas of the
   * scene or in equilibrium with gravity: with the weight of the material
   * straight above, up to the surface, and of the bodies that lie on it there
   * if they start under stress as well. Under a roof (a solid without initial
   * stress, an obstacle, a side of the box) it is as if the material reached up
   * to the highest place of the body, as in a U-tube.
   */
  template <int dim>
  class InitialState
  {
  public:
    using OfAllBodies = std::vector<std::unique_ptr<InitialState<dim>>>;

    /** @p of_all has those of all bodies when at() is called. */
    InitialState(const Problem<dim>      &problem,
                 const Body<dim>         &body,
                 const StressUpdate<dim> &law,
                 const OfAllBodies       &of_all);

    /** Throws InputError where a formula gives what cannot be. */
    PointStart<dim>
    at(const dealii::Point<dim> &place) const;

    /** Throws where the law does not admit the state of at() there. */
    [[noreturn]] void
    refuse(const dealii::Point<dim> &place) const;

  private:
    /** Material between a place and the surface straight above it. */
    struct Column
    {
      double lowest; // height of the lowest place known to be in it, m
      double top;    // height of its end, m
      double head;   // height of the surface that gives the weight, m
      double load;   // stress along gravity at the surface, Pa
    };

    /** Whether the body starts in equilibrium with gravity. */
    bool
    is_in_equilibrium() const;

    /** The column above a place of a body in equilibrium. */
    const Column &
    column_above(const dealii::Point<dim> &place) const;

    /** What presses on a surface at a place of it, Pa; empty: a roof. */
    std::optional<double>
    load_on(const dealii::Point<dim> &surface) const;

    /** Compressive stress along gravity at a place, Pa; empty for a solid
     * without initial stress. */
    std::optional<double>
    stress_along_gravity(const dealii::Point<dim> &place) const;

    void
    set_variables(const dealii::Point<dim> &place,
                  PointStart<dim>          &start) const;

    void
    set_components(const dealii::Point<dim> &place,
                   PointStart<dim>          &start) const;

    void
    set_geostatic(const dealii::Point<dim> &place,
                  PointStart<dim>          &start) const;

    /** The weight rho_0 g z of a column above a place, Pa. */
    double
    weight_above(const dealii::Point<dim> &place, const Column &column) const;

    const Problem<dim>      &problem;
    const Body<dim>         &body;
    const StressUpdate<dim> &law;
    const OfAllBodies       &of_all;

    dealii::Tensor<1, dim> up;         // against gravity, of unit length
    double                 stride = 0; // between places along a column, m
    dealii::Point<dim>     highest;    // place of the body
    // By the place on a plane across gravity, in parts of the stride: points
    // stand above each other
    mutable std::map<std::array<long long, dim>, std::vector<Column>> columns;
  };
} // namespace limber

#endif
