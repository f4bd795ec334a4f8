// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/axis_ends.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

#include <cmath>

namespace limber
{
  namespace numbers = dealii::numbers;
  using dealii::Point;



  void
  declare_axis_ends(Parameters &parameters)
  {
    parameters.declare("Lower end",
                       "0",
                       admissible::number("0"),
                       "Coordinate along the axis where it begins, m.");
    parameters.declare("Upper end",
                       "1",
                       admissible::number("1"),
                       "Coordinate along the axis where it ends, m.");
  }



  std::pair<double, double>
  read_axis_ends(const Section &section, const std::string &shape)
  {
    const double lower = section.number("Lower end");
    const double upper = section.number("Upper end");
    if (upper <= lower)
      throw InputError("The " + shape + " ends at " + to_text(upper) +
                       ", not beyond its beginning at " + to_text(lower) +
                       ", in " + section.where("Upper end") +
                       ". Usually the ends are swapped. Give " +
                       to_text(lower + 1) + ", for instance.");
    return {lower, upper};
  }



  template <int dim>
  CylinderShape<dim>::CylinderShape(const unsigned int axis,
                                    const Point<dim>  &centre,
                                    const double       radius,
                                    const double       lower,
                                    const double       upper)
    : axis(axis)
    , centre(centre)
    , radius(radius)
    , lower(lower)
    , upper(upper)
  {}



  template <int dim>
  bool
  CylinderShape<dim>::contains(const Point<dim> &point) const
  {
    Point<dim> on_axis = centre;
    on_axis[axis]      = point[axis];
    return lower <= point[axis] && point[axis] <= upper &&
           point.distance_square(on_axis) <= radius * radius;
  }



  template <int dim>
  bool
  CylinderShape<dim>::is_round_about(const dealii::Point<dim>   &place,
                                     const dealii::Tensor<1, 3> &about) const
  {
    dealii::Tensor<1, dim> beside = place - centre;
    beside[axis]                  = 0;
    return std::abs(std::abs(about[axis]) - 1) <= 1e-12 &&
           beside.norm() <= 1e-12 * radius;
  }



  template <int dim>
  Corners<dim>
  CylinderShape<dim>::bounding_box() const
  {
    Corners<dim> box(centre, centre);
    for (unsigned int d = 0; d < dim; ++d)
      {
        box.first[d] -= radius;
        box.second[d] += radius;
      }
    box.first[axis]  = lower;
    box.second[axis] = upper;
    return box;
  }



  template <int dim>
  std::optional<double>
  CylinderShape<dim>::exact_volume() const
  {
    return numbers::PI * radius * radius * (upper - lower);
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  CylinderShape<dim>::signed_distance(const Point<dim> &point) const
  {
    Point<dim> on_axis = centre;
    on_axis[axis]      = point[axis];
    return distance_from_common_part(
      distance_from_ball(point, on_axis, radius),
      distance_from_slab(point, axis, lower, upper));
  }


  template <int dim>
  void
  CylinderShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("Axis",
                       "z",
                       admissible::one_of({"x", "y", "z"}),
                       "Direction of the axis.");
    parameters.declare("Centre",
                       for_each_direction(dim, "0.5"),
                       admissible::numbers(dim, for_each_direction(dim, "0.5")),
                       "A point of the axis, m.");
    parameters.declare("Radius",
                       "0.25",
                       admissible::positive_number("0.25"),
                       "Radius R, m.");
    declare_axis_ends(parameters);
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  CylinderShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Section &details = scene.details;
    if (dim == 2)
      throw InputError("A cylinder is asked for in " +
                       scene.owner.where("Shape") +
                       ", but the scene has two dimensions. Usually a disc "
                       "is meant. Write 'set Shape = ball' with its centre "
                       "and radius, or 'Dimension = 3'.");
    const auto [lower, upper] = read_axis_ends(details, "cylinder");
    const unsigned int axis   = details.text("Axis").front() - 'x';
    return std::make_shared<CylinderShape<dim>>(axis,
                                                read_point<dim>(details,
                                                                "Centre"),
                                                details.number("Radius"),
                                                lower,
                                                upper);
  }



  template class CylinderShape<2>;
  template class CylinderShape<3>;
} // namespace limber
