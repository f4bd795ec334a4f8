// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_mean_gradients_h
#define limber_interpolation_mean_gradients_h

#include <limber/interpolation/cell_means.h>
#include <limber/interpolation/linear.h>

namespace limber
{
  /**
   * The mean over the points of a body in a cell of the gradients of the linear
   * functions, <grad N_a> for the corners a, 1/m: the B-bar row of the mean
   * divergence, whose transpose maps a mean pressure to the nodes (Treatment
   * `cell` in strain_operator.h).
   */
  template <int dim>
  std::array<std::array<double, dim>, 1 << dim>
  mean_gradients(const CellGeometry<dim>      &cell,
                 const CellMeans<Linear<dim>> &means)
  {
    // <xi_e> or <1 - xi_e>, by the end of corner a
    const auto factor = [&](const int a, const int e) {
      return a >> e & 1 ? means[1 << e] : 1 - means[1 << e];
    };
    std::array<std::array<double, dim>, 1 << dim> result;
    for (int a = 0; a < 1 << dim; ++a)
      for (int d = 0; d < dim; ++d)
        {
          const int e     = (d + 1) % dim;
          double    other = factor(a, e);
          if constexpr (dim == 3)
            {
              // the mean of a product is that of the factors plus a covariance
              const int    f = (d + 2) % dim;
              const double covariance =
                means[1 << e | 1 << f] - means[1 << e] * means[1 << f];
              const bool alike = (a >> e & 1) == (a >> f & 1);
              other = other * factor(a, f) + (alike ? covariance : -covariance);
            }
          result[a][d] = (a >> d & 1 ? other : -other) * cell.inverse_edge[d];
        }
    return result;
  }
} // namespace limber

#endif
