// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/block_nodes.h>

namespace limber
{
  template <int dim>
  bool
  BlockNodes<dim>::find(const GridView<dim> &grid,
                        const std::uint32_t  cell,
                        const Vector        &xi,
                        const Vector        &half)
  {
    const BinView<dim>      &bins     = grid.bins;
    const CellGeometry<dim> &geometry = grid.cells[cell];
    Place                    first{};
    n = {{1, 1, 1}};
    for (int d = 0; d < dim; ++d)
      {
        double n_cells = static_cast<double>(bins.n[d]);
        if (rarely(!bins.one_per_cell))
          n_cells = std::round(n_cells * geometry.inverse_edge[d] /
                               bins.inverse_edge[d]);
        const auto home = static_cast<std::int64_t>(
          (geometry.origin[d] - bins.lower[d]) * geometry.inverse_edge[d] +
          0.5);
        const auto last = static_cast<std::int64_t>(n_cells) - 1;
        if (rarely(last < 1))
          return false;

        // A point sees its cell and one neighbour; at a side of the grid, its
        // own cell and up to half a cell beyond the side.
        const auto below     = xi[d]<half[d], above = xi[d] + half[d]> 1.;
        const bool any_below = !all(!below), any_above = !all(!above);
        reaches_beyond[d] =
          rarely((home == 0 && any_below) || (home == last && any_above));
        if (rarely(home == 0))
          {
            start[d]      = Number{};
            cell_begin[d] = 0;
            n[d]          = 2 + any_above;
          }
        else if (rarely(home == last))
          {
            start[d]      = Number{};
            cell_begin[d] = 1;
            n[d]          = 3;
          }
        else if (any_below)
          {
            const auto only_above = above & !below;
            start[d]              = below ? Number{} : broadcast<Number>(1.);
            cell_begin[d]         = 1;
            n[d]                  = all(!only_above) ? 3 : 4;
          }
        else
          {
            start[d]      = Number{};
            cell_begin[d] = 0;
            n[d]          = 2 + any_above;
          }
        first[d] = home - static_cast<std::int64_t>(cell_begin[d]);
      }
    return usually(bins.nodes != nullptr && bins.one_per_cell) ?
             read_records(bins, first) :
             collect_records(grid, geometry, first);
  }



  template <int dim>
  bool
  BlockNodes<dim>::read_records(const BinView<dim> &bins, const Place &first)
  {
    std::int64_t begin = first[dim - 1];
    for (int d = dim - 2; d >= 0; --d)
      begin = begin * (bins.n[d] + 1) + first[d];
    const std::int64_t row       = bins.n[0] + 1;
    const std::int64_t plane     = dim == 3 ? row * (bins.n[1] + 1) : 0;
    bool               all_known = true;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        {
          std::uint32_t *const to = &records[row_begin(j, k)];
          std::memcpy(to,
                      bins.nodes + begin + k * plane + j * row,
                      longest * sizeof(*to));
          for (int i = 0; i < n[0]; ++i)
            all_known &= to[i] != BinView<dim>::no_node;
        }
    return all_known;
  }



  template <int dim>
  bool
  BlockNodes<dim>::collect_records(const GridView<dim>     &grid,
                                   const CellGeometry<dim> &geometry,
                                   const Place             &first)
  {
    const BinView<dim> &bins = grid.bins;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i)
          {
            // node i is the first one of cell i; the last node that of the cell
            // before
            const std::array<int, 3> node{{i, j, k}};
            std::array<double, dim>  middle;
            int                      in_cell = 0;
            for (int d = 0; d < dim; ++d)
              {
                const bool is_last = node[d] == n[d] - 1;
                in_cell |= is_last << d;
                middle[d] =
                  bins.lower[d] +
                  (static_cast<double>(first[d] + node[d] - is_last) + 0.5) /
                    geometry.inverse_edge[d];
              }
            const std::uint32_t there = bins.cell_at(middle);
            if (there == invalid_cell)
              return false;
            const double ratio =
              grid.cells[there].inverse_edge[0] / geometry.inverse_edge[0];
            if (ratio > 1.5 || ratio < 0.75)
              return false;
            records[row_begin(j, k) + i] = grid.cells[there].node[in_cell];
          }
    return true;
  }



  template class BlockNodes<2>;
  template class BlockNodes<3>;
} // namespace limber
