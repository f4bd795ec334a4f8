// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_support_h
#define limber_interpolation_support_h

#include <limber/interpolation/basis_functions.h>

namespace limber
{
  /**
   * The nodes whose functions do not vanish at a position, and these, for any
   * basis: for rare operations or few points. Sweeps over all points have
   * faster ways.
   */
  template <int dim>
  struct Support
  {
    static constexpr int most = Cubic<dim>::n_nodes;

    int                                       n = 0;    // of nodes
    std::array<std::uint32_t, most>           node;     // local numbers
    std::array<double, most>                  value;    // N_i
    std::array<std::array<double, dim>, most> gradient; // of N_i, 1/m
  };



  /**
   * At a position @p x in a cell, or near it by extrapolation of its
   * polynomials; optionally without gradients.
   */
  template <int dim, bool gradients = true>
  Support<dim>
  support_at(const GridView<dim>           &grid,
             const std::uint32_t            cell,
             const std::array<double, dim> &x)
  {
    return with_basis(grid, [&](const auto basis) {
      using Basis                       = std::decay_t<decltype(basis)>;
      const CellGeometry<dim> &geometry = grid.cells[cell];
      const auto              &nodes    = Basis::nodes_of(grid, cell);
      std::array<internal::Factors<dim>, dim> w;
      for (int d = 0; d < dim; ++d)
        w[d] = internal::factors(basis,
                                 nodes,
                                 d,
                                 (x[d] - geometry.origin[d]) *
                                   geometry.inverse_edge[d]);
      Support<dim> result;
      result.n = Basis::n_nodes;
#pragma GCC unroll 27
      for (int i = 0; i < Basis::n_nodes; ++i)
        {
          const auto value = [&](const int e) {
            return w[e].value[Basis::power(i, e)];
          };
          result.node[i]  = nodes.node[i] / NodeLayout<dim>::stride;
          result.value[i] = value(0) * value(1);
          if constexpr (dim == 3)
            result.value[i] *= value(2);
          if constexpr (gradients)
            for (int d = 0; d < dim; ++d)
              {
                result.gradient[i][d] =
                  geometry.inverse_edge[d] * w[d].slope[Basis::power(i, d)];
                for (int e = 0; e < dim; ++e)
                  if (e != d)
                    result.gradient[i][d] *= value(e);
              }
        }
      return result;
    });
  }
} // namespace limber

#endif
