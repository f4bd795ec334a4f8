// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/surroundings.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  void
  Surroundings<dim>::reinit()
  {
    const NodeTable<dim> &table = grid.vertices;
    holding.reinit(table.n());
    surrounded.reinit(table.n());
    inside.reinit(grid.n_cells());
    cells_at.reinit(table.n());
    std::fill_n(cells_at.data(), table.n(), 0.);
    for (std::uint32_t cell = 0; cell < grid.n_owned_cells(); ++cell)
      add(cells_at, cell);
    const ExchangePlan all(table.shared);
    exchange.start(all, cells_at.data(), 0, 1);
    exchange.finish(cells_at.data());

    masters_of.assign(table.hanging.empty() ? 0 : table.n(), nullptr);
    for (const HangingNode &hanging : table.hanging)
      masters_of[hanging.node] = &hanging;
  }



  template <int dim>
  void
  Surroundings<dim>::find_surrounded(const std::vector<std::uint32_t> &nodes)
  {
    const auto is_full = [&](const std::uint32_t node) {
      return holding[node] == cells_at[node];
    };
    for (const std::uint32_t node : nodes)
      surrounded[node] = is_full(node);
    if (masters_of.empty())
      return;
    for (const std::uint32_t node : nodes)
      if (const HangingNode *const hanging = masters_of[node])
        for (const auto &[master, weight] : hanging->masters)
          surrounded[node] = surrounded[node] && is_full(master);
  }



  template <int dim>
  void
  Surroundings<dim>::find_inside(const std::vector<std::uint32_t> &cells)
  {
    for (const std::uint32_t cell : cells)
      {
        bool is_inside = true;
        for (unsigned int a = 0; a < n_corners; ++a)
          is_inside &= surrounded[node_of(cell, a)];
        inside[cell] = is_inside;
      }
  }



  // Read from the corners of the face there that do not hang; one does not.
  // Each of several smaller neighbours touches one of them: any counts.
  template <int dim>
  bool
  Surroundings<dim>::has_neighbour(const std::uint32_t cell,
                                   const unsigned int  direction,
                                   const unsigned int  end) const
  {
    for (unsigned int a = 0; a < n_corners; ++a)
      if ((a >> direction & 1) == end)
        if (const std::uint32_t node = node_of(cell, a); !hangs(node))
          {
            const unsigned int mate = a ^ 1u << direction;
            if (static_cast<unsigned int>(holding[node]) >> mate & 1)
              return true;
          }
    return false;
  }



  template class Surroundings<2>;
  template class Surroundings<3>;
} // namespace limber
