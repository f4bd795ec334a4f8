// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_domain_shape_h
#define limber_interpolation_domain_shape_h

#include <limber/base/expected.h>
#include <limber/base/pack.h>
#include <limber/base/small_matrix.h>
#include <limber/interpolation/hexahedron.h>
#include <limber/points/point_view.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  /**
   * Domains whose volume is less than that share of their bounding box are
   * replaced by it.
   */
  inline constexpr double flattest_domain = 1e-3;



  /** Boxes are restricted to that half edge, in cells. */
  inline constexpr double largest_half_box = 0.5;

  /** Lower limit of the half edge of boxes, in cells. */
  inline constexpr double smallest_half_box = 1e-6;



  /**
   * Half edge of the box of a point, or of a pack of points, along d, m; @p
   * load reads an array for them.
   */
  template <int dim, class Load>
  __attribute__((always_inline)) inline auto
  half_box(const PointView<dim> &points, const int d, const Load &load)
  {
    auto half = load(points.domain[d * (dim + 1)]);
    if (points.domain_form == DomainForm::stretched_box)
      {
        half *= half;
#pragma GCC unroll 3
        for (int k = 0; k < dim; ++k)
          if (k != d)
            {
              const auto edge = load(points.domain[d * dim + k]);
              half += edge * edge;
            }
        half = square_root(half);
      }
    return half;
  }



  /**
   * The domain of a point, over which shape functions are averaged.
   *
   * CPDI (convected particle domain interpolation; Sadeghirad, Brannon and
   * Burghardt, IJNME 86 (2011) 1435-1456): the parallelogram or parallelepiped
   * around the point with the half edges r_k, the columns of R, which are
   * convected by the grid velocity. Its corners are x_c = x + R s_c with signs
   * s_c. Grid functions are interpolated from the corners and averaged,
   *
   *   N_i = 2^-d sum_c N_i(x_c),   grad N_i = 2^-d sum_c N_i(x_c) R^-T s_c,
   *
   * so that a field u of the grid has at the point, with its values u_c at the
   * corners,
   *
   *   u = 2^-d sum_c u_c,   grad u = sum_k u,k R^-1_k,   u,k = 2^-d sum_c s_ck
   *   u_c.
   *
   * N_i(x_c) are the linear functions of the cells of the corners, looked up
   * one by one: each point has a stencil of its own.
   *
   * GIMP (generalised interpolation; Bardenhagen and Kober, CMES 5 (2004)
   * 477-495): an axis-parallel box, R = diag(a), and functions are exact means
   * over it, N_i = (1/V) int N_i dV and grad N_i = (1/V) int grad N_i dV,
   * summed up over its parts in each cell. The box has fixed size (uGIMP), or
   * follows the stretch (cpGIMP): a_d is the length of row d of the convected
   * R, sqrt((R R^T)_dd), which corresponds to the left stretch V = sqrt(F F^T)
   * along the axis and is invariant to rotations.
   *
   * CPDI2: the quadrilateral or hexahedron whose corners are convected one by
   * one, with the point as its centroid (hexahedron.h). Functions are exact
   * means over it of the interpolation from its corners, N_i = sum_c share_c
   * N_i(x_c) and grad N_i = sum_c slope_c N_i(x_c); with the half edges r_k of
   * the middle, u,k = sum_c (slope_c . r_k) u_c.
   *
   * Restrictions. A domain extends at most one cell from its point along each
   * axis; longer ones are scaled down to that. An inverted domain, or one of
   * less than a thousandth of the volume of its bounding box, is replaced by
   * that; a hexahedron that is inverted at any Gauss point is first replaced
   * by the parallelepiped of its half edges. A corner outside of the grid is
   * clamped to its side. A box extends at most half a cell (the smallest that
   * it overlaps) from its point, so that its corners are in all cells that it
   * overlaps; beyond a side of the grid it sees linear functions continued.
   */
  template <int dim>
  class DomainShape
  {
  public:
    static constexpr int n_corners = 1 << dim;

    /** The domain of point p, which is in @p cell. */
    __attribute__((always_inline)) DomainShape(const PointView<dim> &points,
                                               const GridView<dim>  &grid,
                                               const std::uint32_t   cell,
                                               const std::size_t     p)
      : home(cell)
    {
      const CellGeometry<dim> &geometry = grid.cells[cell];
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        place[d] = points.position[d][p];
      if (points.has_boxes())
        set_box(points, geometry, p);
      else if (points.domain_form == DomainForm::hexahedron)
        set_hexahedron(points, geometry, p);
      else
        set_edges(points, geometry, p);
      is_at_home = true;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          const double xi =
            (place[d] - geometry.origin[d]) * geometry.inverse_edge[d];
          const double half = extent[d] * geometry.inverse_edge[d];
          is_at_home &= (xi >= half) & (xi + half <= 1);
        }
      if (rarely(!is_at_home && !grid.bins.one_per_cell) && points.has_boxes())
        restrict_box(grid);
    }

    /** +1 or -1: at which end of edge k the corner is. */
    static constexpr double
    sign(const int corner, const int k)
    {
      return corner >> k & 1 ? 1. : -1.;
    }

    /** A corner, m. */
    __attribute__((always_inline)) std::array<double, dim>
    corner(const int c) const
    {
      std::array<double, dim> x = place;
      if (is_hexahedron)
        for (int d = 0; d < dim; ++d)
          x[d] += hexahedron.offsets[c][d];
      else
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
          for (int k = 0; k < dim; ++k)
            x[d] += sign(c, k) * edges[d][k];
      return x;
    }

    /** Weight of a corner in u, relative to that of a parallelepiped, 2^-d. */
    __attribute__((always_inline)) double
    share(const int c) const
    {
      return is_hexahedron ? n_corners * hexahedron.shares[c] : 1.;
    }

    /** Weight of a corner in u,k, likewise. */
    __attribute__((always_inline)) double
    share(const int c, const int k) const
    {
      return is_hexahedron ? n_corners * hexahedron.along[k][c] : sign(c, k);
    }

    /** The cell in which a position counts. */
    __attribute__((always_inline)) std::uint32_t
    cell_at(const GridView<dim> &grid, const std::array<double, dim> &x) const
    {
      const std::uint32_t cell = grid.bins.nearest_cell(x);
      // by round-off at the end of the ghost cells
      return rarely(cell == invalid_cell) ? home : cell;
    }

    /** R^-1, 1/m, whose row k is R^-1_k. */
    __attribute__((always_inline)) SmallMatrix<dim, double>
    inverse() const
    {
      SmallMatrix<dim, double> result;
      const auto               cof = cofactor<dim>(edges);
      const double             one = 1 / determinant<dim>(edges);
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          result[k][d] = cof[d][k] * one;
      return result;
    }

    const std::uint32_t home;       // the cell of the point
    bool                is_at_home; // all corners are in it
    // Whether corners are independent (CPDI2), and not restricted
    bool is_hexahedron = false, is_whole = false;

  protected:
    std::array<double, dim> place, extent; // m; extent of the bounding box

  private:
    __attribute__((always_inline)) void
    set_box(const PointView<dim>    &points,
            const CellGeometry<dim> &geometry,
            const std::size_t        p)
    {
      for (int d = 0; d < dim; ++d)
        {
          extent[d] = std::clamp(half_box<dim>(points,
                                               d,
                                               [&](const double *const array) {
                                                 return array[p];
                                               }) *
                                   geometry.inverse_edge[d],
                                 smallest_half_box,
                                 largest_half_box) /
                      geometry.inverse_edge[d];
          for (int k = 0; k < dim; ++k)
            edges[d][k] = d == k ? extent[d] : 0;
        }
    }

    /**
     * On an adaptive grid: neighbouring cells differ by a factor of two (2:1
     * balance), so the ends and middles of the edges find the smallest one.
     */
    __attribute__((noinline, cold)) void
    restrict_box(const GridView<dim> &grid)
    {
      std::array<double, dim> finest{}; // 1 / edge, 1/m
      for (int i = 0; i < (dim == 2 ? 9 : 27); ++i)
        {
          std::array<double, dim> x    = place;
          int                     rest = i;
          for (int d = 0; d < dim; ++d, rest /= 3)
            x[d] += (rest % 3 - 1) * extent[d];
          const CellGeometry<dim> &cell = grid.cells[cell_at(grid, x)];
          for (int d = 0; d < dim; ++d)
            finest[d] = std::max(finest[d], cell.inverse_edge[d]);
        }
      for (int d = 0; d < dim; ++d)
        extent[d] = edges[d][d] =
          std::min(extent[d], largest_half_box / finest[d]);
    }

    __attribute__((always_inline)) void
    set_edges(const PointView<dim>    &points,
              const CellGeometry<dim> &geometry,
              const std::size_t        p)
    {
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          extent[d] = 0;
#pragma GCC unroll 8
          for (int k = 0; k < dim; ++k)
            {
              edges[d][k] = points.domain[d * dim + k][p];
              extent[d] += std::abs(edges[d][k]);
            }
        }
      restrict_edges(geometry);
    }

    __attribute__((noinline)) void
    set_hexahedron(const PointView<dim>    &points,
                   const CellGeometry<dim> &geometry,
                   const std::size_t        p)
    {
      for (int d = 0; d < dim; ++d)
        {
          for (int k = 0; k < dim; ++k)
            hexahedron.edges[d][k] = points.domain[d * dim + k][p];
          for (int t = 0; t < hexahedron.n_twists; ++t)
            hexahedron.twists[t][d] = points.domain[dim * (dim + t) + d][p];
        }
      hexahedron.integrate();
      edges      = hexahedron.edges;
      double box = flattest_domain;
      for (int d = 0; d < dim; ++d)
        {
          extent[d] = 0;
          for (const auto &offset : hexahedron.offsets)
            extent[d] = std::max(extent[d], std::abs(offset[d]));
          box *= extent[d];
        }
      is_hexahedron =
        hexahedron.smallest > box && determinant<dim>(edges) > box;
      if (rarely(!is_hexahedron))
        return set_edges(points, geometry, p);
      is_whole = true;
      for (int d = 0; d < dim; ++d)
        if (const double cells = extent[d] * geometry.inverse_edge[d];
            rarely(cells > 1))
          {
            is_whole = false;
            extent[d] /= cells;
            for (int k = 0; k < dim; ++k)
              edges[d][k] /= cells;
            for (auto &offset : hexahedron.offsets)
              offset[d] /= cells;
          }
    }

    /** Restrict R, and its bounding box, by the rules above. */
    __attribute__((always_inline)) void
    restrict_edges(const CellGeometry<dim> &geometry)
    {
      double box = 1;
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
        {
          if (const double cells = extent[d] * geometry.inverse_edge[d];
              rarely(cells > 1))
            {
              extent[d] /= cells;
              for (int k = 0; k < dim; ++k)
                edges[d][k] /= cells;
            }
          box *= extent[d];
        }
      if (rarely(!(determinant<dim>(edges) > flattest_domain * box)))
        for (int d = 0; d < dim; ++d)
          for (int k = 0; k < dim; ++k)
            edges[d][k] = d == k ? extent[d] : 0;
    }

    SmallMatrix<dim, double> edges; // restricted R, m
    Hexahedron<dim, double>  hexahedron;
  };
} // namespace limber

#endif
