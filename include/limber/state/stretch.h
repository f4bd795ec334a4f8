// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_stretch_h
#define limber_state_stretch_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <limber/state/material_body.h>

/** @file How far the material at single points is deformed. */
namespace limber
{
  /** F of a point in the initial frame (PointView::in_initial_frame). */
  template <int dim>
  dealii::Tensor<2, dim>
  deformation_gradient(const PointView<dim> &points, const std::size_t p)
  {
    dealii::Tensor<2, dim> F;
    for (int d = 0; d < dim; ++d)
      for (int e = 0; e < dim; ++e)
        F[d][e] = points.deformation[d * dim + e][p];
    return F;
  }



  /** b of a point that keeps it (PointView::keeps_stretch). */
  template <int dim>
  dealii::SymmetricTensor<2, dim>
  kept_stretch(const PointView<dim> &points, const std::size_t p)
  {
    dealii::SymmetricTensor<2, dim> b;
    for (unsigned int k = 0; k < points.stretch.size(); ++k)
      b.access_raw_entry(k) = points.stretch[k][p];
    return b;
  }



  /**
   * Stretch of the material at a point along a unit vector, between surfaces
   * across it: sqrt(n . b . n), where b is that of the initial frame, that
   * which the point keeps, or what its law knows. Where other points come
   * between those of the surface, as in granular flow, it is at most 1.
   */
  template <int dim>
  double
  stretch_along(const MaterialBody<dim>      &body,
                const PointView<dim>         &points,
                std::size_t                   p,
                const dealii::Tensor<1, dim> &direction);



  /** The same for n points, @p which of the body; directions by component. */
  template <int dim>
  void
  stretches_along(const MaterialBody<dim>               &body,
                  const PointView<dim>                  &points,
                  std::size_t                            n,
                  const std::uint32_t                   *which,
                  const std::array<const double *, dim> &directions,
                  double                                *result);
} // namespace limber

#endif
