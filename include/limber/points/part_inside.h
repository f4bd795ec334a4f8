// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_part_inside_h
#define limber_points_part_inside_h

#include <limber/problem/shape.h>

namespace limber
{
  /**
   * The part of an axis-parallel box inside a shape: exact if the shape has a
   * formula. Otherwise the box is divided into 16^2 or 8^3 sub-boxes; those at
   * the surface are clipped by the plane that the signed distance gives (exact
   * for plane surfaces), or are in or out as a whole if the shape has no signed
   * distance. Volume 0 if nothing is inside.
   */
  template <int dim>
  PartInside<dim>
  inside_of(const Shape<dim> &shape, const Corners<dim> &box);
} // namespace limber

#endif
