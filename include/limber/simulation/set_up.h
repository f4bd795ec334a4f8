// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_set_up_h
#define limber_simulation_set_up_h

#include <limber/state/material_body.h>

namespace limber
{
  /**
   * Turn the bodies of a scene into points with mass, velocity and initial
   * stress; balance the mesh over ranks by the number of points. Throws
   * InputError for a body without points.
   */
  template <int dim>
  std::vector<std::unique_ptr<MaterialBody<dim>>>
  set_up_bodies(const Problem<dim> &problem, BackgroundGrid<dim> &grid);

  /**
   * Partition the mesh anew so that every rank has about as many points, and
   * take the points along. The caller rebuilds what depends on the mesh.
   */
  template <int dim>
  void
  balance(BackgroundGrid<dim>                             &grid,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);
} // namespace limber

#endif
