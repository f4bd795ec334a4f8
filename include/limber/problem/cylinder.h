// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_cylinder_h
#define limber_problem_cylinder_h

#include <limber/problem/shape.h>

namespace limber
{
  /**
   * Circular cylinder along an axis of coordinates, from @p lower to @p upper
   * on it. Scenes offer it in three dimensions only.
   */
  template <int dim>
  class CylinderShape : public Shape<dim>
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "cylinder", *section = "Cylinder";
    static constexpr const char *text = "along x, y or z; only in 3D";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    CylinderShape(const unsigned int        axis,
                  const dealii::Point<dim> &centre,
                  const double              radius,
                  const double              lower,
                  const double              upper);

    bool
    contains(const dealii::Point<dim> &point) const override;

    std::optional<SignedDistance<dim>>
    signed_distance(const dealii::Point<dim> &point) const override;

    Corners<dim>
    bounding_box() const override;

    bool
    is_round_about(const dealii::Point<dim>   &place,
                   const dealii::Tensor<1, 3> &axis) const override;

    std::optional<double>
    exact_volume() const override;

  private:
    unsigned int       axis;
    dealii::Point<dim> centre; // its component along the axis is not used
    double             radius, lower, upper;
  };
} // namespace limber

#endif
