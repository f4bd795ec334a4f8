// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_side_contact_h
#define limber_problem_side_contact_h

#include <limber/problem/problem.h>

/** @file Sides of the box with friction that solids feel where they end. */
namespace limber
{
  /**
   * Let solids feel one-sided sides with friction where their material ends
   * (Body::meets_sides, Side::meets_surfaces); says in the log of which it is
   * the nodes that feel them, and why. Method, bodies and their nodal fields
   * are known.
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
