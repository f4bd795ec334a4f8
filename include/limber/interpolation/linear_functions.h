// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_linear_functions_h
#define limber_interpolation_linear_functions_h

#include <limber/grid/grid_view.h>

#include <array>

namespace limber
{
  /**
   * Values and gradients (1/m) of the linear functions of a cell at the
   * natural coordinates xi, where both are wanted for one point at a time.
   */
  template <int dim>
  struct LinearFunctions
  {
    static constexpr int n = 1 << dim;

    LinearFunctions(const std::array<double, dim> &xi,
                    const CellGeometry<dim>       &cell)
      : xi(xi)
    {
      for (int i = 0; i < n; ++i)
        {
          std::array<double, dim> factor;
          value[i] = 1;
          for (int d = 0; d < dim; ++d)
            {
              factor[d] = (i >> d & 1) != 0 ? xi[d] : 1 - xi[d];
              value[i] *= factor[d];
            }
          for (int d = 0; d < dim; ++d)
            {
              gradient[i][d] = (i >> d & 1) != 0 ? cell.inverse_edge[d] :
                                                   -cell.inverse_edge[d];
              for (int e = 0; e < dim; ++e)
                if (e != d)
                  gradient[i][d] *= factor[e];
            }
        }
    }

    std::array<double, dim>                xi;
    std::array<double, n>                  value;
    std::array<std::array<double, dim>, n> gradient;
  };
} // namespace limber

#endif
