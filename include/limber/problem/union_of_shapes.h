// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_union_of_shapes_h
#define limber_problem_union_of_shapes_h

#include <limber/problem/shape.h>

#include <vector>

namespace limber
{
  /** Everything that lies in at least one of the parts. */
  template <int dim>
  class UnionShape : public Shape<dim>
  {
  public:
    explicit UnionShape(
      const std::vector<std::shared_ptr<const Shape<dim>>> &parts);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    bool
    is_round_about(const dealii::Point<dim>   &place,
                   const dealii::Tensor<1, 3> &axis) const override;

  private:
    std::vector<std::shared_ptr<const Shape<dim>>> parts;
  };
} // namespace limber

#endif
