// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace limber
{
  using dealii::GeometryInfo;
  using dealii::Point;
  using dealii::QGauss;
  using dealii::Tensor;



  namespace
  {
    /** Clip a polygon by the half-plane sign * x_d <= sign * bound. */
    void
    cut_beyond(std::vector<Point<2>> &outline,
               const unsigned int     d,
               const double           sign,
               const double           bound)
    {
      std::vector<Point<2>> kept;
      for (std::size_t i = 0; i < outline.size(); ++i)
        {
          const Point<2> &a     = outline[i],
                         &b     = outline[(i + 1) % outline.size()];
          const double beyond_a = sign * (a[d] - bound),
                       beyond_b = sign * (b[d] - bound);
          if (beyond_a <= 0)
            kept.push_back(a);
          if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
            kept.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
        }
      outline = std::move(kept);
    }



    /**
     * Area and moments of a counterclockwise polygon, from a fan of triangles.
     */
    PartInside<2>
    enclosed_by(const std::vector<Point<2>> &outline)
    {
      PartInside<2> result;
      if (outline.size() < 3)
        return result;
      const Point<2> &first = outline.front();
      Tensor<1, 2>    moment;

      dealii::SymmetricTensor<2, 2> second_moment;
      for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        {
          const Tensor<1, 2> a = outline[i] - first, b = outline[i + 1] - first;
          const double       area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
          result.volume += area;
          moment += area / 3 * (a + b);
          for (const Tensor<1, 2> &c : {a, b, a + b})
            second_moment += area / 12 * symmetrize(outer_product(c, c));
        }
      if (result.volume > 0)
        {
          const Tensor<1, 2> centre = moment / result.volume;
          result.centroid           = first + centre;
          result.spread             = second_moment / result.volume -
                          symmetrize(outer_product(centre, centre));
        }
      return result;
    }
  } // namespace



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



  // The Jacobian determinant is at most quadratic in each coordinate, for which
  // two Gauss-Legendre points are exact.
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



  // Inverse mapping: Newton's method for the natural coordinates.
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
        // Far outside the block its map may fold.
        if (determinant(slopes) <= 0)
          return false;
        xi += invert(slopes) * miss;
      }
    return false;
  }



  // Clips its outline by one side of the box after the other (polygon clipping
  // of Sutherland and Hodgman 1974).
  template <int dim>
  std::optional<PartInside<dim>>
  BlockShape<dim>::inside_of(const Corners<dim> &box) const
  {
    if constexpr (dim == 2)
      {
        std::vector<Point<2>> outline = {vertices[0],
                                         vertices[1],
                                         vertices[3],
                                         vertices[2]};
        for (unsigned int d = 0; d < 2; ++d)
          {
            cut_beyond(outline, d, -1, box.first[d]);
            cut_beyond(outline, d, 1, box.second[d]);
          }
        return enclosed_by(outline);
      }
    else
      return std::nullopt;
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



  template <int dim>
  std::optional<SignedDistance<dim>>
  BlockShape<dim>::signed_distance(const Point<dim> &point) const
  {
    if constexpr (dim == 2)
      {
        std::array<std::array<Point<2>, 2>, 4> edges;
        constexpr unsigned int                 around[] = {0, 1, 3, 2, 0};
        for (unsigned int i = 0; i < 4; ++i)
          edges[i] = {{vertices[around[i]], vertices[around[i + 1]]}};
        return distance_from_edges(point, edges, [this](const Point<2> &place) {
          return contains(place);
        });
      }
    return std::nullopt; // faces may be curved
  }


  template <int dim>
  void
  BlockShape<dim>::declare(Parameters &parameters)
  {
    const std::string square[] = {"0, 0", "1, 0", "1, 1", "0, 1"};
    const Admissible  corner =
      admissible::numbers(dim, for_each_direction(dim, "0"));
    const std::size_t n = 1 << dim;

    std::vector<std::string> unit;
    for (unsigned int i = 0; i < n; ++i)
      unit.push_back(square[i % 4] + (dim == 2 ? "" : i < 4 ? ", 0" : ", 1"));
    parameters.declare(
      "Corners",
      join(unit, "; "),
      Admissible(
        [=](const std::string &value) {
          const auto parts = split(value, ';');
          return parts.size() == n && std::all_of(parts.begin(),
                                                  parts.end(),
                                                  [&](const std::string &part) {
                                                    return corner.match(part);
                                                  });
        },
        std::to_string(n) + " points of " + std::to_string(dim) +
          " numbers, separated by ';'",
        join(unit, "; ")),
      dim == 2 ?
        "Corners, m, counterclockwise. Face 'bottom' joins the first two, "
        "'right' the next, then 'top' and 'left'." :
        "Corners, m: those of face 'back', counterclockwise as seen from "
        "'front', then those of 'front' that are opposite to them. 'bottom' "
        "joins the first two, 'right' the next, then 'top' and 'left'.");
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  BlockShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const auto texts = split(scene.details.text("Corners"), ';');
    Vertices   vertices;
    for (unsigned int i = 0; i < vertices.size(); ++i)
      // deal.II counts vertices along the axes, not around.
      for (unsigned int d = 0; d < dim; ++d)
        vertices[i % 4 < 2 ? i : i ^ 1][d] =
          to_number(split(texts[i], ',')[d]).value();

    const auto shape = std::make_shared<BlockShape<dim>>(vertices);
    for (unsigned int i = 0; i < vertices.size(); ++i)
      if (determinant(
            shape->jacobian(GeometryInfo<dim>::unit_cell_vertex(i))) <= 0)
        throw InputError("The block in " + scene.details.where("Corners") +
                         " folds over at its corner " + to_text(vertices[i]) +
                         ". Usually the corners are in another order. Give "
                         "them counterclockwise, and none that points "
                         "inward.");
    return shape;
  }



  template class BlockShape<2>;
  template class BlockShape<3>;
} // namespace limber
