// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_seeding_h
#define limber_points_seeding_h

#include <limber/points/material_points.h>
#include <limber/problem/problem.h>

#include <functional>

namespace limber
{
  /**
   * Fill the shape of a body with points, each on the rank that owns its
   * cell. @p density gives the mass per volume (kg/m^3) at its place.
   *
   * Placements cell by cell give a point its share of the volume of the cell,
   * and a point belongs to the body when its place lies inside the shape; with
   * 'cut' a part whose corners and centre do not agree on this has the volume
   * and the centroid of those of its 16^2 or 8^3 sample places that do. With
   * 'gauss' what of a cell is inside, from the same parts, has the places of
   * Gauss and Legendre in a parallelepiped with its centroid and its second
   * moments: volume, first and second moments of the body are those of its
   * shape, exactly in boxes and in blocks of the plane. The placement 'fitted'
   * divides the shape itself, into parts of exact volume.
   *
   * Placement is reproducible: jitter depends on the place of a cell, not on
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
