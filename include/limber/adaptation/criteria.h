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
   * How many pairs of fine cells lie around what moving refinements ask for.
   * One, as points that come to lie in the rim are split; but six (three in
   * space) where the refinements want all bodies fine wherever they are: then
   * nothing but room becomes fine, which costs memory alone, and the mesh has
   * to change less often.
   */
  template <int dim>
  unsigned int
  rim_pairs(const Problem<dim> &problem);



  /**
   * The graded mesh that the scene's refinements ask for at @p time, s, seen
   * from the mesh as it is: a cell can ask to be divided once more, so several
   * changes may be needed until nothing is asked for. Where refinements move,
   * there is a rim of fine cells around what they ask for (rim_pairs()), so
   * that points may go on for a while. Cells with more points than can be of
   * their size are not to be joined. Collective; throws InputError where a
   * formula is not finite.
   */
  template <int dim>
  RefinedCells<dim>
  wanted_mesh(const Problem<dim>                                    &problem,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              double                                                 time);
} // namespace limber

#endif
