// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/contact.h>
#include <limber/time/cut_cells.h>
#include <limber/time/hydrostatic_load.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // The load acts in full where the sum of the pressures around a node over
    // the weight of a cell is at least this; at rest it is two and more below a
    // surface.
    constexpr double fully_borne = 0.5;

    // Limit of the acceleration of a node by its load in semi-implicit steps,
    // over gravity.
    constexpr double most_of_gravity = 100;
  } // namespace



  template <int dim>
  HydrostaticLoad<dim>::HydrostaticLoad(const Problem<dim>        &problem,
                                        const BackgroundGrid<dim> &grid,
                                        const Bodies              &bodies,
                                        CutCells<dim> *const       cut_cells)
    : problem(problem)
    , grid(grid)
    , cut_cells(cut_cells)
    , surroundings(grid)
    , of_fields(n_nodal_fields(problem))
  {
    if (problem.loads.gravity.norm() == 0 ||
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
    surroundings.reinit();
    sums.reinit(std::size_t(grid.vertices.n()) * dim);
    at_surface.reinit(grid.vertices.n());
    pressures.reinit(grid.vertices.n());
    find_uneven_nodes();
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::find_uneven_nodes()
  {
    const NodeTable<dim> &table = grid.vertices;
    if (cut_cells)
      version = cut_cells->version();
    is_uneven.assign(table.n(), false);
    for (const std::uint32_t node : table.masters)
      is_uneven[node] = true;
    for (const HangingNode &hanging : table.hanging)
      is_uneven[hanging.node] = true;
    if (cut_cells && cut_cells->any())
      for (std::uint32_t node = 0; node < table.n(); ++node)
        if (cut_cells->is_cut(node))
          is_uneven[node] = true;
  }



  template <int dim>
  bool
  HydrostaticLoad<dim>::knows_cut_cells(const unsigned int field) const
  {
    return cut_cells != nullptr && cut_cells->any() && cut_cells->knows(field);
  }



  template <int dim>
  bool
  HydrostaticLoad<dim>::holds_liquid_alone(const unsigned int  field,
                                           const std::uint32_t cell) const
  {
    const auto is_there = [&](MaterialBody<dim> *const body) {
      return body->description.nodal_field == field &&
             body->cell_sums->present_mass(cell) > 0;
    };
    return std::any_of(liquids.begin(), liquids.end(), is_there) &&
           std::none_of(others.begin(), others.end(), is_there);
  }



  // rho, times f^3 where a cell is filled to the fraction f from one side, as
  // the force is then smaller by that factor.
  template <int dim>
  double
  HydrostaticLoad<dim>::density_within(const unsigned int  field,
                                       const std::uint32_t cell,
                                       const double        open) const
  {
    double mass = 0, filled = 0; // m^3
    for (MaterialBody<dim> *const body : liquids)
      if (body->description.nodal_field == field)
        {
          mass += body->cell_sums->present_mass(cell);
          filled +=
            body->cell_sums->present_volumetric(cell) / body->stress->density();
        }
    double volume = open;
    for (unsigned int d = 0; d < dim; ++d)
      volume /= grid.geometry[cell].inverse_edge[d];
    const double share =
      surroundings.is_inside(cell) ? 1 : std::min(1., filled / volume);
    return mass / filled * share * share * share;
  }



  // Mean pressure of the liquids in a cell over their density, m^2/s^2.
  template <int dim>
  double
  HydrostaticLoad<dim>::pressure_over_density(const unsigned int  field,
                                              const std::uint32_t cell) const
  {
    double mass = 0, pressure = 0; // the last times the volume
    for (MaterialBody<dim> *const body : liquids)
      if (body->description.nodal_field == field)
        if (const double of_body = body->cell_sums->present_mass(cell))
          {
            const double J =
              body->cell_sums->present_volumetric(cell) / of_body;
            mass += of_body;
            pressure += of_body / body->stress->density() *
                        body->stress->volumetric_response(J).pressure;
          }
    return pressure / mass;
  }



  // Mean pressure of the liquids in a cell over the sum of rho |g_d| h_d over
  // directions; 0 in tension.
  template <int dim>
  double
  HydrostaticLoad<dim>::pressure_over_weight(const unsigned int  field,
                                             const std::uint32_t cell) const
  {
    double drop = 0;
    for (unsigned int d = 0; d < dim; ++d)
      drop += std::abs(problem.loads.gravity[d]) /
              grid.geometry[cell].inverse_edge[d];
    return std::max(pressure_over_density(field, cell) / drop, 0.);
  }



  // Sums of pressure_over_weight() over the cells around each node.
  template <int dim>
  void
  HydrostaticLoad<dim>::find_pressures(const NodalFields<dim> &nodes,
                                       const unsigned int      field)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      pressures[node] = 0;
    for (const std::uint32_t cell : marked_cells)
      {
        const double of_cell = pressure_over_weight(field, cell);
        for (unsigned int a = 0; a < n_corners; ++a)
          pressures[surroundings.node_of(cell, a)] += of_cell;
      }
    exchange_of_one.start(nodes.node_plan(), pressures.data(), 0, 1);
    exchange_of_one.finish(pressures.data());
  }



  // Fraction of the load that acts in a cell, by the largest sum of pressures
  // at its nodes. At rest that is several times fully_borne, so that sound
  // waves change nothing: a force that followed the pressure would amplify
  // them.
  template <int dim>
  double
  HydrostaticLoad<dim>::borne_share(const std::uint32_t cell) const
  {
    double most = 0;
    for (unsigned int a = 0; a < n_corners; ++a)
      most = std::max(most, pressures[surroundings.node_of(cell, a)]);
    return std::min(1., most / fully_borne);
  }



  // V / (12 2^(dim - 2)) sum_(e /= d) s_ad s_ae g_e h_e / h_d, m^(dim+1)/s^2.
  template <int dim>
  double
  HydrostaticLoad<dim>::of_whole_cell(const std::uint32_t cell,
                                      const unsigned int  a,
                                      const unsigned int  d) const
  {
    const auto &inverse_edge = grid.geometry[cell].inverse_edge;
    double      volume = 1, result = 0;
    for (unsigned int e = 0; e < dim; ++e)
      {
        volume /= inverse_edge[e];
        if (e != d)
          result += ((a >> d & 1) == (a >> e & 1) ? 1 : -1) *
                    problem.loads.gravity[e] * inverse_edge[d] /
                    inverse_edge[e];
      }
    return volume * result / (12 * (1 << (dim - 2)));
  }



  // Whether a face is horizontal and on top, as a free surface at rest would
  // be; in semi-implicit steps only.
  template <int dim>
  bool
  HydrostaticLoad<dim>::is_level(const unsigned int direction,
                                 const unsigned int end) const
  {
    if (problem.method.integration != TimeIntegration::semi_implicit)
      return false;
    const double up = -problem.loads.gravity[direction] * (end == 1 ? 1 : -1);
    return up > 0.99 * problem.loads.gravity.norm();
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::find(const NodalFields<dim> &nodes)
  {
    if (cut_cells && version != cut_cells->version())
      find_uneven_nodes();
    for (unsigned int field = 0; field < of_fields.size(); ++field)
      find(nodes, field);
  }



  // Count for each node the cells at a surface around it, which may be partly
  // filled. Elsewhere, but at uneven nodes, the forces cancel.
  template <int dim>
  void
  HydrostaticLoad<dim>::mark_nodes(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      at_surface[node] = 0;
    for (const std::uint32_t cell : nodes.owned_occupied_cells())
      if (!surroundings.is_inside(cell))
        for (unsigned int a = 0; a < n_corners; ++a)
          at_surface[surroundings.node_of(cell, a)] += 1;
    exchange_of_one.start(nodes.node_plan(), at_surface.data(), 0, 1);
    exchange_of_one.finish(at_surface.data());
  }



  template <int dim>
  void
  HydrostaticLoad<dim>::find(const NodalFields<dim> &nodes,
                             const unsigned int      field)
  {
    const NodeTable<dim> &table = grid.vertices;
    const bool            knows = knows_cut_cells(field);
    surroundings.find(
      nodes,
      [&](const std::uint32_t cell) { return holds_liquid_alone(field, cell); },
      knows ? cut_cells->covered_corners() : nullptr);
    const auto of_node = [&](const std::uint32_t node) {
      return sums.data() + std::size_t(node) * dim;
    };
    for (const auto *const all : {&nodes.active_nodes(), &table.masters})
      for (const std::uint32_t node : *all)
        std::fill_n(of_node(node), dim, 0.);
    for (const HangingNode &hanging : table.hanging)
      std::fill_n(of_node(hanging.node), dim, 0.);

    mark_nodes(nodes);
    marked_cells.clear();
    for (const std::uint32_t cell : nodes.owned_occupied_cells())
      if (has_marked_node(cell) && holds_liquid_alone(field, cell))
        marked_cells.push_back(cell);
    find_pressures(nodes, field);
    for (const std::uint32_t cell : marked_cells)
      {
        if (knows && cut_cells->is_covered(cell))
          continue;
        const auto *const cut = knows ? cut_cells->cell(cell) : nullptr;
        if (cut && !cut->surfaces.empty() && !cut_cells->wets(cell, field))
          continue;
        const double density = density_within(field, cell, cut ? cut->open : 1);
        const double borne   = borne_share(cell);
        for (unsigned int d = 0; d < dim; ++d)
          for (const unsigned int end : {0, 1})
            if (surroundings.has_neighbour(cell, d, end) ||
                (cut && is_level(d, end)))
              for (unsigned int a = 0; a < n_corners; ++a)
                if (const auto node = surroundings.node_of(cell, a);
                    (a >> d & 1) == end && is_marked(node))
                  of_node(node)[d] +=
                    density * (is_uneven[node] ? 1 : borne) *
                    (cut ? cut->hydrostatic[a][d] : of_whole_cell(cell, a, d));
        if (cut && cut->is_beside_tip)
          for (unsigned int a = 0; a < n_corners; ++a)
            for (unsigned int d = 0; d < dim; ++d)
              of_node(surroundings.node_of(cell, a))[d] +=
                density * pressure_over_density(field, cell) *
                cut->beside_tips[a][d];
      }
    table.give_to_masters(sums.data(), dim, 0, dim);
    exchange.start(nodes.node_plan(), sums.data(), 0, dim);
    exchange.finish(sums.data());

    auto &[loaded, on_loaded] = of_fields[field];
    loaded.clear();
    on_loaded.clear();
    for (const std::uint32_t node : nodes.active_nodes())
      {
        dealii::Tensor<1, dim> force;
        for (unsigned int d = 0; d < dim; ++d)
          force[d] = of_node(node)[d];
        if (force.norm_square() > 0)
          {
            loaded.push_back(node);
            on_loaded.push_back(force);
          }
      }
  }



  // In semi-implicit steps the load of a node is limited by its mass. If points
  // have just entered a cell, the nodes on its far side have next to no mass;
  // the load of the cell would throw these out, and in so long steps, by the
  // velocity gradient, the points as well.
  template <int dim>
  void
  HydrostaticLoad<dim>::add(const NodalFields<dim> &nodes,
                            const unsigned int      field,
                            LazyArray<double>      &forces) const
  {
    const bool is_limited =
      problem.method.integration == TimeIntegration::semi_implicit;
    const double most = most_of_gravity * problem.loads.gravity.norm();
    const auto &[loaded, on_loaded] = of_fields[field];
    for (std::size_t k = 0; k < loaded.size(); ++k)
      {
        const double bearable =
          most * nodes.record(field, loaded[k])[NodeLayout<dim>::mass];
        const double force = on_loaded[k].norm();
        const double share =
          is_limited && force > bearable ? bearable / force : 1;
        for (unsigned int d = 0; d < dim; ++d)
          forces[std::size_t(loaded[k]) * dim + d] += share * on_loaded[k][d];
      }
  }



  template class HydrostaticLoad<2>;
  template class HydrostaticLoad<3>;
} // namespace limber
