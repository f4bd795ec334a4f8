// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_flow_rates_h
#define limber_materials_flow_rates_h

#include <limber/materials/further_deformation.h>

namespace limber
{
  /**
   * The algorithmic tangent of a plastic law, consistent with its return
   * mapping: derivatives of the stress at the end of a step with respect to the
   * deformation in it. By central differences, as the return map has many
   * branches; at the border of two their mean results. Stress is Kirchhoff's;
   * the slope is minus the Kirchhoff pressure over the growth of the volume in
   * the step, the derivative of the energy by that growth.
   */
  template <int dim>
  struct FlowRates
  {
    // Lie derivative of the deviator by the strain along (k, l) at constant
    // volume, Pa: entry [d, e][k, l]
    std::array<std::array<double, dim * dim>, std::size_t(dim *dim)> deviator{};
    SquareMatrix<dim> slope{};       // of the slope by that strain, Pa
    SquareMatrix<dim> by_growth{};   // of the deviator by the growth, Pa
    double            curvature = 0; // of the slope by the growth, Pa
  };



  /**
   * At the end of the motion f from @p start, in which the volume grew by the
   * factor @p growth.
   */
  template <int dim, class Law>
  FlowRates<dim>
  flow_rates(const FurtherDeformation<Law>                   &law,
             const typename Law::template State<dim, double> &start,
             const SquareMatrix<dim>                         &f,
             const double                                     growth)
  {
    constexpr double difference = 1e-7;
    using State                 = typename Law::template State<dim, double>;

    // the state if f is followed by the strain size e, and the growth by 1 +
    // share
    const auto perturbed =
      [&](const SquareMatrix<dim> &e, const double size, const double share) {
        SquareMatrix<dim> g = f;
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            for (int b = 0; b < dim; ++b)
              g[c][d] += size * e[c][b] * f[b][d];
        State state = start;
        law.template deform<dim>(g, growth * (1 + share), state);
        return state;
      };

    FlowRates<dim> result;
    State          reached = start;
    law.template deform<dim>(f, growth, reached);
    const auto own = rows_of<dim>(reached.deviator);
    for (int k = 0; k < dim; ++k)
      for (int l = 0; l <= k; ++l)
        {
          SquareMatrix<dim> e{};
          e[k][l] += 0.5;
          e[l][k] += 0.5;
          const State more   = perturbed(e, difference, 0),
                      less   = perturbed(e, -difference, 0);
          const auto ahead   = rows_of<dim>(more.deviator),
                     back    = rows_of<dim>(less.deviator);
          const double third = k == l ? 1. / 3 : 0.;
          for (int c = 0; c < dim; ++c)
            for (int d = 0; d < dim; ++d)
              {
                double rate = (ahead[c][d] - back[c][d]) / (2 * difference) +
                              2 * law.stiffness_at_apex() *
                                (e[c][d] - (c == d ? third : 0.));
                for (int b = 0; b < dim; ++b)
                  rate -= e[c][b] * own[b][d] + own[c][b] * e[d][b];
                result.deviator[c * dim + d][k * dim + l] =
                  result.deviator[c * dim + d][l * dim + k] = rate;
              }
          result.slope[k][l] = result.slope[l][k] =
            (less.pressure - more.pressure) / (2 * difference * growth);
        }

    const State more   = perturbed({}, 0, difference),
                less   = perturbed({}, 0, -difference);
    const double scale = 1 / (2 * difference * growth);
    const auto   ahead = rows_of<dim>(more.deviator),
               back    = rows_of<dim>(less.deviator);
    for (int c = 0; c < dim; ++c)
      for (int d = 0; d < dim; ++d)
        result.by_growth[c][d] = (ahead[c][d] - back[c][d]) * scale;
    result.curvature = (less.pressure / (growth * (1 - difference)) -
                        more.pressure / (growth * (1 + difference))) *
                       scale;
    return result;
  }
} // namespace limber

#endif
