// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_ball_h
#define limber_problem_ball_h

#include <limber/problem/shape.h>

namespace limber
{
  /** Disc in two dimensions, ball in three. */
  template <int dim>
  class BallShape : public Shape<dim>
  {
  public:
    // Word, section and help text in the scene, see ShapeList
    static constexpr const char *word = "ball", *section = "Ball";
    static constexpr const char *text = "disc or ball, by centre and radius";

    static void
    declare(Parameters &parameters);

    static std::shared_ptr<const Shape<dim>>
    read(const ShapeSections<dim> &scene);

    BallShape(const dealii::Point<dim> &centre, const double radius);

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
    dealii::Point<dim> centre;
    double             radius;
  };
} // namespace limber

#endif
