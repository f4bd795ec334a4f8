// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_criteria_h
#define limber_adaptation_criteria_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/** @file Evaluation of the refinement criteria of the scene. */
namespace limber
{
  /**
   * Width, in pairs of fine cells, of the margin around what moving refinements
   * ask for. One, as points that enter the margin are split; but six (three in
   * 3d) if the refinements want all bodies fine wherever they are: then only
   * empty cells become fine, which costs nothing but memory, and the mesh has
   * to change less often.
   */
  template <int dim>
  unsigned int
  rim_pairs(const Problem<dim> &problem);



  /**
   * The graded (2:1) mesh that the refinements of the scene ask for at @p time,
   * s, relative to the present one: cells are refined by at most one level at a
   * time, so several passes may be needed. Moving refinements get a margin of
   * fine cells (rim_pairs()), in which points may move for a while. Cells with
   * too many points for a coarser size are not coarsened. Collective; throws
   * InputError if a formula is not finite.
   */
  template <int dim>
  RefinedCells<dim>
  wanted_mesh(const Problem<dim>                                    &problem,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              double                                                 time);
} // namespace limber

#endif
