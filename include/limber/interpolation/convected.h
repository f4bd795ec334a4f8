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
  /** Flatter domains than that share of the box around them do not count. */
  inline constexpr double flattest_domain = 1e-3;



  /** Boxes count for no more than that many cells on either side. */
  inline constexpr double largest_half_box = 0.5;

  /** Boxes that have shrunk to less count for that many cells. */
  inline constexpr double smallest_half_box = 1e-6;



  /**
   * Half an edge of the box of a point, or of a pack of points, along d, m;
   * @p load gives what an array has for them.
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
   * The domain of a point, over which functions of the grid are averaged.
   *
   * Convected (CPDI; Sadeghirad, Brannon and Burghardt, IJNME 86 (2011)
   * 1435-1456) it is the parallelogram or parallelepiped around the point with
   * the half edges r_k, the columns of R, which are carried along by the grid.
   * Its corners are x_c = x + R s_c with signs s_c. The functions of the point
   * are means over it of those of the grid, interpolated from the corners,
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
   * With generalised interpolation (GIMP; Bardenhagen and Kober, CMES 5 (2004)
   * 477-495) it is a box along the axes, R = diag(a), and functions are its
   * exact means, N_i = (1/V) int N_i dV and grad N_i = (1/V) int grad N_i dV,
   * which in each cell are those of its part there. It keeps its size, or
   * follows the stretch: a_d is the length of row d of the R that is carried
   * along, sqrt((R R^T)_dd), which the left stretch V = sqrt(F F^T) gives along
   * the axis and no rotation changes.
   *
   * Rules. Along each axis a domain counts for no more than a cell on either
   * side of its point; what is longer is shortened to that. One that has turned
   * inside out, or is flatter than a thousandth, counts as the box around it. A
   * corner outside the grid counts in its side. A box counts for no more than
   * half a cell on either side; where it reaches beyond a side of the grid it
   * sees linear functions as if they went on.
   */
  template <int dim>
  class DomainShape
  {
  public:
    static constexpr int n_corners = 1 << dim;

    /** Of point p, which is in @p cell. */
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
#pragma GCC unroll 8
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int k = 0; k < dim; ++k)
          x[d] += sign(c, k) * edges[d][k];
      return x;
    }

    /** The cell in which a place counts. */
    __attribute__((always_inline)) std::uint32_t
    cell_at(const GridView<dim> &grid, const std::array<double, dim> &x) const
    {
      const std::uint32_t cell = grid.bins.nearest_cell(x);
      // by round-off where the ghost cells end
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

  protected:
    std::array<double, dim> place, extent; // m; of the box around the domain

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

    /** Let R, and with it the box around it, count as the rules say. */
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

    SmallMatrix<dim, double> edges; // R as it counts, m
  };



  /** A domain and the functions of the nodes on it. */
  template <int dim>
  class ConvectedDomain : public DomainShape<dim>
  {
    using Shape = DomainShape<dim>;

  public:
    using Shape::n_corners;
    using Nodes = typename Linear<dim>::Nodes;

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
      : Shape(points, grid, cell, p)
    {
      if (points.has_boxes())
        set_parts_of_box(grid);
      else if (this->is_at_home)
        set_only_piece(grid.cells[cell]);
      else
        set_pieces(grid);
    }

    int                          n_pieces = 0;
    std::array<Piece, n_corners> pieces;

  private:
    /**
     * N_i(x), over the number of corners; a place beyond the cell, in a side
     * of the grid or by round-off, counts in its face. No weight is negative:
     * nodes that get next to nothing get a positive mass.
     */
    __attribute__((always_inline)) static Nodes
    weights(const CellGeometry<dim> &cell, const std::array<double, dim> &x)
    {
      const auto along = [&](const int d) {
        return Linear<dim>::weights(
          d,
          std::clamp((x[d] - cell.origin[d]) * cell.inverse_edge[d], 0., 1.));
      };
      constexpr double share  = 1. / n_corners;
      Nodes            result = share * along(0);
#pragma GCC unroll 8
      for (int d = 1; d < dim; ++d)
        result *= along(d);
      return result;
    }

    __attribute__((always_inline)) static void
    add(Piece &piece, const int c, const Nodes &weight)
    {
      piece.weight += weight;
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        piece.along[k] += Shape::sign(c, k) * weight;
    }

    /** The part of a box in each of the cells that its corners are in. */
    __attribute__((noinline, cold)) void
    set_parts_of_box(const GridView<dim> &grid)
    {
      std::array<std::uint32_t, n_corners> cells;
      for (int c = 0; c < n_corners; ++c)
        cells[c] = this->cell_at(grid, this->corner(c));
      for (int c = 0; c < n_corners; ++c)
        {
          if (std::find(cells.begin(), cells.begin() + c, cells[c]) !=
              cells.begin() + c)
            continue;
          const CellGeometry<dim> &cell  = grid.cells[cells[c]];
          Piece                    piece = {cells[c], Nodes{} + 1., {}};
          for (int k = 0; k < dim; ++k)
            piece.along[k] = Nodes{} + 1.;
          for (int d = 0; d < dim; ++d)
            {
              double lower = this->place[d] - this->extent[d],
                     upper = this->place[d] + this->extent[d];
              const bool is_divided =
                grid.cells[cells[c ^ 1 << d]].origin[d] != cell.origin[d];
              if (is_divided && c >> d & 1)
                lower = cell.origin[d];
              else if (is_divided)
                upper = cell.origin[d] + 1 / cell.inverse_edge[d];
              const auto at = [&](const double x) {
                return Linear<dim>::weights(d,
                                            (x - cell.origin[d]) *
                                              cell.inverse_edge[d]);
              };
              upper             = std::max(lower, upper); // but for round-off
              const Nodes first = at(lower), last = at(upper);
              const Nodes mean = (upper - lower) / (2 * this->extent[d]) *
                                 larger(0.5 * (first + last), Nodes{});
              const Nodes change = 0.5 * (last - first);
              piece.weight *= mean;
              for (int k = 0; k < dim; ++k)
                piece.along[k] *= k == d ? change : mean;
            }
          pieces[n_pieces++] = piece;
        }
    }

    __attribute__((always_inline)) void
    set_only_piece(const CellGeometry<dim> &geometry)
    {
      Piece piece{this->home, Nodes{}, {}};
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        add(piece, c, weights(geometry, this->corner(c)));
      pieces[0] = piece;
      n_pieces  = 1;
    }

    __attribute__((always_inline)) void
    set_pieces(const GridView<dim> &grid)
    {
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        {
          const std::array<double, dim> x     = this->corner(c);
          const std::uint32_t           there = this->cell_at(grid, x);
          int                           k     = 0;
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
