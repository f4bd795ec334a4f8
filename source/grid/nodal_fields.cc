// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/nodal_fields.h>
#include <limber/grid/spline_nodes.h>

#include <algorithm>
#include <limits>

namespace limber
{
  template <int dim>
  NodalFields<dim>::NodalFields(const BackgroundGrid<dim> &grid)
    : NodalFields(grid, grid.nodes())
  {
    if (&table != &grid.vertices)
      of_vertices.reset(new NodalFields(grid, grid.vertices));
  }



  template <int dim>
  NodalFields<dim>::NodalFields(const BackgroundGrid<dim> &grid,
                                const NodeTable<dim>      &table)
    : grid(grid)
    , table(table)
    , nodes_to_share(table.shared)
    , cells_to_share(grid.shared_cells)
  {
    reinit();
  }



  template <int dim>
  template <class Work>
  void
  NodalFields<dim>::for_each_node(const std::uint32_t cell,
                                  const Work         &work) const
  {
    const auto of_all = [&](const auto &offsets) {
      for (const std::uint32_t offset : offsets)
        if (offset != unknown_node)
          work(offset / Layout::stride);
    };
    if (&table != &grid.vertices)
      of_all(grid.quadratics[cell].node);
    else if (grid.description.kernel == KernelKind::cubic)
      of_all(grid.cubics[cell].node);
    else
      of_all(grid.geometry[cell].node);
  }



  template <int dim>
  void
  NodalFields<dim>::reinit()
  {
    forget_fields();
    for (unsigned int field = 0; field < n_fields(); ++field)
      of_field(field).reinit(std::size_t(table.n()) * Layout::stride);
    has_own_points.reinit(grid.n_cells());
    is_occupied.reinit(grid.n_cells());
    is_active.reinit(table.n());
    nodes_to_share = ExchangePlan(table.shared);
    cells_to_share = ExchangePlan(grid.shared_cells);
    find_roles();
    // Lists refer to node numbers of the former mesh.
    with_own_points.clear();
    occupied_owned.clear();
    occupied_ghost.clear();
    entered.clear();
    active.clear();
    active_boundary.clear();
    set_occupied({});
    for (FieldPlaces &places : of_fields)
      {
        places.has_cell.reinit(grid.n_cells());
        places.has_node.reinit(table.n());
      }
    if (of_vertices)
      of_vertices->reinit();
  }



  template <int dim>
  void
  NodalFields<dim>::find_roles()
  {
    roles.reinit(table.n());
    border_cells.clear();
    if (table.shared.neighbours.empty())
      return;
    for (const std::uint32_t node : nodes_to_share.received)
      roles[node] = is_shared;
    for (std::uint32_t cell = 0; cell < grid.n_owned_cells(); ++cell)
      for_each_node(cell, [&](const std::uint32_t node) {
        roles[node] |= is_of_owned_cell;
      });
    // A hanging node passes contributions on to its masters.
    for (const HangingNode &hanging : table.hanging)
      for (const auto &[master, weight] : hanging.masters)
        {
          roles[hanging.node] |= roles[master] & is_shared;
          roles[master] |= roles[hanging.node] & is_of_owned_cell;
        }
    for (std::uint32_t cell = 0; cell < grid.n_cells(); ++cell)
      if (is_at_border(cell))
        border_cells.push_back(cell);
  }



  template <int dim>
  void
  NodalFields<dim>::set_n_fields(const unsigned int n)
  {
    select(0);
    parked.resize(n);
    for (unsigned int field = 1; field < n; ++field)
      parked[field].reinit(std::size_t(table.n()) * Layout::stride);
    forget_fields();
    of_fields.clear();
    of_fields.resize(n > 1 ? n : 0);
    for (FieldPlaces &places : of_fields)
      {
        places.has_cell.reinit(grid.n_cells());
        places.has_node.reinit(table.n());
      }
  }



  template <int dim>
  bool
  NodalFields<dim>::begin_noting()
  {
    const bool anew = !is_noted;
    if (!notes_fields())
      return anew;
    // Shared nodes are in all fields: other ranks may contribute.
    if (anew || noted_version != version)
      for (const auto &neighbour : nodes_to_share.neighbours)
        for (const auto *const shared : {&neighbour.send, &neighbour.receive})
          for (const std::uint32_t node : *shared)
            for (unsigned int field = 0; field < n_fields(); ++field)
              add_node(field, node);
    noted_version = version;
    is_noted      = true;
    return anew;
  }



