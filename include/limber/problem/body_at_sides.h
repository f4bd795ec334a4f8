// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_body_at_sides_h
#define limber_problem_body_at_sides_h

#include <limber/problem/problem.h>

/**
 * @file Where bodies touch each other and the sides of the box at the start.
 */
namespace limber
{
  /** Whether the body touches a side with a face, not only in a line or a
   * corner as a ball on the floor does. */
  template <int dim>
  bool
  has_face_in(unsigned int                side,
              const Body<dim>            &body,
              const GridDescription<dim> &grid);

  /**
   * Whether a body without loads never reaches a side, even if it grows by a
   * fifth: its centre is at rest, whatever it does otherwise. A flying body
   * meets a side in the end, and a run may be extended. Sampled on a lattice.
   * @p face_loads: the scene has some.
   */
  template <int dim>
  bool
  stays_clear(bool                face_loads,
              const Body<dim>    &body,
              const Problem<dim> &problem);

  /**
   * Whether a body is held: it ends with a face in a side that holds it or, in
   * steps of Newton's method, with faces in sides that together prevent all
   * translations, like planes of symmetry. In explicit steps it may be thrown
   * off such planes.
   */
  template <int dim>
  bool
  is_held(const Body<dim> &body, const Problem<dim> &problem);

  /**
   * Whether the bodies of a scene are one piece: they share nodes of the grid,
   * directly or by way of others, and stick to each other there. Sampled on a
   * lattice.
   */
  template <int dim>
  bool
  are_one_piece(const Problem<dim> &problem);

  /** Throws InputError where a side with a 'velocity' moves inward so far that
   * bodies in the current frame would lose contact: its nodes stay in place.
   * Returns warnings about liquids, whose points spread evenly in the room that
   * a side has not left. */
  template <int dim>
  std::vector<std::string>
  check_moving_sides(const Problem<dim> &problem);
} // namespace limber

#endif
