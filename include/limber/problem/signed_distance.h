// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_signed_distance_h
#define limber_problem_signed_distance_h

#include <limber/problem/shape.h>

#include <algorithm>
#include <cmath>

/** @file Signed distances that those of shapes are composed of. */
namespace limber
{
  /**
   * From a ball, and from a circle in the plane normal to a cylinder's axis.
   */
  template <int dim>
  SignedDistance<dim>
  distance_from_ball(const dealii::Point<dim> &place,
                     const dealii::Point<dim> &centre,
                     double                    radius);

  /** From the slab between two ends along a direction. */
  template <int dim>
  SignedDistance<dim>
  distance_from_slab(const dealii::Point<dim> &place,
                     unsigned int              direction,
                     double                    lower,
                     double                    upper);

  /** From the intersection of two regions whose normals are perpendicular:
   * exact outside at their common edge as well. */
  template <int dim>
  SignedDistance<dim>
  distance_from_common_part(const SignedDistance<dim> &one,
                            const SignedDistance<dim> &other);

  /** From closed polygons; contains(place) tells which side is inside. Compares
   * every edge. */
  template <class Edges, class Contains>
  SignedDistance<2>
  distance_from_edges(const dealii::Point<2> &place,
                      const Edges            &edges,
                      const Contains         &contains)
  {
    double               least = 1e300;
    dealii::Tensor<1, 2> from, along; // from the nearest place; of its edge
    for (const auto &edge : edges)
      {
        dealii::Tensor<1, 2> run, way;
        for (unsigned int d = 0; d < 2; ++d)
          {
            run[d] = edge[1][d] - edge[0][d];
            way[d] = place[d] - edge[0][d];
          }
        const double square = run.norm_square();
        const double share =
          square > 0 ? std::min(1., std::max(0., way * run / square)) : 0;
        way -= share * run;
        if (const double here = way.norm_square(); here < least)
          {
            least = here;
            from  = way;
            along = run;
          }
      }
    SignedDistance<2> result;
    const bool        inside   = contains(place);
    const double      distance = std::sqrt(least), length = along.norm();
    result.value = inside ? -distance : distance;
    if (distance > 1e-9 * length)
      result.normal = from / result.value;
    else // on the edge, whose outside is where the region is not
      {
        result.normal[0] = along[1] / length;
        result.normal[1] = -along[0] / length;
        if (contains(place + 1e-6 * length * result.normal))
          result.normal *= -1;
      }
    return result;
  }
} // namespace limber

#endif