  template <int dim>
  void
  NodalFields<dim>::add_cell(const unsigned int field, const std::uint32_t cell)
  {
    of_fields[field].has_cell[cell] = 1;
    of_fields[field].cells.push_back(cell);
    for_each_node(cell,
                  [&](const std::uint32_t node) { add_node(field, node); });
  }



  template <int dim>
  void
  NodalFields<dim>::add_node(const unsigned int field, const std::uint32_t node)
  {
    if (of_fields[field].has_node[node])
      return;
    unsigned int n_others = 0;
    for (const FieldPlaces &places : of_fields)
      n_others += places.has_node[node];
    if (n_others == 1)
      of_two_fields.push_back(node);
    of_fields[field].has_node[node] = 1;
    of_fields[field].nodes.push_back(node);
  }



  template <int dim>
  void
  NodalFields<dim>::forget_fields()
  {
    for (FieldPlaces &places : of_fields)
      {
        for (const std::uint32_t cell : places.cells)
          places.has_cell[cell] = 0;
        for (const std::uint32_t node : places.nodes)
          places.has_node[node] = 0;
        places.cells.clear();
        places.nodes.clear();
      }
    of_two_fields.clear();
    is_noted = false;
  }



  template <int dim>
  void
  NodalFields<dim>::select(const unsigned int field)
  {
    if (field == selected)
      return;
    parked[selected] = std::move(values);
    values           = std::move(parked[field]);
    selected         = field;
  }



  template <int dim>
  GridView<dim>
  NodalFields<dim>::view(const unsigned int field)
  {
    GridView<dim> result = view();
    result.nodes         = of_field(field).data();
    return result;
  }



  template <int dim>
  GridView<dim>
  NodalFields<dim>::view()
  {
    GridView<dim> result = grid.view();
    if (&table == &grid.vertices)
      result.quadratics = nullptr;
    result.nodes         = values.data();
    result.occupied      = has_own_points.data();
    result.entered       = &entered;
    result.left          = &left;
    result.is_in_ghosts  = &in_ghosts;
    result.n_owned_cells = grid.n_owned_cells();
    return result;
  }



  template <int dim>
  void
  NodalFields<dim>::set_occupied(std::vector<std::uint32_t> &&cells,
                                 const bool                   agree)
  {
    // Records of deactivated nodes are zeroed, so that a node without mass is
    // empty.
    clear();
    for (const auto *const former : {&with_own_points, &entered})
      for (const std::uint32_t cell : *former)
        has_own_points[cell] = 0;
    for (const auto *const former : {&occupied_owned, &occupied_ghost})
      for (const std::uint32_t cell : *former)
        is_occupied[cell] = 0;
    for (const std::uint32_t node : active)
      is_active[node] = 0;
    forget_fields();
    occupied_owned.clear();
    occupied_ghost.clear();
    entered.clear();
    active.clear();
    active_boundary.clear();

    if (of_vertices)
      of_vertices->set_occupied(std::vector<std::uint32_t>(cells), agree);
    with_own_points = std::move(cells);
    for (const std::uint32_t cell : with_own_points)
      has_own_points[cell] = 1;
    if (agree)
      plan_sums();
    for (const std::uint32_t cell : with_own_points)
      activate(cell);
    activate_agreed();
    ++version;
  }



  template <int dim>
  void
  NodalFields<dim>::add_entered()
  {
    if (entered.empty())
      return;
    if (of_vertices)
      of_vertices->set_entered(entered);
    set_entered(entered);
    entered.clear();
  }



  template <int dim>
  void
  NodalFields<dim>::set_entered(const std::vector<std::uint32_t> &cells)
  {
    for (const std::uint32_t cell : cells)
      {
        has_own_points[cell] = 1;
        with_own_points.push_back(cell);
        activate(cell);
      }
    activate_masters();
    ++version;
  }



  template <int dim>
  bool
  NodalFields<dim>::is_at_border(const std::uint32_t cell) const
  {
    bool result = false;
    for_each_node(cell, [&](const std::uint32_t node) {
      result |= (roles[node] & is_shared) != 0;
    });
    return result;
  }



  template <int dim>
  bool
  NodalFields<dim>::has_entered_shared() const
  {
    return std::any_of(entered.begin(), entered.end(), [&](const auto cell) {
      return is_at_border(cell);
    });
  }



  template <int dim>
  void
  NodalFields<dim>::agree_on_sums()
  {
    plan_sums();
    activate_agreed();
    if (of_vertices)
      of_vertices->agree_on_sums();
  }



