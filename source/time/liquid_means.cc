// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/liquid_means.h>

#include <algorithm>
#include <map>

namespace limber
{
  namespace
  {
    // Limits of what counts as all of a cell over what is in it: more would
    // make sound faster than the step allows for.
    constexpr double least_share = 0.8, largest_share = 1.25;
  } // namespace



  template <int dim>
  LiquidMeans<dim>::LiquidMeans(const RunParts<dim> &parts)
    : parts(parts)
  {
    std::map<unsigned int, Group> by_field;
    for (auto &body : parts.bodies)
      {
        Group &group = by_field[body->description.nodal_field];
        if (body->description.is_liquid && body->cell_sums &&
            body->stress->projection().kind == Projection::cell)
          group.liquids.push_back(body.get());
        else if (body->cell_sums)
          group.solids.push_back(body.get());
      }
    for (auto &[field, group] : by_field)
      if (!group.liquids.empty())
        {
          group.is_linear = group.liquids.front()->cell_sums->stride == n_nodes;
          if (group.is_linear || group.liquids.size() > 1)
            groups.push_back(std::move(group));
        }
    reinit();
  }



  template <int dim>
  void
  LiquidMeans<dim>::reinit()
  {
    if (groups.empty())
      return;
    around.reinit(parts.nodes.vertices().table.n());
    for (const Group &group : groups)
      for (MaterialBody *const body : group.liquids)
        {
          body->volume_shares.reinit(parts.grid.n_cells());
          std::fill_n(body->volume_shares.data(), parts.grid.n_cells(), 1.);
        }
  }



  template <int dim>
  void
  LiquidMeans<dim>::find()
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (const Group &group : groups)
      {
        if (group.is_linear)
          look_around(group);
        for (const auto *const cells : {&vertices.owned_occupied_cells(),
                                        &vertices.ghost_occupied_cells()})
          for (const std::uint32_t cell : *cells)
            find(group, cell);
      }
  }



  template <int dim>
  bool
  LiquidMeans<dim>::holds(const std::vector<MaterialBody *> &bodies,
                          const std::uint32_t                cell) const
  {
    return std::any_of(bodies.begin(), bodies.end(), [&](auto *const body) {
      return body->cell_sums->view().present_mass(cell) > 0;
    });
  }



  template <int dim>
  void
  LiquidMeans<dim>::look_around(const Group &group)
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (const std::uint32_t node : vertices.active_nodes())
      around[node] = 0;
    for (const std::uint32_t cell : vertices.owned_occupied_cells())
      if (holds(group.liquids, cell) || holds(group.solids, cell))
        for (unsigned int a = 0; a < n_nodes; ++a)
          around[node_of(cell, a)] += 1u << a;
    exchange.start(vertices.node_plan(), around.data(), 0, 1);
    exchange.finish(around.data());
  }



  // A node in the middle of an edge has fewer cells than there are around it.
  template <int dim>
  bool
  LiquidMeans<dim>::is_inside(const std::uint32_t cell) const
  {
    const auto &sides = parts.nodes.vertices().table.sides;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const std::uint32_t node = node_of(cell, a);
        const auto          n =
          __builtin_popcount(static_cast<unsigned int>(around[node]));
        if (n << __builtin_popcount(sides[node]) < int(n_nodes))
          return false;
      }
    return true;
  }



  // Whether there is something, or a side of the grid, before and behind it.
  template <int dim>
  bool
  LiquidMeans<dim>::is_between(const std::uint32_t cell,
                               const unsigned int  direction) const
  {
    const auto &sides = parts.nodes.vertices().table.sides;
    for (const unsigned int end : {0u, 1u})
      {
        // a corner, which is the opposite one of the neighbour
        const unsigned int  a    = end << direction;
        const std::uint32_t node = node_of(cell, a);
        const unsigned int  mate = a ^ 1u << direction;
        if (!(static_cast<unsigned int>(around[node]) >> mate & 1) &&
            !(sides[node] >> (2 * direction + end) & 1))
          return false;
      }
    return true;
  }



  template <int dim>
  void
  LiquidMeans<dim>::find(const Group &group, const std::uint32_t cell)
  {
    in_cell.clear();
    for (MaterialBody *const body : group.liquids)
      {
        const double mass = body->cell_sums->view().present_mass(cell);
        if (mass > 0)
          in_cell.push_back({body,
                             body->cell_sums->record(cell),
                             mass,
                             mass / body->stress->density(),
                             1});
      }
    if (in_cell.size() > 1)
      mix();
    for (const Part &part : in_cell)
      part.body->volume_shares[cell] = part.body->implicit ? 1 : part.share;
    if (!group.is_linear || in_cell.empty() || holds(group.solids, cell))
      return;
    for (unsigned int d = 0; d < dim; ++d)
      if (is_between(cell, d))
        centre(d);
    if (is_inside(cell))
      fill(cell);
  }



  template <int dim>
  void
  LiquidMeans<dim>::mix()
  {
    double volume = 0, compliance = 0;
    for (Part &part : in_cell)
      {
        const double J =
          part.sums[part.body->cell_sums->view().volumetric()] / part.mass;
        part.share = 1 / part.body->stress->volumetric_response(J).stiffness;
        volume += part.volume;
        compliance += part.volume * part.share;
      }
    for (Part &part : in_cell)
      part.share *= volume / compliance;
    const unsigned int n = in_cell.front().body->cell_sums->stride;
    for (unsigned int k = CellSums<dim>::mass + 1; k < n - 1; ++k)
      {
        double mean = 0;
        for (const Part &part : in_cell)
          mean += part.volume / volume * (part.sums[k] / part.mass);
        for (const Part &part : in_cell)
          part.sums[k] = part.mass * mean;
      }
  }



  // Along a direction, the means over the cell: of all monomials that have it.
  template <int dim>
  void
  LiquidMeans<dim>::centre(const unsigned int direction)
  {
    const unsigned int bit = 1u << direction;
    for (const Part &part : in_cell)
      for (unsigned int k = bit; k < n_nodes - 1; ++k)
        if (k & bit)
          part.sums[k] = 0.5 * part.sums[k ^ bit];
  }



  // What is in the cell counts as all of it.
  template <int dim>
  void
  LiquidMeans<dim>::fill(const std::uint32_t cell)
  {
    double room = 1, filled = 0;
    for (int d = 0; d < dim; ++d)
      room /= parts.grid.geometry[cell].inverse_edge[d];
    for (const Part &part : in_cell)
      filled += part.sums[n_nodes - 1] * (part.volume / part.mass); // J V
    const double share =
      std::min(std::max(room / filled, least_share), largest_share);
    for (const Part &part : in_cell)
      part.body->volume_shares[cell] *= share;
  }



  template class LiquidMeans<2>;
  template class LiquidMeans<3>;
} // namespace limber
