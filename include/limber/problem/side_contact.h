// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_side_contact_h
#define limber_problem_side_contact_h

#include <limber/problem/problem.h>

#include <string>

/** @file Sides of the box with friction that solids feel where they end. */
namespace limber
{
  /**
   * Whether something may come to a side and leave it again: it is one-sided,
   * or it slips and no body lies at it with a face at the start, while one may
   * move there. @p face_loads: the scene has some.
   */
  template <int dim>
  bool
  may_be_hit(unsigned int side, bool face_loads, const Problem<dim> &problem);

  /** Why the nodes of a body feel sides that may be hit, and not its surface;
   * empty if that does. */
  template <int dim>
  std::string
  why_at_nodes(const Body<dim> &body, const Problem<dim> &problem);

  /**
   * Let solids feel the sides that they may hit (Side::may_be_hit) where their
   * material ends (Body::meets_sides, Side::meets_surfaces); says in the log of
   * which it is the nodes that feel them, and why. Method, bodies, their nodal
   * fields and loads are known.
   */
  template <int dim>
  void
  choose_side_contact(Problem<dim> &problem);

  /** The sides as they act on the nodes of bodies that meet sides: those that
   * meet surfaces are free. */
  template <int dim>
  Sides<dim>
  sides_at_nodes(Sides<dim> sides);

  /** What is beyond a side of the box, with its friction. */
  template <int dim>
  Obstacle<dim>
  half_space_beyond(unsigned int side, const Problem<dim> &problem);
} // namespace limber

#endif
