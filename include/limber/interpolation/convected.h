// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_convected_h
#define limber_interpolation_convected_h

#include <limber/interpolation/domain_shape.h>
#include <limber/interpolation/linear.h>

namespace limber
{
  /** A domain and the functions of the nodes on it. */
  template <int dim>
  class ConvectedDomain : public DomainShape<dim>
  {
    using Shape = DomainShape<dim>;

  public:
    using Shape::n_corners;
    using Nodes = typename Linear<dim>::Nodes;

    /**
     * The corners of a domain that are in one cell, with sums over them for the
     * nodes of that cell: 2^-d sum_c N_i(x_c) and 2^-d sum_c s_ck N_i(x_c), or
     * with the weights of the corners of a hexahedron.
     */
    struct Piece
    {
      std::uint32_t          cell;
      Nodes                  weight;
      std::array<Nodes, dim> along;
    };

    /** The domain of point p, which is in @p cell. */
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

    /** Call work(piece, i, record) for the nodes of all pieces. */
    template <class Work>
    void
    for_nodes(const GridView<dim> &grid, const Work &work) const
    {
      for (int n = 0; n < n_pieces; ++n)
        for (int i = 0; i < Linear<dim>::n_nodes; ++i)
          work(pieces[n], i, grid.nodes + grid.cells[pieces[n].cell].node[i]);
    }

    int                          n_pieces = 0;
    std::array<Piece, n_corners> pieces;

    /**
     * N_i(x) over the number of corners; a position outside the cell, beyond a
     * side of the grid or by round-off, is clamped to its face. No weight is
     * negative, so that even a tiny nodal mass is positive.
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

  private:
    __attribute__((always_inline)) void
    add(Piece &piece, const int c, const Nodes &weight) const
    {
      piece.weight += this->share(c) * weight;
#pragma GCC unroll 8
      for (int k = 0; k < dim; ++k)
        piece.along[k] += this->share(c, k) * weight;
    }

    /**
     * GIMP: integrate over the part of the box in each cell that it overlaps.
     */
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
              upper             = std::max(lower, upper); // for round-off
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
