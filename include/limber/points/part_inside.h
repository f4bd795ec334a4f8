// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_part_inside_h
#define limber_points_part_inside_h

#include <limber/problem/shape.h>

namespace limber
{
  /**
   * What of a box along the axes is inside a shape: exact where the shape has a
   * formula for it. Else the box is divided into 16^2 or 8^3 pieces; those at
   * the surface are cut by the plane that the distance tells, exactly where the
   * surface is one, or count as a whole where the shape knows no distance.
   * Volume 0 where nothing is.
   */
  template <int dim>
  PartInside<dim>
  inside_of(const Shape<dim> &shape, const Corners<dim> &box);
} // namespace limber

#endif
