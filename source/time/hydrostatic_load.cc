// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/contact.h>
#include <limber/time/hydrostatic_load.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  HydrostaticLoad<dim>::HydrostaticLoad(const Problem<dim>        &problem,
                                        const BackgroundGrid<dim> &grid,
                                        const Bodies              &bodies)
    : problem(problem)
    , grid(grid)
    , surroundings(grid)
    , on_masters(n_nodal_fields(problem))
  {
    if (!grid.has_levels() || problem.loads.gravity.norm() == 0 ||
        grid.description.kernel != KernelKind::linear)
      return;
    for (const auto &body : bodies)
      if (body->cell_sums && body->description.is_liquid &&
          body->stress->treatment().kind == Treatment::cell)
        liquids.push_back(body.get());
      else if (body->cell_sums)
        others.push_back(body.get());
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::reinit()
  {
    const NodeTable<dim> &table = grid.vertices;
    surroundings.reinit();
    sums.reinit(std::size_t(table.n()) * dim);
    for (auto &forces : on_masters)
      forces.assign(table.masters.size(), {});
    std::vector<bool> is_uneven(table.n(), false);
    for (const std::uint32_t node : table.masters)
      is_uneven[node] = true;
    for (const HangingNode &hanging : table.hanging)
      is_uneven[hanging.node] = true;
    cells.clear();
    for (std::uint32_t cell = 0; cell < grid.n_owned_cells(); ++cell)
      for (unsigned int a = 0; a < n_corners; ++a)
        if (is_uneven[surroundings.node_of(cell, a)])
          {
            cells.push_back(cell);
            break;
          }
  }



  template <int dim>
  bool
  HydrostaticLoad<dim>::holds_liquid_alone(const unsigned int  field,
                                           const std::uint32_t cell) const
  {
    const auto is_there = [&](MaterialBody<dim> *const body) {
      return body->description.nodal_field == field &&
             body->cell_sums->view().present_mass(cell) > 0;
    };
    return std::any_of(liquids.begin(), liquids.end(), is_there) &&
           std::none_of(others.begin(), others.end(), is_there);
  }



  // rho V / (12 2^(dim - 2)), kg. Filled to the share f from one side, it has
  // f^3 of that.
  template <int dim>
  double
  HydrostaticLoad<dim>::weight_within(const unsigned int  field,
                                      const std::uint32_t cell) const
  {
    double mass = 0, filled = 0; // m^3
    for (MaterialBody<dim> *const body : liquids)
      if (body->description.nodal_field == field)
        {
          const auto view = body->cell_sums->view();
          mass += view.present_mass(cell);
          filled += body->cell_sums->record(cell)[view.volumetric()] /
                    body->stress->density();
        }
    double volume = 1;
    for (unsigned int d = 0; d < dim; ++d)
      volume /= grid.geometry[cell].inverse_edge[d];
    const double share =
      surroundings.is_inside(cell) ? 1 : std::min(1., filled / volume);
    return mass / filled * volume * share * share * share /
           (12 * (1 << (dim - 2)));
  }



  // sum_(e /= d) s_ad s_ae g_e h_e / h_d, m/s^2. Halves of cells have the
  // proportions of the whole.
  template <int dim>
  double
  HydrostaticLoad<dim>::shape(const unsigned int a, const unsigned int d) const
  {
    const auto &inverse_edge = grid.geometry.front().inverse_edge;
    double      result       = 0;
    for (unsigned int e = 0; e < dim; ++e)
      if (e != d)
        result += ((a >> d & 1) == (a >> e & 1) ? 1 : -1) *
                  problem.loads.gravity[e] * inverse_edge[d] / inverse_edge[e];
    return result;
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::find(const NodalFields<dim> &nodes)
  {
    for (unsigned int field = 0; field < on_masters.size(); ++field)
      find(nodes, field);
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::find(const NodalFields<dim> &nodes,
                             const unsigned int      field)
  {
    const NodeTable<dim> &table = grid.vertices;
    surroundings.find(nodes, [&](const std::uint32_t cell) {
      return holds_liquid_alone(field, cell);
    });
    const auto of_node = [&](const std::uint32_t node) {
      return sums.data() + std::size_t(node) * dim;
    };
    for (const auto *const all : {&nodes.active_nodes(), &table.masters})
      for (const std::uint32_t node : *all)
        std::fill_n(of_node(node), dim, 0.);
    for (const HangingNode &hanging : table.hanging)
      std::fill_n(of_node(hanging.node), dim, 0.);

    for (const std::uint32_t cell : cells)
      {
        if (!holds_liquid_alone(field, cell))
          continue;
        const double weight = weight_within(field, cell);
        for (unsigned int d = 0; d < dim; ++d)
          for (const unsigned int end : {0, 1})
            if (surroundings.has_neighbour(cell, d, end))
              for (unsigned int a = 0; a < n_corners; ++a)
                if ((a >> d & 1) == end)
                  of_node(surroundings.node_of(cell, a))[d] +=
                    weight * shape(a, d);
      }
    table.give_to_masters(sums.data(), dim, 0, dim);
    exchange.start(nodes.node_plan(), sums.data(), 0, dim);
    exchange.finish(sums.data());

    for (std::size_t k = 0; k < table.masters.size(); ++k)
      for (unsigned int d = 0; d < dim; ++d)
        on_masters[field][k][d] = of_node(table.masters[k])[d];
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::add(const unsigned int field,
                            LazyArray<double> &forces) const
  {
    const auto &masters = grid.vertices.masters;
    for (std::size_t k = 0; k < masters.size(); ++k)
      for (unsigned int d = 0; d < dim; ++d)
        forces[std::size_t(masters[k]) * dim + d] += on_masters[field][k][d];
  }



  template class HydrostaticLoad<2>;
  template class HydrostaticLoad<3>;
} // namespace limber