  template <int dim>
  void
  NodalFields<dim>::plan_sums()
  {
    if (table.shared.neighbours.empty())
      return;

    // The owner needs the sums of a cell even if only others have its points.
    cells_to_share = ExchangePlan(
      grid.shared_cells,
      [&](const auto cell) { return has_own_points[cell] != 0; },
      [&](const auto cell) {
        return has_own_points[cell] || cell < grid.n_owned_cells();
      });

    for (const auto &neighbour : table.shared.neighbours)
      for (const std::uint32_t node : neighbour.records)
        roles[node] &= ~may_be_added_to;
    for (const HangingNode &hanging : table.hanging)
      roles[hanging.node] &= ~may_be_added_to;
    const auto may_get_sums = [&](const std::uint32_t cell) {
      for_each_node(cell, [&](const std::uint32_t node) {
        roles[node] |= may_be_added_to;
      });
    };
    for (const std::uint32_t cell : border_cells)
      if (has_own_points[cell])
        may_get_sums(cell);
    for (const std::uint32_t cell : cells_to_share.received)
      may_get_sums(cell);
    for (const HangingNode &hanging : table.hanging)
      for (const auto &[master, weight] : hanging.masters)
        roles[master] |= roles[hanging.node] & may_be_added_to;

    nodes_to_share = ExchangePlan(
      table.shared,
      [&](const auto node) { return (roles[node] & may_be_added_to) != 0; },
      [&](const auto node) {
        return (roles[node] & (may_be_added_to | is_of_owned_cell)) != 0;
      });
  }



  // Other ranks may contribute to these without this rank knowing, or expect
  // its contribution, which must be zero if it has no points there any more.
  template <int dim>
  void
  NodalFields<dim>::activate_agreed()
  {
    for (const auto &neighbour : cells_to_share.neighbours)
      for (const auto *const cells : {&neighbour.send, &neighbour.receive})
        for (const std::uint32_t cell : *cells)
          activate(cell);
    for (const auto &neighbour : nodes_to_share.neighbours)
      for (const auto *const records : {&neighbour.send, &neighbour.receive})
        for (const std::uint32_t node : *records)
          activate_node(node);
    activate_masters();
    ++version;
  }



  template <int dim>
  void
  NodalFields<dim>::activate(const std::uint32_t cell)
  {
    if (is_occupied[cell])
      return;
    is_occupied[cell] = 1;
    (cell < grid.n_owned_cells() ? occupied_owned : occupied_ghost)
      .push_back(cell);
    for_each_node(cell, [&](const std::uint32_t node) { activate_node(node); });
  }



  template <int dim>
  void
  NodalFields<dim>::activate_node(const std::uint32_t node)
  {
    if (is_active[node])
      return;
    is_active[node] = 1;
    active.push_back(node);
    if (table.sides[node])
      active_boundary.push_back(node);
  }



  // Masters of hanging nodes may be outside of all occupied cells.
  template <int dim>
  void
  NodalFields<dim>::activate_masters()
  {
    for (const HangingNode &hanging : table.hanging)
      if (is_active[hanging.node])
        for (const auto &[master, weight] : hanging.masters)
          activate_node(master);
  }



  template <int dim>
  void
  NodalFields<dim>::clear()
  {
    left = in_ghosts = false;
    for_each_field([&]() {
      for (const std::uint32_t node : active_nodes_of_field())
        std::fill_n(record(node), Layout::stride, 0.);
    });
  }



  template <int dim>
  void
  NodalFields<dim>::start_sum(const unsigned int first, const unsigned int last)
  {
    // The condensation is linear, so every rank condenses its own
    // contributions. Most hanging nodes are in empty cells and inactive.
    for (const HangingNode &hanging : table.hanging)
      if (is_active[hanging.node])
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
    for (const HangingNode &hanging : table.hanging)
      if (is_active[hanging.node])
        {
          double *const to = record(hanging.node);
          std::fill(to + 1, to + Layout::stride, 0.);
          for (const auto &[master, weight] : hanging.masters)
            for (unsigned int k = 1; k < Layout::stride; ++k)
              to[k] += weight * record(master)[k];
        }
  }



  template <int dim>
  void
  NodalFields<dim>::lend_mass_to_hanging()
  {
    for (const HangingNode &hanging : table.hanging)
      if (is_active[hanging.node])
        {
          double least = std::numeric_limits<double>::infinity();
          for (const auto &[master, weight] : hanging.masters)
            least = std::min(least, record(master)[Layout::mass]);
          record(hanging.node)[Layout::mass] = least;
        }
  }



  template <int dim>
  void
  NodalFields<dim>::take_mass_from_hanging()
  {
    for (const HangingNode &hanging : table.hanging)
      if (is_active[hanging.node])
        record(hanging.node)[Layout::mass] = 0;
  }



  template class NodalFields<2>;
  template class NodalFields<3>;
} // namespace limber
