// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/signed_distance.h>

#include <algorithm>

namespace limber
{
  using dealii::Point;



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
  std::optional<PartInside<dim>>
  BoxShape<dim>::inside_of(const Corners<dim> &box) const
  {
    PartInside<dim> result{1, {}, {}};
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double first  = std::max(lower[d], box.first[d]);
        const double second = std::min(upper[d], box.second[d]);
        result.volume *= std::max(0., second - first);
        result.centroid[d]  = 0.5 * (first + second);
        result.spread[d][d] = (second - first) * (second - first) / 12;
      }
    return result;
  }



  template <int dim>
  std::optional<SignedDistance<dim>>
  BoxShape<dim>::signed_distance(const Point<dim> &point) const
  {
    auto result = distance_from_slab(point, 0, lower[0], upper[0]);
    for (unsigned int d = 1; d < dim; ++d)
      result = distance_from_common_part(
        result, distance_from_slab(point, d, lower[d], upper[d]));
    return result;
  }


  template <int dim>
  void
  BoxShape<dim>::declare(Parameters &parameters)
  {
    parameters.declare("Lower corner",
                       for_each_direction(dim, "0"),
                       admissible::numbers(dim, for_each_direction(dim, "0")),
                       "Corner with the smallest coordinates, m.");
    parameters.declare("Upper corner",
                       for_each_direction(dim, "1"),
                       admissible::numbers(dim, for_each_direction(dim, "1")),
                       "The opposite corner, m.");
  }



  template <int dim>
  std::shared_ptr<const Shape<dim>>
  BoxShape<dim>::read(const ShapeSections<dim> &scene)
  {
    const auto box = read_corners(scene.details, scene.grid);
    return std::make_shared<BoxShape<dim>>(box.first, box.second);
  }



  template class BoxShape<2>;
  template class BoxShape<3>;
} // namespace limber
