// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/node_rooms.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  NodeRooms<dim>::NodeRooms(const BackgroundGrid<dim> &grid,
                            const CutCells<dim> *const cut_cells)
    : grid(grid)
    , cut_cells(cut_cells)
  {}



  template <int dim>
  void
  NodeRooms<dim>::reinit()
  {
    constexpr unsigned int n_corners = 1 << dim;
    const NodeTable<dim>  &table     = grid.vertices;
    rooms.reinit(table.n());
    std::fill_n(rooms.data(), table.n(), 0.);
    for (std::uint32_t number = 0; number < grid.n_owned_cells(); ++number)
      {
        const CellGeometry<dim> &cell   = grid.geometry[number];
        double                   volume = 1;
        for (const double inverse : cell.inverse_edge)
          volume /= inverse;
        for (unsigned int a = 0; a < n_corners; ++a)
          rooms[cell.node[a] / NodeLayout<dim>::stride] += volume / n_corners;
      }
    table.give_to_masters(rooms.data(), 1, 0, 1);
    const ExchangePlan all(table.shared);
    exchange.start(all, rooms.data(), 0, 1);
    exchange.finish(rooms.data());
  }



  template class NodeRooms<2>;
  template class NodeRooms<3>;
} // namespace limber
