// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_mesh_change_h
#define limber_adaptation_mesh_change_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/** @file The ways in which the mesh changes under the points. */
namespace limber
{
  /**
   * Partition the cells anew, so that ranks get as many points each; tables
   * are rebuilt, points travel along. Fields of nodes and cells have to adopt
   * the new mesh afterwards. Collective.
   */
  template <int dim>
  void
  balance(BackgroundGrid<dim>                             &grid,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

  /**
   * Divide and join cells until the mesh is @p mesh, which is graded; points
   * stay what they are, on their ranks, and get the numbers of their new cells.
   * Returns whether anything had to change; fields of nodes and cells then have
   * to adopt the new mesh, and ranks may have unequal shares. Collective.
   */
  template <int dim>
  bool
  change_mesh(BackgroundGrid<dim>                             &grid,
              std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              const RefinedCells<dim>                         &mesh);
} // namespace limber

#endif
