// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_shape_volume_h
#define limber_points_shape_volume_h

#include <limber/points/material_points.h>
#include <limber/problem/shapes.h>

namespace limber
{
  /**
   * The volume of a shape, m^dim: by formula, where it has one, else by
   * counting places on a lattice over its bounding box, finer where its
   * surface cuts. Some 20 000 (2D) to 400 000 (3D) places are asked, and the
   * volume is right to some 1e-3.
   */
  template <int dim>
  double
  shape_volume(const Shape<dim> &shape);

  /** The same, counted whether there is a formula or not. */
  template <int dim>
  double
  counted_volume(const Shape<dim> &shape);

  /**
   * The part of a volume (m^dim) that points on this rank have inside another
   * shape, and the sum of their places weighted with it.
   */
  template <int dim>
  struct VolumeInside
  {
    double                 volume = 0;
    dealii::Tensor<1, dim> moment;
  };

  /**
   * How much of the points of a body lies in another's @p shape; a point has
   * the volume of its mass (kg) over @p density (kg/m^3).
   */
  template <int dim>
  VolumeInside<dim>
  volume_inside(const PointView<dim> &points,
                double                density,
                const Shape<dim>     &shape);
} // namespace limber

#endif
