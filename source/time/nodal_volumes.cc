// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/nodal_volumes.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  NodalVolumes<dim>::NodalVolumes(const BackgroundGrid<dim> &grid,
                                  const CutCells<dim> *const cut_cells)
    : grid(grid)
    , cut_cells(cut_cells)
  {}



  template <int dim>
  void
  NodalVolumes<dim>::reinit()
  {
    constexpr unsigned int n_corners = 1 << dim;
    const NodeTable<dim>  &table     = grid.vertices;
    nodal_volumes.reinit(table.n());
    std::fill_n(nodal_volumes.data(), table.n(), 0.);
    for (std::uint32_t number = 0; number < grid.n_owned_cells(); ++number)
      {
        const CellGeometry<dim> &cell   = grid.geometry[number];
        double                   volume = 1;
        for (const double inverse : cell.inverse_edge)
          volume /= inverse;
        for (unsigned int a = 0; a < n_corners; ++a)
          nodal_volumes[cell.node[a] / NodeLayout<dim>::stride] +=
            volume / n_corners;
      }
    table.give_to_masters(nodal_volumes.data(), 1, 0, 1);
    const ExchangePlan all(table.shared);
    exchange.start(all, nodal_volumes.data(), 0, 1);
    exchange.finish(nodal_volumes.data());
  }



  template class NodalVolumes<2>;
  template class NodalVolumes<3>;
} // namespace limber
