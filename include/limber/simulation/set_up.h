// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_set_up_h
#define limber_simulation_set_up_h

#include <limber/adaptation/mesh_change.h>

namespace limber
{
  /**
   * Seeds the points of the bodies of a scene with mass, velocity and initial
   * stress; refines the mesh as the scene wants it at the start, and balances
   * it over ranks by the number of points. Throws InputError for a body without
   * points, and for one that is thinner than the cells that hold it where these
   * could be finer.
   */
  template <int dim>
  std::vector<std::unique_ptr<MaterialBody<dim>>>
  set_up_bodies(const Problem<dim> &problem, BackgroundGrid<dim> &grid);
} // namespace limber

#endif
