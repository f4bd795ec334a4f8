// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_geometry_h
#define limber_time_contact_geometry_h

#include <deal.II/base/tensor.h>

#include <cmath>

/** @file What contact with bodies and with obstacles have in common. */
namespace limber
{
  /** The part of a vector across a unit normal: along the surface. */
  template <int dim>
  inline dealii::Tensor<1, dim>
  along_surface(const dealii::Tensor<1, dim> &vector,
                const dealii::Tensor<1, dim> &normal)
  {
    return vector - (vector * normal) * normal;
  }



  /** Half the edge, m, of a cube of this volume, m^dim. */
  template <int dim>
  inline double
  half_edge_of(const double volume)
  {
    return 0.5 * (dim == 2 ? std::sqrt(volume) : std::cbrt(volume));
  }
} // namespace limber

#endif
