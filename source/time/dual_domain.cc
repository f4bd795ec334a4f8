// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/dual_domain.h>
#include <limber/time/dual_domain.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // Slots that the components of the tensor span in a record
    template <int dim>
    constexpr unsigned int
      n_tensor = DualDomainLayout<dim>::tensor(dim - 1, dim - 1) + 1;
  } // namespace



  template <int dim>
  DualDomain<dim>::DualDomain(const NodeTable<dim> &table,
                              const unsigned int    field)
    : table(table)
    , field(field)
  {
    reinit();
  }



  template <int dim>
  void
  DualDomain<dim>::reinit()
  {
    records.reinit(std::size_t(table.n()) * Layout::stride);
    met.reinit(0);
    cells.clear();
    turn = 0;
  }



  template <int dim>
  void
  DualDomain<dim>::clear(const NodalFields<dim> &nodes,
                         const unsigned int      first,
                         const unsigned int      n)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(record(node) + first, n, 0.);
  }



  template <int dim>
  void
  DualDomain<dim>::sum_up(const NodalFields<dim> &nodes,
                          const unsigned int      first,
                          const unsigned int      n)
  {
    exchange.start(nodes.node_plan(), records.data(), first, first + n);
    exchange.finish(records.data());
  }



  // A node without volume gets zero: no cell around it has a gradient.
  template <int dim>
  void
  DualDomain<dim>::divide_by_volumes(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const values = record(node);
        const double  volume = values[Layout::volume];
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            {
              double &value = values[Layout::tensor(d, e)];
              value         = volume > 0 ? value / volume : 0;
            }
      }
  }



  template <int dim>
  void
  DualDomain<dim>::clear_stress(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          record(node)[Layout::tensor(d, e)] = 0;
  }



  // Cells with points are listed anew in each step, in the order of the points:
  // the list of occupied cells keeps empty ones for a while, which differs in a
  // run that is resumed.
  template <int dim>
  void
  DualDomain<dim>::find_volumes(
    NodalFields<dim>                                      &nodes,
    const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
  {
    const GridView<dim> view = nodes.view(field);
    if (met.size() == 0)
      met.reinit(nodes.grid.n_cells());
    ++turn;
    cells.clear();
    for (const auto &body : bodies)
      if (body->description.nodal_field == field &&
          !body->description.is_liquid)
        for_each_batch(body->points.view(), [&](const CellBatch &batch) {
          if (batch.cell == invalid_cell || met[batch.cell] == turn)
            return;
          met[batch.cell] = turn;
          cells.push_back(
            {batch.cell,
             weight_of_cell<dim>(view.nodes, view.cells[batch.cell])});
        });

    clear(nodes, Layout::volume, 1);
    for (const auto &[cell, weight] : cells)
      DualDomainCell<dim>(view.cells[cell], weight).add_volumes(records.data());
    sum_up(nodes, Layout::volume, 1);
  }



  template <int dim>
  void
  DualDomain<dim>::add_forces(NodalFields<dim> &nodes)
  {
    sum_up(nodes, 0, n_tensor<dim>);
    divide_by_volumes(nodes);

    clear(nodes, Layout::force, dim);
    const GridView<dim> view = nodes.view(field);
    for (const auto &[cell, weight] : cells)
      DualDomainCell<dim>(view.cells[cell], weight)
        .add_forces_of_stress(records.data());
    sum_up(nodes, Layout::force, dim);
    for (const std::uint32_t node : nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        nodes.record(field, node)[NodeLayout<dim>::force + d] +=
          record(node)[Layout::force + d];
  }



  template <int dim>
  void
  DualDomain<dim>::average_gradients(NodalFields<dim>  &nodes,
                                     const unsigned int slot)
  {
    clear_stress(nodes);
    const GridView<dim> view = nodes.view(field);
    for (const auto &[cell, weight] : cells)
      DualDomainCell<dim>(view.cells[cell], weight)
        .add_mean_gradients(view.nodes, slot, records.data());
    sum_up(nodes, 0, n_tensor<dim>);
    divide_by_volumes(nodes);
  }



  template class DualDomain<2>;
  template class DualDomain<3>;
} // namespace limber
