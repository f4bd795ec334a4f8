// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/dual_domain.h>
#include <limber/interpolation/point_support.h>
#include <limber/time/point_deformation.h>
#include <limber/transfer/meeting_bodies.h>

namespace limber
{
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
  change_of_deformation(NodalFields<dim>                   &nodes,
                        const PointView<dim>               &points,
                        const unsigned int                  field,
                        const std::size_t                   p,
                        const StressSweep                  &what,
                        const std::vector<DualDomain<dim>> &mean_gradients)
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
    if (!mean_gradients.empty())
      {
        const double *const means = mean_gradients[field].data();
        const double        own =
          own_share<dim>(natural_place(points, grid.cells[points.cell[p]], p));
        velocity_gradient *= own;
        for (int i = 0; i < at.n; ++i)
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              velocity_gradient[d][e] +=
                (1 - own) * at.value[i] *
                means[at.node[i] * Mean::stride + Mean::tensor(d, e)];
      }
    dealii::Tensor<2, dim> change =
      what.step * velocity_gradient * pull_back(points, p);
    if (!points.in_initial_frame())
      change += what.square * change * change;
    return change;
  }



  template <int dim>
  void
  deform_surface(NodalFields<dim>                   &nodes,
                 const MaterialBody<dim>            &body,
                 const StressSweep                  &what,
                 const std::vector<DualDomain<dim>> &mean_gradients)
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
                        const std::vector<DualDomain<2>> &);
  template dealii::Tensor<2, 3>
  change_of_deformation(NodalFields<3> &,
                        const PointView<3> &,
                        unsigned int,
                        std::size_t,
                        const StressSweep &,
                        const std::vector<DualDomain<3>> &);
  template void
  deform_surface(NodalFields<2> &,
                 const MaterialBody<2> &,
                 const StressSweep &,
                 const std::vector<DualDomain<2>> &);
  template void
  deform_surface(NodalFields<3> &,
                 const MaterialBody<3> &,
                 const StressSweep &,
                 const std::vector<DualDomain<3>> &);
} // namespace limber
