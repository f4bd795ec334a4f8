// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>

#include <limber/problem/shapes.h>

#include <algorithm>

namespace limber
{
  using dealii::GeometryInfo;
  namespace numbers = dealii::numbers;
  using dealii::Point;
  using dealii::QGauss;
  using dealii::Tensor;



  template <int dim>
  BlockShape<dim>::BlockShape(const Vertices &vertices)
    : vertices(vertices)
  {}



  template <int dim>
  Point<dim>
  BlockShape<dim>::place(const Point<dim> &xi) const
  {
    Point<dim> result;
    for (unsigned int i = 0; i < vertices.size(); ++i)
      result += GeometryInfo<dim>::d_linear_shape_function(xi, i) * vertices[i];
    return result;
  }



  template <int dim>
  Tensor<2, dim>
  BlockShape<dim>::jacobian(const Point<dim> &xi) const
  {
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < vertices.size(); ++i)
      result +=
        outer_product(vertices[i],
                      GeometryInfo<dim>::d_linear_shape_function_gradient(xi,
                                                                          i));
    return result;
  }



  // The determinant is at most quadratic in each coordinate, where two points
  // of Gauss and Legendre are exact.
  template <int dim>
  double
  BlockShape<dim>::volume(const Corners<dim> &part) const
  {
    static const QGauss<dim> gauss(2);
    double                   result = 0, edges = 1;
    for (unsigned int d = 0; d < dim; ++d)
      edges *= part.second[d] - part.first[d];
    for (unsigned int q = 0; q < gauss.size(); ++q)
      {
        Point<dim> xi = part.first;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] += gauss.point(q)[d] * (part.second[d] - part.first[d]);
        result += gauss.weight(q) * edges * determinant(jacobian(xi));
      }
    return result;
  }



  // Newton's method for the natural coordinates.
  template <int dim>
  bool
  BlockShape<dim>::contains(const Point<dim> &point) const
  {
    const double size      = vertices.front().distance(vertices.back());
    const double tolerance = 1e-12;
    Point<dim>   xi;
    for (unsigned int d = 0; d < dim; ++d)
      xi[d] = 0.5;
    for (unsigned int n = 0; n < 30; ++n)
      {
        const Tensor<1, dim> miss   = point - place(xi);
        const Tensor<2, dim> slopes = jacobian(xi);
        if (miss.norm() < tolerance * size)
          {
            for (unsigned int d = 0; d < dim; ++d)
              if (xi[d] < -tolerance || xi[d] > 1 + tolerance)
                return false;
            return true;
          }
        // Far outside, the map may fold.
        if (determinant(slopes) <= 0)
          return false;
        xi += invert(slopes) * miss;
      }
    return false;
  }



  template <int dim>
  Corners<dim>
  BlockShape<dim>::bounding_box() const
  {
    Corners<dim> box(vertices.front(), vertices.front());
    for (const Point<dim> &vertex : vertices)
      for (unsigned int d = 0; d < dim; ++d)
        {
          box.first[d]  = std::min(box.first[d], vertex[d]);
          box.second[d] = std::max(box.second[d], vertex[d]);
        }
    return box;
  }



  template <int dim>
  std::optional<double>
  BlockShape<dim>::exact_volume() const
  {
    Point<dim> upper;
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] = 1;
    return volume({Point<dim>(), upper});
  }



  namespace
  {
    template <int dim>
    typename BlockShape<dim>::Vertices
    vertices_of_box(const Point<dim> &lower, const Point<dim> &upper)
    {
      typename BlockShape<dim>::Vertices result;
      for (unsigned int i = 0; i < result.size(); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          result[i][d] = i >> d & 1 ? upper[d] : lower[d];
      return result;
    }
  } // namespace



  template <int dim>
  BoxShape<dim>::BoxShape(const Point<dim> &lower, const Point<dim> &upper)
    : BlockShape<dim>(vertices_of_box(lower, upper))
    , lower(lower)
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
  std::optional<double>
  BallShape<dim>::exact_volume() const
  {
    return numbers::PI *
           (dim == 2 ? radius * radius : 4. / 3 * radius * radius * radius);
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
  std::optional<double>
  CylinderShape<dim>::exact_volume() const
  {
    return numbers::PI * radius * radius * (upper - lower);
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



  template class BlockShape<2>;
  template class BlockShape<3>;
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
