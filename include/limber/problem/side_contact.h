// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_side_contact_h
#define limber_problem_side_contact_h

#include <limber/problem/problem.h>

#include <string>

/**
 * @file Contact of solids with sides of the box, with friction, at surfaces.
 */
namespace limber
{
  /**
   * Whether bodies may hit a side and separate again: it is one-sided, or it is
   * a slip side at which no body lies with a face at the start, while one may
   * move there. @p face_loads: the scene has some.
   */
  template <int dim>
  bool
  may_be_hit(unsigned int side, bool face_loads, const Problem<dim> &problem);

  /** Why contact of a body with sides acts at its nodes and not at its surface;
   * empty if it acts at the surface. */
  template <int dim>
  std::string
  why_at_nodes(const Body<dim> &body, const Problem<dim> &problem);

  /**
   * Lets contact of solids with the sides that they may hit (Side::may_be_hit)
   * act at their surfaces (Body::meets_sides, Side::meets_surfaces); says in
   * the log where it acts at nodes, and why. Method, bodies, their nodal fields
   * and loads are known.
   */
  template <int dim>
  void
  choose_side_contact(Problem<dim> &problem);

  /** The sides for nodes of bodies with contact at surfaces: those that act on
   * surfaces are free. */
  template <int dim>
  Sides<dim>
  sides_at_nodes(Sides<dim> sides);

  /**
   * The half-space beyond a side of the box as an obstacle, with its friction.
   */
  template <int dim>
  Obstacle<dim>
  half_space_beyond(unsigned int side, const Problem<dim> &problem);
} // namespace limber

#endif
