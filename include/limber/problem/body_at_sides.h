// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_body_at_sides_h
#define limber_problem_body_at_sides_h

#include <limber/problem/problem.h>

/** @file What bodies are to each other and to the sides of the box at the
 * start.
 */
namespace limber
{
  /**
   * Whether the body ends in a side with a face, not in a line or a corner
   * as a ball does that lies on the floor.
   */
  template <int dim>
  bool
  has_face_in(unsigned int                side,
              const Body<dim>            &body,
              const GridDescription<dim> &grid);

  /**
   * Whether a body on which nothing acts stays clear of the sides for ever,
   * also if it grows by a fifth: its centre is at rest whatever it does
   * otherwise. One that flies meets a side in the end, and a run may be
   * extended. From places on a lattice. @p face_loads: the scene has some.
   */
  template <int dim>
  bool
  stays_clear(bool                face_loads,
              const Body<dim>    &body,
              const Problem<dim> &problem);

  /**
   * Whether a body ends with a face in a side that holds it; or, in steps of
   * Newton's method, with faces in sides that together hold it against every
   * translation, as planes of symmetry do. What moves freely may be thrown
   * off such planes.
   */
  template <int dim>
  bool
  is_held(const Body<dim> &body, const Problem<dim> &problem);

  /**
   * Whether the bodies of a scene are one piece: they share nodes of the grid,
   * each directly or by others, and stick to each other there. From places on
   * a lattice.
   */
  template <int dim>
  bool
  are_one_piece(const Problem<dim> &problem);

  /**
   * Throws InputError where a side with a 'velocity' moves inward, so far that
   * bodies in the current frame would be let go: its nodes stay where they are.
   */
  template <int dim>
  void
  check_moving_sides(const Problem<dim> &problem);
} // namespace limber

#endif
