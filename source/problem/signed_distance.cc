// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/signed_distance.h>

#include <cmath>

namespace limber
{
  using dealii::Point;



  template <int dim>
  SignedDistance<dim>
  distance_from_ball(const Point<dim> &place,
                     const Point<dim> &centre,
                     const double      radius)
  {
    SignedDistance<dim> result;
    result.normal       = place - centre;
    const double length = result.normal.norm();
    result.value        = length - radius;
    if (length > 0)
      result.normal /= length;
    else
      result.normal[0] = 1; // at the centre: any direction
    return result;
  }



  template <int dim>
  SignedDistance<dim>
  distance_from_slab(const Point<dim>  &place,
                     const unsigned int direction,
                     const double       lower,
                     const double       upper)
  {
    const double above = place[direction] - upper,
                 below = lower - place[direction];
    SignedDistance<dim> result;
    result.value             = std::max(above, below);
    result.normal[direction] = above >= below ? 1 : -1;
    return result;
  }



  template <int dim>
  SignedDistance<dim>
  distance_from_common_part(const SignedDistance<dim> &one,
                            const SignedDistance<dim> &other)
  {
    if (one.value <= 0 || other.value <= 0)
      return one.value >= other.value ? one : other;
    SignedDistance<dim> result;
    result.value = std::hypot(one.value, other.value);
    result.normal =
      (one.value * one.normal + other.value * other.normal) / result.value;
    return result;
  }



  template SignedDistance<2>
  distance_from_ball(const Point<2> &, const Point<2> &, double);
  template SignedDistance<3>
  distance_from_ball(const Point<3> &, const Point<3> &, double);
  template SignedDistance<2>
  distance_from_slab(const Point<2> &, unsigned int, double, double);
  template SignedDistance<3>
  distance_from_slab(const Point<3> &, unsigned int, double, double);
  template SignedDistance<2>
  distance_from_common_part(const SignedDistance<2> &,
                            const SignedDistance<2> &);
  template SignedDistance<3>
  distance_from_common_part(const SignedDistance<3> &,
                            const SignedDistance<3> &);
} // namespace limber
