// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_box_h
#define limber_problem_box_h

#include <limber/problem/block.h>

namespace limber
{
  /** A block between two corners, along the axes. */
  template <int dim>
  class BoxShape : public BlockShape<dim>
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "box", *section = "Box";
    static constexpr const char *text = "between two corners";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    BoxShape(const dealii::Point<dim> &lower, const dealii::Point<dim> &upper);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<PartInside<dim>>
    inside_of(const Corners<dim> &box) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    const dealii::Point<dim> lower, upper;
  };
} // namespace limber

#endif
