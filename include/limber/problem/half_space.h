// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_half_space_h
#define limber_problem_half_space_h

#include <limber/problem/shape.h>

namespace limber
{
  /** A half-space, for obstacles only. */
  template <int dim>
  class HalfSpaceShape : public Shape<dim>
  {
  public:
    // As the scene knows it
    static constexpr const char *word = "half-space", *section = "Half-space";
    static constexpr const char *text =
      "all on one side of a line or plane; of obstacles";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    /** @p normal points out of it. */
    HalfSpaceShape(const dealii::Point<dim>     &place,
                   const dealii::Tensor<1, dim> &normal);

    bool
    contains(const dealii::Point<dim> &point) const override;

    /** Infinite. */
    Corners<dim>
    bounding_box() const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

  private:
    dealii::Point<dim>     place;
    dealii::Tensor<1, dim> normal; // of length 1
  };
} // namespace limber

#endif
