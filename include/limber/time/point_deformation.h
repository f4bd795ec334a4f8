// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_point_deformation_h
#define limber_time_point_deformation_h

#include <deal.II/base/tensor.h>

#include <limber/grid/nodal_fields.h>
#include <limber/state/material_body.h>
#include <limber/stress/stress_update.h>

/**
 * @file How the material at single points is deformed: for loads on faces, and
 * for surfaces that touch something. Sweeps over all points have faster ways.
 */
namespace limber
{
  /**
   * Takes a short vector at a point to what the gradients of the functions
   * have to meet: itself, or F^-1 of it in the initial frame.
   */
  template <int dim>
  dealii::Tensor<2, dim>
  pull_back(const PointView<dim> &points, std::size_t p);

  /**
   * f - 1 of a point of a body, with these points and nodal field, over
   * what.step, before it is moved: by the same velocity and square as the
   * stress; with @p mean_gradients of the dual domain method
   * (DualDomainLayout), if there are any.
   */
  template <int dim>
  dealii::Tensor<2, dim>
  change_of_deformation(NodalFields<dim>     &nodes,
                        const PointView<dim> &points,
                        unsigned int          field,
                        std::size_t           p,
                        const StressSweep    &what,
                        const double         *mean_gradients);

  /**
   * b becomes f b f^T at the points of a surface that keep it
   * (PointView::stretch).
   */
  template <int dim>
  void
  deform_surface(NodalFields<dim>        &nodes,
                 const MaterialBody<dim> &body,
                 const StressSweep       &what,
                 const double            *mean_gradients);

  /**
   * How much wider the material at a point is along a unit vector, between
   * surfaces across it, than at the start: sqrt(n . b . n), where b is that of
   * the initial frame, that which the point keeps, or what its law knows. What
   * flows without end comes between its points, and is never wider.
   */
  template <int dim>
  double
  stretch_along(const MaterialBody<dim>      &body,
                const PointView<dim>         &points,
                std::size_t                   p,
                const dealii::Tensor<1, dim> &direction);
} // namespace limber

#endif
