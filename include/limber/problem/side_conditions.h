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
  /** The components of a velocity that a kind of side holds. */
  enum class HeldComponents
  {
    none,
    normal,
    all
  };



  /**
   * What one side of the box does to the velocity of its nodes, as its word in
   * the scene says (source/problem/side_conditions.cc has the list of words).
   * Whoever applies sides knows these properties and no word.
   */
  template <int dim>
  struct Side
  {
    std::string    word = "slip";
    HeldComponents held = HeldComponents::normal;
    // Holds only what moves outward, so that the material may part from it; the
    // impulse J_n that it then gives bears a tangential one of at most the
    // friction coefficient times J_n against the motion (Coulomb).
    bool   one_sided = false;
    double friction  = 0;
    // Something may come to it and leave it again: it is one-sided, or slips
    // and no body lies at it at the start, while one may move there
    bool may_be_hit = false;
    // Felt by bodies with 'meets_sides' where their material ends, as a
    // half-space would be (ObstacleContact), instead of by their nodes
    bool         meets_surfaces = false;
    Formula<dim> velocity; // of the side, dim components, m/s; empty: at rest

    /** Of a component at a place and a time (s), m/s. */
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



  /** A component of the velocity of a node that a side holds. */
  struct HeldComponent
  {
    unsigned int side, component;
    bool         one_sided;
  };



  /**
   * Whether another side of the set alone holds this component, as the
   * velocity through it: what presses on that side at the edge of the two is
   * its force, and if one of them moves, material would go through the other
   * (the lid of a cavity).
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
   * What the sides of a set (bits) hold of a node that lies in all of them,
   * in the order in which they act: of several entries for one component the
   * last counts.
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
