// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_basis_functions_h
#define limber_interpolation_basis_functions_h

#include <limber/interpolation/basis.h>

#include <algorithm>
#include <array>

namespace limber
{
  namespace internal
  {
    /** One-dimensional values and slopes of the functions of a cell. */
    template <int dim>
    struct Factors
    {
      std::array<double, 4> value, slope;
    };

    template <int dim>
    Factors<dim>
    factors(const Linear<dim>, const CellGeometry<dim> &, int, const double xi)
    {
      return {{{1 - xi, xi}}, {{-1, 1}}};
    }

    template <int dim, int degree>
    Factors<dim>
    factors(const Spline<dim, degree>,
            const SplineCell<dim, degree> &nodes,
            const int                      d,
            const double                   xi)
    {
      const auto   w = Spline<dim, degree>::weights(nodes, d, xi);
      Factors<dim> result{};
      std::copy(w.value.begin(), w.value.end(), result.value.begin());
      std::copy(w.slope.begin(), w.slope.end(), result.slope.begin());
      return result;
    }
  } // namespace internal



  /**
   * Values and gradients (1/m) of the functions of a cell at natural
   * coordinates xi, for single points and a basis known at compile time.
   */
  template <class Basis>
  struct BasisFunctions
  {
    static constexpr int dim = Basis::dim;
    static constexpr int n   = Basis::n_nodes;

    BasisFunctions(const std::array<double, dim> &xi,
                   const GridView<dim>           &grid,
                   const std::uint32_t            cell)
      : xi(xi)
    {
      const auto &nodes = Basis::nodes_of(grid, cell);
      std::array<internal::Factors<dim>, dim> w;
      for (int d = 0; d < dim; ++d)
        w[d] = internal::factors(Basis(), nodes, d, xi[d]);
      for (int i = 0; i < n; ++i)
        {
          value[i] = 1;
          for (int d = 0; d < dim; ++d)
            value[i] *= w[d].value[Basis::power(i, d)];
          for (int d = 0; d < dim; ++d)
            {
              gradient[i][d] = grid.cells[cell].inverse_edge[d] *
                               w[d].slope[Basis::power(i, d)];
              for (int e = 0; e < dim; ++e)
                if (e != d)
                  gradient[i][d] *= w[e].value[Basis::power(i, e)];
            }
        }
    }

    std::array<double, dim>                xi;
    std::array<double, n>                  value;
    std::array<std::array<double, dim>, n> gradient;
  };
} // namespace limber

#endif
