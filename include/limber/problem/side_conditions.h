// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_side_conditions_h
#define limber_problem_side_conditions_h

#include <deal.II/base/point.h>

#include <limber/base/functions.h>

#include <array>
#include <string>
#include <vector>

namespace limber
{
  /** The velocity components that a kind of side prescribes. */
  enum class HeldComponents
  {
    none,
    normal,
    all
  };



  /**
   * Boundary condition of one side of the box on the velocity of its nodes, as
   * its word in the scene says (source/problem/side_conditions.cc has the list
   * of words). Those who apply sides know these properties and no word.
   */
  template <int dim>
  struct Side
  {
    std::string    word = "slip";
    HeldComponents held = HeldComponents::normal;
    // Prescribes outward velocities only, so that material may separate; the
    // normal impulse J_n limits the tangential one against the motion to the
    // friction coefficient times J_n (Coulomb).
    bool   one_sided = false;
    double friction  = 0;
    // Bodies may hit it and separate again: it is one-sided, or it is a slip
    // side at which no body lies at the start while one may move there
    bool may_be_hit = false;
    // Acts on bodies with 'meets_sides' at their surfaces, as a half-space
    // would (ObstacleContact), instead of at their nodes
    bool         meets_surfaces = false;
    Formula<dim> velocity; // of the side, dim components, m/s; empty: at rest

    /**
     * A component of the velocity of the side at a place and a time (s), m/s.
     */
    double
    prescribed_velocity(const dealii::Point<dim> &place,
                        const double              time,
                        const unsigned int        component) const
    {
      return velocity.empty() ? 0 : velocity.value(place, time, component);
    }
  };



  /** Sides in deal.II's order: left right bottom top back front. */
  template <int dim>
  using Sides = std::array<Side<dim>, 2 * dim>;



  /** A velocity component of a node that a side prescribes. */
  struct HeldComponent
  {
    unsigned int side, component;
    bool         one_sided;
  };



  /**
   * Whether another side of the set prescribes this component as its normal
   * velocity. At the edge of two sides that one takes precedence: the pressure
   * on it is its force, and if one of them moves, material would otherwise pass
   * through the other (lid-driven cavity).
   */
  template <int dim>
  bool
  is_held_by_normal(const Sides<dim>  &sides,
                    const unsigned int set,
                    const unsigned int side,
                    const unsigned int component)
  {
    if (component == side / 2)
      return false;
    for (const unsigned int other : {2 * component, 2 * component + 1})
      if (set >> other & 1 && sides[other].held != HeldComponents::none &&
          !sides[other].one_sided)
        return true;
    return false;
  }



  /**
   * Velocity components that the sides of a set (bits) prescribe at a node that
   * lies in all of them, in the order in which they act: of several entries for
   * one component the last counts.
   */
  template <int dim>
  std::vector<HeldComponent>
  held_components(const Sides<dim> &sides, const unsigned int set)
  {
    std::vector<HeldComponent> result;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (set >> side & 1)
        for (unsigned int component = 0; component < dim; ++component)
          if ((sides[side].held == HeldComponents::all ||
               (sides[side].held == HeldComponents::normal &&
                component == side / 2)) &&
              !is_held_by_normal(sides, set, side, component))
            result.push_back({side, component, sides[side].one_sided});
    return result;
  }
} // namespace limber

#endif
