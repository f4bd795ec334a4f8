// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_fields.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  NodalFields<dim>::NodalFields(const BackgroundGrid<dim> &grid)
    : grid(grid)
    , nodes_to_share(grid.shared_nodes)
    , cells_to_share(grid.shared_cells)
  {
    reinit();
  }



  template <int dim>
  void
  NodalFields<dim>::reinit()
  {
    values.reinit(std::size_t(grid.n_nodes()) * Layout::stride);
    is_occupied.reinit(grid.n_cells());
    is_active.reinit(grid.n_nodes());
    nodes_to_share = ExchangePlan(grid.shared_nodes);
    cells_to_share = ExchangePlan(grid.shared_cells);
    // What was active belongs to the numbers of the former mesh.
    occupied_owned.clear();
    occupied_ghost.clear();
    entered.clear();
    active.clear();
    active_boundary.clear();
    set_occupied({});
  }



  template <int dim>
  GridView<dim>
  NodalFields<dim>::view()
  {
    GridView<dim> result;
    result.cells    = grid.geometry.data();
    result.nodes    = values.data();
    result.bins     = grid.bins;
    result.occupied = is_occupied.data();
    result.entered  = &entered;
    result.left     = &left;
    return result;
  }



  template <int dim>
  void
  NodalFields<dim>::plan_exchange(const std::vector<std::uint32_t> &cells)
  {
    std::vector<std::uint32_t> reach;
    for (const std::uint32_t cell : cells)
      grid.add_reach(cell, reach);
    LazyArray<std::uint8_t> may_touch(grid.n_cells());
    for (const std::uint32_t cell : reach)
      may_touch[cell] = 1;
    cells_to_share = ExchangePlan(grid.shared_cells,
                                  [&](const auto c) { return may_touch[c]; });

    // The owner adds the mean pressure of a cell, whoever holds its points.
    for (const std::uint32_t cell : cells_to_share.received)
      if (cell < grid.n_owned_cells())
        reach.push_back(cell);
    LazyArray<std::uint8_t> may_add(grid.n_nodes());
    for (const std::uint32_t cell : reach)
      for (const std::uint32_t offset : grid.geometry[cell].node)
        may_add[offset / Layout::stride] = 1;
    for (const HangingNode &hanging : grid.hanging_nodes)
      if (may_add[hanging.node])
        for (const auto &[master, weight] : hanging.masters)
          may_add[master] = 1;
    nodes_to_share =
      ExchangePlan(grid.shared_nodes, [&](const auto n) { return may_add[n]; });
  }



  template <int dim>
  void
  NodalFields<dim>::set_occupied(std::vector<std::uint32_t> &&cells)
  {
    // Nodes that are given up keep zero records: whoever looks at a node
    // without mass finds nothing there.
    clear();
    for (const auto *const former :
         {&occupied_owned, &occupied_ghost, &entered})
      for (const std::uint32_t cell : *former)
        is_occupied[cell] = 0;
    for (const std::uint32_t node : active)
      is_active[node] = 0;
    occupied_owned.clear();
    occupied_ghost.clear();
    entered.clear();
    active.clear();
    active_boundary.clear();

    for (const std::uint32_t cell : cells)
      activate(cell);
    // Other ranks may give to these without this one knowing.
    for (const std::uint32_t cell : cells_to_share.received)
      if (!is_occupied[cell])
        activate(cell);
    for (const std::uint32_t node : nodes_to_share.received)
      activate_node(node);
    activate_masters();
  }



  template <int dim>
  void
  NodalFields<dim>::add_entered()
  {
    for (const std::uint32_t cell : entered)
      activate(cell);
    if (!entered.empty())
      activate_masters();
    entered.clear();
  }



  template <int dim>
  void
  NodalFields<dim>::activate(const std::uint32_t cell)
  {
    is_occupied[cell] = 1;
    (cell < grid.n_owned_cells() ? occupied_owned : occupied_ghost)
      .push_back(cell);
    for (const std::uint32_t offset : grid.geometry[cell].node)
      activate_node(offset / Layout::stride);
  }



  template <int dim>
  void
  NodalFields<dim>::activate_node(const std::uint32_t node)
  {
    if (is_active[node])
      return;
    is_active[node] = 1;
    active.push_back(node);
    if (grid.sides_of_node[node])
      active_boundary.push_back(node);
  }



  // Masters of hanging nodes may belong to no occupied cell.
  template <int dim>
  void
  NodalFields<dim>::activate_masters()
  {
    for (const HangingNode &hanging : grid.hanging_nodes)
      if (is_active[hanging.node])
        for (const auto &[master, weight] : hanging.masters)
          activate_node(master);
  }



  template <int dim>
  void
  NodalFields<dim>::clear()
  {
    left = false;
    for (const std::uint32_t node : active)
      std::fill_n(record(node), Layout::stride, 0.);
  }



  template <int dim>
  void
  NodalFields<dim>::start_sum(const unsigned int first, const unsigned int last)
  {
    // Linear, so every rank condenses its own contributions.
    for (const HangingNode &hanging : grid.hanging_nodes)
      {
        double *const from = record(hanging.node);
        for (const auto &[master, weight] : hanging.masters)
          for (unsigned int k = first; k < last; ++k)
            record(master)[k] += weight * from[k];
        std::fill(from + first, from + last, 0.);
      }
    exchange.start(nodes_to_share, values.data(), first, last);
  }



  template <int dim>
  void
  NodalFields<dim>::finish_sum()
  {
    exchange.finish(values.data());
  }



  template <int dim>
  void
  NodalFields<dim>::interpolate_hanging()
  {
    for (const HangingNode &hanging : grid.hanging_nodes)
      {
        double *const to = record(hanging.node);
        std::fill_n(to, Layout::stride, 0.);
        for (const auto &[master, weight] : hanging.masters)
          for (unsigned int k = 1; k < Layout::stride; ++k)
            to[k] += weight * record(master)[k];
      }
  }



  template <int dim>
  CellFields<dim>::CellFields(const BackgroundGrid<dim> &grid)
    : grid(grid)
  {
    reinit();
  }



  template <int dim>
  void
  CellFields<dim>::reinit()
  {
    values.reinit(std::size_t(grid.n_cells()) * CellSums<dim>::stride);
  }



  template <int dim>
  CellSums<dim>
  CellFields<dim>::view()
  {
    return {values.data()};
  }



  template <int dim>
  void
  CellFields<dim>::clear(const std::vector<std::uint32_t> &cells)
  {
    for (const std::uint32_t cell : cells)
      std::fill_n(values.data() + std::size_t(cell) * CellSums<dim>::stride,
                  CellSums<dim>::stride,
                  0.);
  }



  template <int dim>
  void
  CellFields<dim>::start_sum(const ExchangePlan &plan,
                             const unsigned int  first,
                             const unsigned int  last)
  {
    exchange.start(plan, values.data(), first, last);
  }



  template <int dim>
  void
  CellFields<dim>::finish_sum()
  {
    exchange.finish(values.data());
  }



  template class NodalFields<2>;
  template class NodalFields<3>;
  template class CellFields<2>;
  template class CellFields<3>;
} // namespace limber
