// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_locate_h
#define limber_points_locate_h

#include <limber/points/point_view.h>

namespace limber
{
  /**
   * Find the cells of the points [begin, end), which were in @p cell; count
   * their cell crossings if requested, and register cells that were empty so
   * far. A point outside the grid gets invalid_cell; MaterialPoints removes it.
   */
  template <int dim>
  __attribute__((noinline, cold)) inline void
  locate(const PointView<dim> &points,
         const GridView<dim>  &grid,
         const std::uint32_t   cell,
         const std::size_t     begin,
         const std::size_t     end)
  {
    const CellGeometry<dim> &geometry = grid.cells[cell];
    for (std::size_t p = begin; p < end; ++p)
      {
        bool inside = true;
        for (int d = 0; d < dim; ++d)
          {
            const double xi = (points.position[d][p] - geometry.origin[d]) *
                              geometry.inverse_edge[d];
            inside &= (xi >= 0.) & (xi <= 1.);
          }
        if (inside)
          continue;

        std::array<double, dim> x;
        for (int d = 0; d < dim; ++d)
          x[d] = points.position[d][p];
        const std::uint32_t next = grid.bins.cell_at(x);
        points.cell[p]           = next;
        if (points.crossings != nullptr && next != cell)
          ++points.crossings[p];
        if (next == invalid_cell)
          {
            *grid.left = true;
            continue;
          }
        if (next >= grid.n_owned_cells)
          *grid.is_in_ghosts = true;
        if (!grid.occupied[next])
          {
            grid.occupied[next] = 1;
            grid.entered->push_back(next);
          }
      }
  }
} // namespace limber

#endif
