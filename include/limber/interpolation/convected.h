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
    static constexpr int n_corners = 1 << dim;
    using Nodes                    = typename Linear<dim>::Nodes;

    /**
     * The corners that are in one cell, with sums over them for its nodes:
     * 2^-d sum_c N_i(x_c) and 2^-d sum_c s_ck N_i(x_c).
     */
    struct Piece
    {
      std::uint32_t          cell;
      Nodes                  weight;
      std::array<Nodes, dim> along;
    };

    /** Of point p, which is in @p cell. */
    __attribute__((always_inline)) ConvectedDomain(const PointView<dim> &points,
                                                   const GridView<dim>  &grid,
                                                   const std::uint32_t   cell,
                                                   const std::size_t     p)
    {
      const CellGeometry<dim> &home = grid.cells[cell];
      std::array<double, dim>  place, extent; // of the box around the domain
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          place[d]  = points.position[d][p];
          extent[d] = 0;
#pragma GCC unroll 8
          for (int k = 0; k < dim; ++k)
            {
              edges[d][k] = points.domain[d * dim + k][p];
              extent[d] += std::abs(edges[d][k]);
            }
        }
      restrict_edges(home, extent);
      if (is_within(home, place, extent))
        set_only_piece(cell, home, place);
      else
        set_pieces(grid, cell, place);
    }

    /** Whether a box around a place, of these half edges, is in a cell. */
    __attribute__((always_inline)) static bool
    is_within(const CellGeometry<dim>       &cell,
              const std::array<double, dim> &place,
              const std::array<double, dim> &half)
    {
      bool result = true;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const double xi = (place[d] - cell.origin[d]) * cell.inverse_edge[d];
          const double h  = half[d] * cell.inverse_edge[d];
          result &= (xi >= h) & (xi + h <= 1);
        }
      return result;
    }

    /** R^-1, 1/m, whose row k is R^-1_k. */
    __attribute__((always_inline)) SmallMatrix<dim, double>
    inverse() const
    {
      SmallMatrix<dim, double> result;
      const auto               cof = cofactor<dim>(edges);
      const double             det = determinant<dim>(edges);
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          result[k][d] = cof[d][k] / det;
      return result;
    }

    int                          n_pieces = 0;
    std::array<Piece, n_corners> pieces;
    SmallMatrix<dim, double>     edges; // R as it counts, m

  private:
    static constexpr double share = 1. / n_corners; // of a corner

    /** +1 or -1: at which end of edge k the corner is. */
    static constexpr double
    sign(const int corner, const int k)
    {
      return corner >> k & 1 ? 1. : -1.;
    }

    /** Let R, and with it the box around it, count as the rules say. */
    __attribute__((always_inline)) void
    restrict_edges(const CellGeometry<dim> &home,
                   std::array<double, dim> &extent)
    {
      constexpr double flattest = 1e-3;
      double           box      = 1;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          if (const double cells = extent[d] * home.inverse_edge[d];
              rarely(cells > 1))
            {
              extent[d] /= cells;
              for (int k = 0; k < dim; ++k)
                edges[d][k] /= cells;
            }
          box *= extent[d];
        }
      if (rarely(!(determinant<dim>(edges) > flattest * box)))
        for (int d = 0; d < dim; ++d)
          for (int k = 0; k < dim; ++k)
            edges[d][k] = d == k ? extent[d] : 0;
    }

    __attribute__((always_inline)) std::array<double, dim>
    corner(const std::array<double, dim> &place, const int c) const
    {
      std::array<double, dim> x = place;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int k = 0; k < dim; ++k)
          x[d] += sign(c, k) * edges[d][k];
      return x;
    }

    /** N_i(x), over the number of corners. */
    __attribute__((always_inline)) static Nodes
    weights(const CellGeometry<dim> &cell, const std::array<double, dim> &x)
    {
      const auto xi = [&](const int d) {
        return (x[d] - cell.origin[d]) * cell.inverse_edge[d];
      };
      Nodes result = share * Linear<dim>::weights(0, xi(0));
#pragma GCC unroll 8
      for (int d = 1; d < dim; ++d)
        result *= Linear<dim>::weights(d, xi(d));
      return result;
    }

    __attribute__((always_inline)) static void
    add(Piece &piece, const int c, const Nodes &weight)
    {
      piece.weight += weight;
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        piece.along[k] += sign(c, k) * weight;
    }

    /** All corners in the cell of the point. */
    __attribute__((always_inline)) void
    set_only_piece(const std::uint32_t            cell,
                   const CellGeometry<dim>       &home,
                   const std::array<double, dim> &place)
    {
      Piece piece{cell, Nodes{}, {}};
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        add(piece, c, weights(home, corner(place, c)));
      pieces[0] = piece;
      n_pieces  = 1;
    }

    __attribute__((always_inline)) void
    set_pieces(const GridView<dim>           &grid,
               const std::uint32_t            cell,
               const std::array<double, dim> &place)
    {
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        {
          std::array<double, dim> x     = corner(place, c);
          std::uint32_t           there = grid.bins.nearest_cell(x);
          // by round-off where the ghost cells end
          if (rarely(there == invalid_cell))
            there = cell;
#pragma GCC unroll 8
          for (int d = 0; d < dim; ++d)
            x[d] = std::clamp(x[d], grid.bins.lower[d], grid.bins.upper(d));
          int k = 0;
          while (k < n_pieces && pieces[k].cell != there)
            ++k;
          if (k == n_pieces)
            pieces[n_pieces++] = {there, Nodes{}, {}};
          add(pieces[k], c, weights(grid.cells[there], x));
        }
    }
  };
} // namespace limber

#endif
