// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_formula_shape_h
#define limber_problem_formula_shape_h

#include <limber/problem/box.h>

namespace limber
{
  /** Where a formula of x, y (, z) is positive, within a box. */
  template <int dim>
  class FormulaShape : public Shape<dim>
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "formula", *section = "Formula";
    static constexpr const char *text = "where a formula is positive";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    FormulaShape(const Formula<dim> &inside, const Corners<dim> &box);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

  private:
    Formula<dim>  inside;
    BoxShape<dim> box;
  };
} // namespace limber

#endif
