// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

namespace limber
{
  namespace numbers = dealii::numbers;
  using dealii::Point;



  template <int dim>
  BallShape<dim>::BallShape(const Point<dim> &centre, const double radius)
    : centre(centre)
    , radius(radius)
  {}



  template <int dim>
  bool
  BallShape<dim>::contains(const Point<dim> &point) const
  {
    return point.distance_square(centre) <= radius * radius;
  }



  template <int dim>
  bool
  BallShape<dim>::is_round_about(const dealii::Point<dim> &place,
                                 const dealii::Tensor<1, 3> & /*axis*/) const
  {
    return place.distance(centre) <= 1e-12 * radius;
  }



  template <int dim>
  Corners<dim>
  BallShape<dim>::bounding_box() const
  {
    Corners<dim> box(centre, centre);
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.first[d] -= radius;
        box.second[d] += radius;
      }
    return box;
  }



  template <int dim>
  std::optional<double>
  BallShape<dim>::exact_volume() const
  {
    return numbers::PI *
           (dim == 2 ? radius * radius : 4. / 3 * radius * radius * radius);
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  BallShape<dim>::signed_distance(const Point<dim> &point) const
  {
    return distance_from_ball(point, centre, radius);
  }


  template <int dim>
  void
  BallShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("Centre",
                       for_each_direction(dim, "0.5"),
                       admissible::numbers(dim, for_each_direction(dim, "0.5")),
                       "Centre of the ball, m.");
    parameters.declare("Radius",
                       "0.25",
                       admissible::positive_number("0.25"),
                       "Radius R, m.");
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  BallShape<dim>::read(const ShapeSections<dim> &scene)
  {
    return std::make_shared<BallShape<dim>>(read_point<dim>(scene.details,
                                                            "Centre"),
                                            scene.details.number("Radius"));
  }



  template class BallShape<2>;
  template class BallShape<3>;
} // namespace limber
