// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/union_of_shapes.h>

#include <algorithm>

namespace limber
{
  using dealii::Point;



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



  // The least distance from a part: exact outside; inside, where parts overlap,
  // the depth is underestimated.
  template <int dim>
  std::optional<SignedDistance<dim>>
  UnionShape<dim>::signed_distance(const Point<dim> &point) const
  {
    auto result = parts.front()->signed_distance(point);
    for (const auto &part : parts)
      {
        const auto other = part->signed_distance(point);
        if (!other)
          return std::nullopt;
        if (result && other->value < result->value)
          result = other;
      }
    return result;
  }



  template <int dim>
  bool
  UnionShape<dim>::is_round_about(const dealii::Point<dim>   &place,
                                  const dealii::Tensor<1, 3> &axis) const
  {
    return std::all_of(parts.begin(), parts.end(), [&](const auto &part) {
      return part->is_round_about(place, axis);
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



  template class UnionShape<2>;
  template class UnionShape<3>;
} // namespace limber
