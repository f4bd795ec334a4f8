// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_seeding_h
#define limber_points_seeding_h

#include <limber/points/material_points.h>
#include <limber/problem/problem.h>

#include <functional>

namespace limber
{
  /**
   * Fill the shape of a body with points, each on the rank that owns its cell.
   * @p density gives the mass per volume (kg/m^3) at a position.
   *
   * Placements by cells give a point its share of the volume of the cell, if
   * its position is inside the shape. With 'cut' a point has the volume and the
   * centroid of the part of its sub-box inside the shape (part_inside.h). With
   * 'gauss' the part of a cell inside gets the Gauss-Legendre points of a
   * parallelepiped with the same centroid and second moments, so that volume,
   * first and second moments of the body are those of its shape, exactly in
   * boxes and in blocks of the plane. 'fitted' divides the shape itself, into
   * parts of exact volume.
   *
   * Placement is reproducible: jitter depends on the position of a cell, not on
   * ranks.
   */
  template <int dim>
  void
  seed(const Body<dim>                                         &body,
       const BackgroundGrid<dim>                               &grid,
       const std::function<double(const dealii::Point<dim> &)> &density,
       MaterialPoints<dim>                                     &points);
} // namespace limber

#endif
