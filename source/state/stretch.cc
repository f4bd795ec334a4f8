// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/state/stretch.h>
#include <limber/transfer/meeting_bodies.h>

#include <algorithm>
#include <cmath>

namespace limber
{
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
