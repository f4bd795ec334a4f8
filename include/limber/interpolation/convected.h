// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_h
#define limber_interpolation_convected_h

#include <limber/base/expected.h>
#include <limber/base/small_matrix.h>
#include <limber/interpolation/linear.h>
#include <limber/points/point_view.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  /**
   * The convected domain of a point (CPDI; Sadeghirad, Brannon and Burghardt,
   * IJNME 86 (2011) 1435-1456): the parallelogram or parallelepiped around it
   * with the half edges r_k, the columns of R, which are carried along by the
   * grid. Its corners are x_c = x + R s_c with signs s_c. The functions of the
   * point are means over it of those of the grid, interpolated from the
   * corners,
   *
   *   N_i = 2^-d sum_c N_i(x_c),   grad N_i = 2^-d sum_c N_i(x_c) R^-T s_c,
   *
   * so that a field u of the grid has at the point, with its values u_c at the
   * corners,
   *
   *   u = 2^-d sum_c u_c,   grad u = sum_k u,k R^-1_k,   u,k = 2^-d sum_c s_ck
   *   u_c.
   *
   * They see the linear functions of the cells in which the corners are, looked
   * up one by one: a stencil of each point's own.
   *
   * Rules. Along each axis a domain counts for no more than a cell on either
   * side of its point; what is longer is shortened to that. One that has turned
   * inside out, or is flatter than a thousandth, counts as the box around it. A
   * corner outside the grid counts in its side.
   */
  template <int dim>
  class ConvectedDomain
  {
  public:
    static constexpr int    n_corners = 1 << dim;
    static constexpr double share     = 1. / n_corners; // of a corner
    using Matrix                      = SmallMatrix<dim, double>;

    struct Corner
    {
      std::uint32_t               cell;
      typename Linear<dim>::Nodes weights; // N_i(x_c) of its nodes
    };

    /** Of point p, which is in @p cell. */
    __attribute__((always_inline)) ConvectedDomain(const PointView<dim> &points,
                                                   const GridView<dim>  &grid,
                                                   const std::uint32_t   cell,
                                                   const std::size_t     p)
    {
      const CellGeometry<dim> &home = grid.cells[cell];
      Matrix                   R;
      std::array<double, dim>  place, extent; // of the box around the domain
      bool                     at_home = true;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          place[d]  = points.position[d][p];
          extent[d] = 0;
#pragma GCC unroll 8
          for (int k = 0; k < dim; ++k)
            {
              R[d][k] = points.domain[d * dim + k][p];
              extent[d] += std::abs(R[d][k]);
            }
          const double xi = (place[d] - home.origin[d]) * home.inverse_edge[d];
          const double half = extent[d] * home.inverse_edge[d];
          at_home           = at_home && xi >= half && xi + half <= 1;
        }
      restrict_and_invert(home, extent, R);
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        {
          std::array<double, dim> x = place;
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
            for (int k = 0; k < dim; ++k)
              x[d] += sign(c, k) * R[d][k];
          std::uint32_t there = at_home ? cell : grid.bins.nearest_cell(x);
          // by round-off where the ghost cells end
          if (rarely(there == invalid_cell))
            there = cell;
          set_corner(grid, there, x, c);
        }
    }

    /** +1 or -1: at which end of edge k the corner is. */
    static constexpr double
    sign(const int corner, const int k)
    {
      return corner >> k & 1 ? 1. : -1.;
    }

    std::array<Corner, n_corners> corners;
    Matrix                        inverse; // of R, 1/m: R^-1_k is row k

  private:
    /** Let R count as the rules say. */
    __attribute__((always_inline)) void
    restrict_and_invert(const CellGeometry<dim>       &home,
                        const std::array<double, dim> &extent,
                        Matrix                        &R)
    {
      constexpr double flattest = 1e-3;
      double           box      = 1;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          double length = extent[d];
          if (const double cells = length * home.inverse_edge[d];
              rarely(cells > 1))
            {
              length /= cells;
              for (int k = 0; k < dim; ++k)
                R[d][k] /= cells;
            }
          box *= length;
        }
      double det = determinant<dim>(R);
      if (rarely(!(det > flattest * box)))
        {
          for (int d = 0; d < dim; ++d)
            for (int k = 0; k < dim; ++k)
              R[d][k] =
                d == k ? std::min(extent[d], 1 / home.inverse_edge[d]) : 0;
          det = box;
        }
      const Matrix cof = cofactor<dim>(R);
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          inverse[k][d] = cof[d][k] / det;
    }

    __attribute__((always_inline)) void
    set_corner(const GridView<dim>           &grid,
               const std::uint32_t            cell,
               const std::array<double, dim> &x,
               const int                      c)
    {
      Corner                  &corner   = corners[c];
      const CellGeometry<dim> &geometry = grid.cells[cell];
      const auto               xi       = [&](const int d) {
        const double inside =
          std::clamp(x[d], grid.bins.lower[d], grid.bins.upper(d));
        return (inside - geometry.origin[d]) * geometry.inverse_edge[d];
      };
      corner.cell    = cell;
      corner.weights = Linear<dim>::weights(0, xi(0));
#pragma GCC unroll 8
      for (int d = 1; d < dim; ++d)
        corner.weights *= Linear<dim>::weights(d, xi(d));
    }
  };
} // namespace limber

#endif
