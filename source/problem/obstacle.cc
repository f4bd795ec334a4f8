// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/obstacle.h>

#include <cmath>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;



  namespace
  {
    /** Rodrigues' formula; in the plane about the axis out of it. */
    template <int dim>
    Tensor<2, dim>
    rotation_about(const Tensor<1, 3> &axis, const double angle)
    {
      const double c = std::cos(angle), s = std::sin(angle);
      Tensor<2, 3> cross;
      cross[0][1] = -axis[2];
      cross[0][2] = axis[1];
      cross[1][0] = axis[2];
      cross[1][2] = -axis[0];
      cross[2][0] = -axis[1];
      cross[2][1] = axis[0];
      Tensor<2, dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          result[i][j] =
            (i == j ? c : 0) + s * cross[i][j] + (1 - c) * axis[i] * axis[j];
      return result;
    }
  } // namespace



  template <int dim>
  ObstaclePlace<dim>::ObstaclePlace(const Obstacle<dim> &obstacle,
                                    const double         time)
    : obstacle(&obstacle)
    , moves(obstacle.moves())
  {
    if (!moves)
      return;
    if (!obstacle.displacement.empty())
      {
        displacement = obstacle.displacement.vector(obstacle.centre, time);
        finite       = std::isfinite(displacement.norm());
      }
    double angle = 0;
    if (!obstacle.rotation.empty())
      angle = obstacle.rotation.value(obstacle.centre, time);
    finite   = finite && std::isfinite(angle);
    rotation = rotation_about<dim>(obstacle.axis, angle);
  }



  template <int dim>
  SignedDistance<dim>
  ObstaclePlace<dim>::distance(const Point<dim> &place) const
  {
    if (!moves)
      return *obstacle->shape->signed_distance(place);
    SignedDistance<dim> result =
      *obstacle->shape->signed_distance(start_of(place));
    result.normal = rotation * result.normal;
    return result;
  }



  template <int dim>
  Point<dim>
  ObstaclePlace<dim>::start_of(const Point<dim> &place) const
  {
    if (!moves)
      return place;
    return obstacle->centre +
           transpose(rotation) * (place - obstacle->centre - displacement);
  }



  template <int dim>
  Point<dim>
  ObstaclePlace<dim>::place_of(const Point<dim> &start) const
  {
    if (!moves)
      return start;
    return obstacle->centre + displacement +
           rotation * (start - obstacle->centre);
  }



  template <int dim>
  Point<dim>
  ObstaclePlace<dim>::centre() const
  {
    return obstacle->centre + displacement;
  }



  template <int dim>
  bool
  ObstaclePlace<dim>::is_finite() const
  {
    return finite;
  }



  template class ObstaclePlace<2>;
  template class ObstaclePlace<3>;
} // namespace limber
