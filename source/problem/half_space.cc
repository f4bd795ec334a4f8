// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_parts.h>

#include <limits>

namespace limber
{
  using dealii::Point;
  using dealii::Tensor;



  template <int dim>
  HalfSpaceShape<dim>::HalfSpaceShape(const Point<dim>     &place,
                                      const Tensor<1, dim> &normal)
    : place(place)
    , normal(normal / normal.norm())
  {}



  template <int dim>
  bool
  HalfSpaceShape<dim>::contains(const Point<dim> &point) const
  {
    return (point - place) * normal <= 0;
  }



  template <int dim>
  Corners<dim>
  HalfSpaceShape<dim>::bounding_box() const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Corners<dim>     box;
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.first[d]  = -infinity;
        box.second[d] = infinity;
      }
    return box;
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  HalfSpaceShape<dim>::signed_distance(const Point<dim> &point) const
  {
    return SignedDistance<dim>{(point - place) * normal, normal};
  }



  template <int dim>
  void
  HalfSpaceShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("Point",
                       for_each_direction(dim, "0"),
                       admissible::numbers(dim, for_each_direction(dim, "0")),
                       "A place of its surface, m.");
    parameters.declare("Normal",
                       dim == 2 ? "0, 1" : "0, 0, 1",
                       admissible::numbers(dim, dim == 2 ? "0, 1" : "0, 0, 1"),
                       "Direction out of it, of any length.");
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  HalfSpaceShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Tensor<1, dim> normal = read_point<dim>(scene.details, "Normal");
    if (!(normal.norm() > 0))
      throw InputError("The normal " + scene.details.text("Normal") + " in " +
                       scene.details.where("Normal") +
                       " has no length. Usually an angle was mistyped. Give a "
                       "direction, for instance '0, 1'.");
    return std::make_shared<HalfSpaceShape<dim>>(read_point<dim>(scene.details,
                                                                 "Point"),
                                                 normal);
  }



  template class HalfSpaceShape<2>;
  template class HalfSpaceShape<3>;
} // namespace limber
