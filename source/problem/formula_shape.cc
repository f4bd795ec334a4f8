// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

namespace limber
{
  using dealii::Point;



  template <int dim>
  FormulaShape<dim>::FormulaShape(const Formula<dim> &inside,
                                  const Corners<dim> &box)
    : inside(inside)
    , box(box.first, box.second)
  {}



  template <int dim>
  bool
  FormulaShape<dim>::contains(const Point<dim> &point) const
  {
    return box.contains(point) && inside.value(point, 0.) > 0;
  }



  template <int dim>
  Corners<dim>
  FormulaShape<dim>::bounding_box() const
  {
    return box.bounding_box();
  }



  // Value over gradient: a signed distance of first order, exact where the
  // formula is linear across the surface.
  template <int dim>
  std::optional<SignedDistance<dim>>
  FormulaShape<dim>::signed_distance(const Point<dim> &point) const
  {
    const double        reach = 1e-5 * box.lower.distance(box.upper);
    SignedDistance<dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      {
        Point<dim> before = point, after = point;
        before[d] -= reach;
        after[d] += reach;
        result.normal[d] =
          (inside.value(before, 0.) - inside.value(after, 0.)) / (2 * reach);
      }
    const double slope = result.normal.norm();
    if (!(slope > 0))
      return SignedDistance<dim>{inside.value(point, 0.) > 0 ? -1e300 : 1e300,
                                 {}};
    result.value = -inside.value(point, 0.) / slope;
    result.normal /= slope;
    const auto around = box.signed_distance(point);
    return around->value > result.value ? around : result;
  }



  template <int dim>
  void
  FormulaShape<dim>::declare(Parameters &parameters)
  {
    const std::string variables = dim == 2 ? "x, y" : "x, y, z";
    parameters.declare("Inside",
                       "",
                       admissible::text("formula of " + variables +
                                          ", or empty",
                                        "1 - x^2 - y^2"),
                       "The shape is where this is positive.");
    for (const std::string corner : {"Lower corner", "Upper corner"})
      parameters.declare(
        corner,
        "",
        admissible::numbers(dim, for_each_direction(dim, "0")).or_empty(),
        "Corner of a box around the shape, m; empty: that "
        "of the grid.");
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  FormulaShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const Corners<dim> box = read_corners(scene.details, scene.grid);
    return std::make_shared<FormulaShape<dim>>(
      read_formula(scene.details, "Inside", 1, scene.constants, box), box);
  }



  template class FormulaShape<2>;
  template class FormulaShape<3>;
} // namespace limber
