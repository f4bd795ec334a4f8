// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_seeding_h
#define limber_points_seeding_h

#include <limber/points/material_points.h>
#include <limber/problem/problem.h>

#include <functional>

namespace limber
{
  /**
   * Fill the shape of a body with points, cell by cell, on the rank that owns
   * the cell. Each point stands for its share of the volume of the cell;
   * @p density gives the mass per volume (kg/m^3) at its place.
   *
   * Placement is reproducible: jitter depends on the place of a cell, not on
   * ranks. A point belongs to the body when its place lies inside the shape.
   */
  template <int dim>
  void
  seed(const Body<dim>                                         &body,
       const BackgroundGrid<dim>                               &grid,
       const std::function<double(const dealii::Point<dim> &)> &density,
       MaterialPoints<dim>                                     &points);
} // namespace limber

#endif
