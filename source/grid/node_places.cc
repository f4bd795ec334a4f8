// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_places.h>
#include <limber/grid/spline_nodes.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    /** Along an axis, in half edges of the finest cells. */
    struct Interval
    {
      std::int64_t begin, length;
    };



    /** The interval of a cell along each axis. */
    template <int dim>
    std::array<Interval, dim>
    extent_of(const BackgroundGrid<dim> &grid, const std::uint32_t cell)
    {
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      const std::int64_t       length =
        std::int64_t(2) << (grid.description.levels - grid.level_of(cell));
      std::array<Interval, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = {length * std::lround((geometry.origin[d] -
                                           grid.description.lower[d]) *
                                          geometry.inverse_edge[d]),
                     length};
      return result;
    }
  } // namespace



  template <int dim>
  std::vector<std::uint64_t>
  places_of_nodes(const BackgroundGrid<dim> &grid)
  {
    const GridDescription<dim> &box = grid.description;
    std::vector<std::uint64_t>  result(grid.nodes().n(), no_place);

    // Register nodes: n functions along an axis, the first at `first` half
    // cells from the beginning of the cell, clamped to the box.
    const auto note = [&](const std::uint32_t cell,
                          const auto         &nodes,
                          const int           n,
                          const int           first) {
      const auto extent = extent_of(grid, cell);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i] != unknown_node)
          {
            std::array<std::uint64_t, dim> place;
            std::size_t                    rest = i;
            for (int d = 0; d < dim; ++d, rest /= n)
              {
                const std::int64_t last = std::int64_t(2 * box.cells[d])
                                          << box.levels;
                place[d] = std::clamp<std::int64_t>(
                  extent[d].begin +
                    (first + 2 * std::int64_t(rest % n)) * extent[d].length / 2,
                  0,
                  last);
              }
            std::uint64_t in_lattice = 0;
            for (int d = dim - 1; d >= 0; --d)
              in_lattice =
                in_lattice *
                  ((std::uint64_t(2 * box.cells[d]) << box.levels) + 1) +
                place[d];
            result[nodes[i] / NodeLayout<dim>::stride] = in_lattice;
          }
    };
    for (std::uint32_t cell = 0; cell < grid.n_cells(); ++cell)
      if (grid.has_own_nodes())
        note(cell, grid.quadratics[cell].node, 3, -1);
      else if (box.kernel == KernelKind::cubic)
        note(cell, grid.cubics[cell].node, 4, -2);
      else
        note(cell, grid.geometry[cell].node, 2, 0);
    return result;
  }



  template std::vector<std::uint64_t>
  places_of_nodes(const BackgroundGrid<2> &);
  template std::vector<std::uint64_t>
  places_of_nodes(const BackgroundGrid<3> &);
} // namespace limber
