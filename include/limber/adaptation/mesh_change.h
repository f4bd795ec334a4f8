// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_mesh_change_h
#define limber_adaptation_mesh_change_h

#include <limber/state/material_body.h>

#include <memory>
#include <vector>

/** @file Changes of the mesh under the points: repartitioning and AMR. */
namespace limber
{
  /**
   * Load balancing: repartition the cells so that ranks get equal numbers of
   * points; tables are rebuilt, points migrate. Fields of nodes and cells have
   * to adopt the new mesh afterwards. Collective.
   */
  template <int dim>
  void
  balance(BackgroundGrid<dim>                             &grid,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

  /**
   * Refine and coarsen cells until the mesh is @p mesh, which must be graded;
   * points are not changed, stay on their ranks, and get new cell numbers.
   * Returns whether anything had to change; fields of nodes and cells then have
   * to adopt the new mesh, and ranks may be out of balance. Collective.
   */
  template <int dim>
  bool
  change_mesh(BackgroundGrid<dim>                             &grid,
              std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              const RefinedCells<dim>                         &mesh);
} // namespace limber

#endif
