// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_passed_sides_h
#define limber_simulation_passed_sides_h

#include <limber/base/console.h>
#include <limber/state/material_body.h>

namespace limber
{
  /**
   * A body that is computed in its initial frame feels a side of the box only
   * where it touched it at the start. Throws ComputationError where a point
   * has passed a side that is not free. What was next to that side at the start
   * may bulge by half a cell, with a warning; or go where it wants if the side
   * moves, which takes it along. A body that feels the side at its surface
   * must not be pressed through it by half a cell.
   * Collective, a pass over the points of such bodies.
   */
  template <int dim>
  void
  check_passed_sides(const State<dim> &state, Console &console);
} // namespace limber

#endif
