// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_passed_sides_h
#define limber_simulation_passed_sides_h

#include <limber/base/console.h>
#include <limber/state/material_body.h>

namespace limber
{
  /**
   * A body in its initial frame detects a side of the box only where it touched
   * it at the start. Throws ComputationError where a point has passed a side
   * that is not free. Points that were next to that side may bulge by half a
   * cell, with a warning, or move freely with a side that moves. A body with
   * contact at its surface must not be pressed through a side by half a cell.
   * Collective, a pass over the points of such bodies.
   */
  template <int dim>
  void
  check_passed_sides(const State<dim> &state, Console &console);
} // namespace limber

#endif
