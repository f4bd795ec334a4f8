// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_single_point_h
#define limber_points_single_point_h

#include <limber/points/point_view.h>

namespace limber
{
  /** A view of point @p p alone, with the arrays that laws use. */
  template <int dim>
  PointView<dim>
  only(const PointView<dim> &points, const std::size_t p)
  {
    PointView<dim> one  = points;
    one.size            = 1;
    const auto move_all = [p](auto &arrays) {
      for (auto &array : arrays)
        if (array != nullptr)
          array += p;
    };
    move_all(one.position);
    move_all(one.velocity);
    move_all(one.deviator);
    move_all(one.history);
    move_all(one.affine);
    one.mass += p;
    one.pressure += p;
    if (one.volumetric != nullptr)
      one.volumetric += p;
    one.cell += p;
    return one;
  }
} // namespace limber

#endif
