// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

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
