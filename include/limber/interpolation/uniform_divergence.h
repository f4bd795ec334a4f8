// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_uniform_divergence_h
#define limber_interpolation_uniform_divergence_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/linear.h>

#include <algorithm>

namespace limber
{
  /**
   * The correction w of a velocity v of linear functions, at natural
   * coordinates xi in a cell, such that v - w has the same normal components on
   * the faces and a uniform divergence, that of v at the centroid of the
   * points. In two dimensions, with the coefficient c^e of xi eta in v_e, m the
   * centroid and h the edges, it is
   *
   *   w_d = c^e h_d/h_e (xi_d - a_d)(xi_d - b_d)/2,  a_d <= xi_d <= b_d,
   *
   * where a_d + b_d = 2 m_d: the whole cell if the centroid is its centre, else
   * the interval around the centroid that starts at one of the faces; beyond it
   * w = 0. So div w is the deviation of div v from its mean where there is
   * material, and w is zero normal to the faces: nothing penetrates a side. In
   * three dimensions each c is taken at the position along the third direction,
   * for the trilinear term half way to the centroid.
   *
   * @p component(d) gives the monomial coefficients of component d, @p means
   * the mean of each monomial (CellMeans).
   */
  template <int dim, class Number, class Components, class Means>
  __attribute__((always_inline)) inline std::array<Number, dim>
  beyond_uniform_divergence(const Components              &component,
                            const CellGeometry<dim>       &cell,
                            const Means                   &means,
                            const std::array<Number, dim> &xi)
  {
    std::array<double, dim> mean;
    std::array<Number, dim> bubble, result{};
    for (int d = 0; d < dim; ++d)
      {
        mean[d]            = means[Linear<dim>::stride(d)];
        const double lower = std::max(0., 2 * mean[d] - 1),
                     upper = std::min(1., 2 * mean[d]);
        // positive outside of the interval, where it is set to zero
        bubble[d] =
          smaller((0.5 * (xi[d] - lower)) * (xi[d] - upper), Number{});
      }
    for (int e = 0; e < dim; ++e)
      for (int d = 0; d < dim; ++d)
        {
          if (d == e)
            continue;
          const auto   c     = component(e);
          const double ratio = cell.inverse_edge[e] / cell.inverse_edge[d];
          const int    pair  = Linear<dim>::stride(d) | Linear<dim>::stride(e);
          Number       scale = broadcast<Number>(c(pair));
          if constexpr (dim == 3)
            {
              const int third = 3 - d - e;
              scale +=
                (0.5 * c(Linear<dim>::n_nodes - 1)) * (xi[third] + mean[third]);
            }
          result[d] += ratio * (scale * bubble[d]);
        }
    return result;
  }
} // namespace limber

#endif
