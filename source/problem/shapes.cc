// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/shapes.h>

#include <algorithm>

namespace limber
{
  using dealii::Point;



  template <int dim>
  BoxShape<dim>::BoxShape(const Point<dim> &lower, const Point<dim> &upper)
    : lower(lower)
    , upper(upper)
  {}



  template <int dim>
  bool
  BoxShape<dim>::contains(const Point<dim> &point) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (point[d] < lower[d] || point[d] > upper[d])
        return false;
    return true;
  }



  template <int dim>
  Corners<dim>
  BoxShape<dim>::bounding_box() const
  {
    return {lower, upper};
  }



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
  Corners<dim>
  CylinderShape<dim>::bounding_box() const
  {
    Corners<dim> box = BallShape<dim>(centre, radius).bounding_box();
    box.first[axis]  = lower;
    box.second[axis] = upper;
    return box;
  }



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
  UnionShape<dim>::UnionShape(
    const std::vector<std::shared_ptr<const Shape<dim>>> &parts)
    : parts(parts)
  {
    Assert(!parts.empty(), dealii::ExcMessage("A union needs parts."));
  }



  template <int dim>
  bool
  UnionShape<dim>::contains(const Point<dim> &point) const
  {
    return std::any_of(parts.begin(), parts.end(), [&](const auto &part) {
      return part->contains(point);
    });
  }



  template <int dim>
  Corners<dim>
  UnionShape<dim>::bounding_box() const
  {
    Corners<dim> box = parts.front()->bounding_box();
    for (const auto &part : parts)
      {
        const Corners<dim> other = part->bounding_box();
        for (unsigned int d = 0; d < dim; ++d)
          {
            box.first[d]  = std::min(box.first[d], other.first[d]);
            box.second[d] = std::max(box.second[d], other.second[d]);
          }
      }
    return box;
  }



  template class BoxShape<2>;
  template class BoxShape<3>;
  template class BallShape<2>;
  template class BallShape<3>;
  template class CylinderShape<2>;
  template class CylinderShape<3>;
  template class FormulaShape<2>;
  template class FormulaShape<3>;
  template class UnionShape<2>;
  template class UnionShape<3>;
} // namespace limber
