// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_point_deformation_h
#define limber_time_point_deformation_h

#include <limber/grid/nodal_fields.h>
#include <limber/state/stretch.h>
#include <limber/stress/stress_update.h>
#include <limber/time/dual_domain.h>

#include <vector>

/** @file Deformation of the material at single points: for loads on faces, and
 * for surfaces in contact. Sweeps over all points have faster ways. */
namespace limber
{
  /** Pulls a spatial vector at a point back to where the gradients of the shape
   * functions are evaluated: itself, or F^-1 of it in the initial frame. */
  template <int dim>
  dealii::Tensor<2, dim>
  pull_back(const PointView<dim> &points, std::size_t p);

  /**
   * Increment f - 1 of the deformation gradient of a point of a body, with
   * these points and nodal field, over what.step, before it is moved: by the
   * same velocity and second-order term (StressSweep::square) as the stress;
   * with @p mean_gradients of the dual domain method, by nodal field, if there
   * are any.
   */
  template <int dim>
  dealii::Tensor<2, dim>
  change_of_deformation(NodalFields<dim>                   &nodes,
                        const PointView<dim>               &points,
                        unsigned int                        field,
                        std::size_t                         p,
                        const StressSweep                  &what,
                        const std::vector<DualDomain<dim>> &mean_gradients);

  /** Update the left Cauchy-Green tensor, b becomes f b f^T, at the points of a
   * surface that keep it (PointView::stretch). */
  template <int dim>
  void
  deform_surface(NodalFields<dim>                   &nodes,
                 const MaterialBody<dim>            &body,
                 const StressSweep                  &what,
                 const std::vector<DualDomain<dim>> &mean_gradients);
} // namespace limber

#endif
