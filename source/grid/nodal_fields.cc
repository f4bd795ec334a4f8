// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_fields.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  NodalFields<dim>::NodalFields(const BackgroundGrid<dim> &grid)
    : grid(grid)
  {
    reinit();
  }



  template <int dim>
  void
  NodalFields<dim>::reinit()
  {
    values.reinit(grid.node_records(Layout::stride));
    parallel = dealii::Utilities::MPI::n_mpi_processes(grid.communicator) > 1;
    is_occupied.assign(grid.n_cells(), 0);
    is_active.assign(grid.n_nodes(), 0);
    // What was active belongs to the numbers of the former mesh.
    occupied.clear();
    entered.clear();
    active_owned.clear();
    active_boundary.clear();
    set_occupied({});
  }



  template <int dim>
  GridView<dim>
  NodalFields<dim>::view()
  {
    GridView<dim> result;
    result.cells    = grid.geometry.data();
    result.nodes    = values.begin();
    result.bins     = grid.bins;
    result.occupied = is_occupied.data();
    result.entered  = &entered;
    result.left     = &left;
    return result;
  }



  template <int dim>
  void
  NodalFields<dim>::set_occupied(std::vector<std::uint32_t> &&cells)
  {
    // Nodes that are given up keep zero records: whoever looks at a node
    // without mass finds nothing there.
    clear();
    for (const std::uint32_t cell : occupied)
      is_occupied[cell] = 0;
    for (const std::uint32_t cell : entered)
      is_occupied[cell] = 0;
    std::fill(is_active.begin(), is_active.end(), 0);
    active_owned.clear();
    active_boundary.clear();
    entered.clear();

    occupied_owned.clear();
    occupied = std::move(cells);
    for (const std::uint32_t cell : occupied)
      activate(cell);
    // Other ranks may give to these without this one knowing.
    for (const std::uint32_t cell : grid.shared_cells())
      if (!is_occupied[cell])
        {
          occupied.push_back(cell);
          activate(cell);
        }
    for (const std::uint32_t node : grid.shared_nodes())
      if (!is_active[node])
        {
          is_active[node] = 1;
          active_owned.push_back(node);
          if (grid.sides_of_node[node])
            active_boundary.push_back(node);
        }
  }



  template <int dim>
  void
  NodalFields<dim>::add_entered()
  {
    for (const std::uint32_t cell : entered)
      {
        occupied.push_back(cell);
        activate(cell);
      }
    entered.clear();
  }



  template <int dim>
  void
  NodalFields<dim>::activate(const std::uint32_t cell)
  {
    is_occupied[cell] = 1;
    if (cell < grid.n_owned_cells())
      occupied_owned.push_back(cell);
    for (const std::uint32_t offset : grid.geometry[cell].node)
      {
        const std::uint32_t node = offset / Layout::stride;
        if (is_active[node])
          continue;
        is_active[node] = 1;
        if (node >= grid.n_owned_nodes())
          continue;
        active_owned.push_back(node);
        if (grid.sides_of_node[node])
          active_boundary.push_back(node);
      }
  }



  template <int dim>
  void
  NodalFields<dim>::clear()
  {
    left = false;
    for (const std::uint32_t node : active_owned)
      std::fill_n(record(node), Layout::stride, 0.);
    // Masters of hanging nodes get their share whether active or not.
    for (const HangingNode &hanging : grid.hanging_nodes)
      for (const auto &[master, weight] : hanging.masters)
        std::fill_n(record(master), Layout::stride, 0.);
    if (parallel)
      values.zero_out_ghost_values();
  }



  template <int dim>
  void
  NodalFields<dim>::sum_shared(const unsigned int first,
                               const unsigned int last)
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

    if (!parallel)
      return;
    // Ghosts may hold copies in other slots, which must not be added again.
    for (std::uint32_t node = grid.n_owned_nodes(); node < grid.n_nodes();
         ++node)
      {
        std::fill(record(node), record(node) + first, 0.);
        std::fill(record(node) + last, record(node) + Layout::stride, 0.);
      }
    values.set_ghost_state(false);
    values.compress(dealii::VectorOperation::add);
  }



  template <int dim>
  void
  NodalFields<dim>::start_share()
  {
    if (parallel)
      values.update_ghost_values_start();
  }



  template <int dim>
  void
  NodalFields<dim>::end_share()
  {
    if (parallel)
      values.update_ghost_values_finish();
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
    now.reinit(grid.cell_records(CellSums<dim>::stride));
    next.reinit(now);
    parallel = dealii::Utilities::MPI::n_mpi_processes(grid.communicator) > 1;
  }



  template <int dim>
  CellSums<dim>
  CellFields<dim>::view()
  {
    return {now.begin(), next.begin()};
  }



  template <int dim>
  void
  CellFields<dim>::complete(const std::vector<std::uint32_t> &cells)
  {
    if (parallel)
      {
        next.set_ghost_state(false);
        next.compress(dealii::VectorOperation::add);
        next.update_ghost_values();
      }
    now.swap(next);
    for (const std::uint32_t cell : cells)
      std::fill_n(next.begin() + std::size_t(cell) * CellSums<dim>::stride,
                  CellSums<dim>::stride,
                  0.);
    if (parallel)
      next.zero_out_ghost_values();
  }



  template class NodalFields<2>;
  template class NodalFields<3>;
  template class CellFields<2>;
  template class CellFields<3>;
} // namespace limber
