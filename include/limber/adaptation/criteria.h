// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_criteria_h
#define limber_adaptation_criteria_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/** @file What the scene wants the mesh to be. */
namespace limber
{
  /**
   * The graded mesh that the scene's refinements ask for at @p time, s, seen
   * from the mesh as it is: a cell can ask to be divided once more, so several
   * changes may be needed until nothing is asked for. Where refinements move,
   * there is a rim of two fine cells around what they ask for, so that points
   * may go on for a while. Cells with more points than can be of their size are
   * not to be joined. Collective; throws InputError where a formula is not
   * finite.
   */
  template <int dim>
  RefinedCells<dim>
  wanted_mesh(const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              double                                                 time);
} // namespace limber

#endif
