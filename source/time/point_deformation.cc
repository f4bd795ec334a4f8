// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/interpolation/dual_domain.h>
#include <limber/interpolation/point_support.h>
#include <limber/time/point_deformation.h>
#include <limber/transfer/meeting_bodies.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
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



    template <int dim>
    dealii::SymmetricTensor<2, dim>
    kept_stretch(const PointView<dim> &points, const std::size_t p)
    {
      dealii::SymmetricTensor<2, dim> b;
      for (unsigned int k = 0; k < points.stretch.size(); ++k)
        b.access_raw_entry(k) = points.stretch[k][p];
      return b;
    }
  } // namespace



  template <int dim>
  dealii::Tensor<2, dim>
  pull_back(const PointView<dim> &points, const std::size_t p)
  {
    if (points.in_initial_frame())
      return invert(deformation_gradient(points, p));
    return dealii::Tensor<2, dim>(dealii::unit_symmetric_tensor<dim>());
  }



  template <int dim>
  dealii::Tensor<2, dim>
  change_of_deformation(NodalFields<dim>     &nodes,
                        const PointView<dim> &points,
                        const unsigned int    field,
                        const std::size_t     p,
                        const StressSweep    &what,
                        const double *const   mean_gradients)
  {
    using Mean               = DualDomainLayout<dim>;
    const GridView<dim> grid = nodes.view();
    const unsigned int  slot =
      what.remapped ? NodeLayout<dim>::remapped : NodeLayout<dim>::velocity;
    const Support<dim>     at = support_of_point<dim>(grid, points, p);
    dealii::Tensor<2, dim> velocity_gradient;
    for (int i = 0; i < at.n; ++i)
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          velocity_gradient[d][e] +=
            nodes.record(field, at.node[i])[slot + d] * at.gradient[i][e];
    if (mean_gradients != nullptr)
      {
        const double own =
          own_share<dim>(natural_place(points, grid.cells[points.cell[p]], p));
        velocity_gradient *= own;
        for (int i = 0; i < at.n; ++i)
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              velocity_gradient[d][e] +=
                (1 - own) * at.value[i] *
                mean_gradients[at.node[i] * Mean::stride + Mean::tensor(d, e)];
      }
    dealii::Tensor<2, dim> change =
      what.step * velocity_gradient * pull_back(points, p);
    if (!points.in_initial_frame())
      change += what.square * change * change;
    return change;
  }



  template <int dim>
  void
  deform_surface(NodalFields<dim>        &nodes,
                 const MaterialBody<dim> &body,
                 const StressSweep       &what,
                 const double *const      mean_gradients)
  {
    const PointView<dim> points = body.points.view();
    if (!points.keeps_stretch())
      return;
    for (std::size_t p = 0; p < points.size; ++p)
      if (is_at_surface(points, p))
        {
          const dealii::Tensor<2, dim> f =
            change_of_deformation(nodes,
                                  points,
                                  body.description.nodal_field,
                                  p,
                                  what,
                                  mean_gradients) +
            dealii::unit_symmetric_tensor<dim>();
          const dealii::SymmetricTensor<2, dim> b = symmetrize(
            f * dealii::Tensor<2, dim>(kept_stretch(points, p)) * transpose(f));
          for (unsigned int k = 0; k < points.stretch.size(); ++k)
            points.stretch[k][p] = b.access_raw_entry(k);
        }
  }



  template <int dim>
  double
  stretch_along(const MaterialBody<dim>      &body,
                const PointView<dim>         &points,
                const std::size_t             p,
                const dealii::Tensor<1, dim> &direction)
  {
    if (points.in_initial_frame())
      return (direction * deformation_gradient(points, p)).norm();
    if (points.keeps_stretch() && is_at_surface(points, p))
      {
        const double stretch =
          std::sqrt(direction * (kept_stretch(points, p) * direction));
        return body.description.keeps_surface ? stretch : std::min(stretch, 1.);
      }
    std::array<double, dim> n;
    store_vector<dim>(direction, n.data());
    return body.stress->stretch_along(points, p, n);
  }



  template dealii::Tensor<2, 2>
  pull_back(const PointView<2> &, std::size_t);
  template dealii::Tensor<2, 3>
  pull_back(const PointView<3> &, std::size_t);
  template dealii::Tensor<2, 2>
  change_of_deformation(NodalFields<2> &,
                        const PointView<2> &,
                        unsigned int,
                        std::size_t,
                        const StressSweep &,
                        const double *);
  template dealii::Tensor<2, 3>
  change_of_deformation(NodalFields<3> &,
                        const PointView<3> &,
                        unsigned int,
                        std::size_t,
                        const StressSweep &,
                        const double *);
  template void
  deform_surface(NodalFields<2> &,
                 const MaterialBody<2> &,
                 const StressSweep &,
                 const double *);
  template void
  deform_surface(NodalFields<3> &,
                 const MaterialBody<3> &,
                 const StressSweep &,
                 const double *);
  template double
  stretch_along(const MaterialBody<2> &,
                const PointView<2> &,
                std::size_t,
                const dealii::Tensor<1, 2> &);
  template double
  stretch_along(const MaterialBody<3> &,
                const PointView<3> &,
                std::size_t,
                const dealii::Tensor<1, 3> &);
} // namespace limber
