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



  template <int dim>
  void
  stretches_along(const MaterialBody<dim>               &body,
                  const PointView<dim>                  &points,
                  const std::size_t                      n,
                  const std::uint32_t *const             which,
                  const std::array<const double *, dim> &directions,
                  double *const                          result)
  {
    for (std::size_t k = 0; k < n; ++k)
      {
        dealii::Tensor<1, dim> direction;
        for (int d = 0; d < dim; ++d)
          direction[d] = directions[d][k];
        result[k] = stretch_along(body, points, which[k], direction);
      }
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
  template void
  stretches_along<2>(const MaterialBody<2> &,
                     const PointView<2> &,
                     std::size_t,
                     const std::uint32_t *,
                     const std::array<const double *, 2> &,
                     double *);
  template void
  stretches_along<3>(const MaterialBody<3> &,
                     const PointView<3> &,
                     std::size_t,
                     const std::uint32_t *,
                     const std::array<const double *, 3> &,
                     double *);
} // namespace limber
