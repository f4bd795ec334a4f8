// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/grid/node_places.h>
#include <limber/time/explicit_integrator.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace limber
{
  namespace
  {
    /** Problem::meets_sides() for each nodal field. */
    template <int dim>
    std::vector<bool>
    fields_that_meet_sides(const Problem<dim> &problem)
    {
      std::vector<bool> result(n_nodal_fields(problem));
      for (unsigned int field = 0; field < result.size(); ++field)
        result[field] = problem.meets_sides(field);
      return result;
    }
  } // namespace



  template <int dim>
  ExplicitIntegrator<dim>::ExplicitIntegrator(const RunParts<dim> &parts)
    : parts(parts)
    , parallel(
        dealii::Utilities::MPI::n_mpi_processes(parts.grid.communicator) > 1)
    , in_initial_frame(std::all_of(parts.bodies.begin(),
                                   parts.bodies.end(),
                                   [](const auto &body) {
                                     return body->stress->gives_force();
                                   }))
    , moves_as_strained(parts.problem.grid.kernel != KernelKind::linear &&
                        parts.problem.method.transfer != Transfer::apic &&
                        std::any_of(parts.bodies.begin(),
                                    parts.bodies.end(),
                                    [](const auto &body) {
                                      return !body->description.is_liquid;
                                    }))
    , covered(parts.problem.obstacles, parts.problem.grid)
    , boundaries(parts.problem.sides,
                 fields_that_meet_sides(parts.problem),
                 covered.if_any())
    , cut_cells(CutCells<dim>::may_be(parts) ?
                  std::make_optional<CutCells<dim>>(parts) :
                  std::nullopt)
    , loads(parts.problem,
            parts.grid,
            parts.bodies,
            cut_cells ? &*cut_cells : nullptr)
    , sweeps(parts)
    , liquid_means(parts, cut_cells ? &*cut_cells : nullptr)
    , stabilization(parts)
    , density_control(parts, liquid_means, cut_cells ? &*cut_cells : nullptr)
    , relocation(parts, loads)
    , shifting(parts, cut_cells ? &*cut_cells : nullptr)
  {
    if (const unsigned int n = n_nodal_fields(parts.problem); n > 1)
      {
        parts.nodes.set_n_fields(n);
        contact.emplace(parts);
      }
    if (parts.problem.has_rigid_contact())
      obstacles.emplace(parts,
                        cut_cells ? &*cut_cells : nullptr,
                        leapfrogs(),
                        covered.if_any());
    if (cut_cells && parts.nodes.n_fields() == 1 &&
        std::all_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.is_liquid;
                    }))
      surfaces.emplace(parts, *cut_cells);
    if (filters_velocity(parts.problem.method.transfer))
      full_mass.emplace(parts.grid, boundaries, parts.nodes.n_fields());
    find_speeds();
    relocation.reinit();
  }



  // Bound of the displacement of points in the step, m, as the largest of three
  // measures: in the initial frame displacements of points are not measured,
  // and fastest_node leaves out nodes with hardly any mass.
  template <int dim>
  double
  ExplicitIntegrator<dim>::longest_way() const
  {
    double edge = 0; // the longest of a cell
    for (int d = 0; d < dim; ++d)
      edge = std::max(edge, parts.problem.grid.edge(d));
    return std::max({extremes.displacement * edge,
                     fastest_node * parts.grid.smallest_edge,
                     point_speed * step});
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::find_speeds()
  {
    for (const auto &body : parts.bodies)
      {
        viscosity =
          std::max(viscosity,
                   body->stress->viscosity() / body->stress->density());
        const PointView<dim> points = body->points.view();
        extremes.wave_squared =
          std::max(extremes.wave_squared,
                   body->implicit ?
                     body->stress->deviatoric_wave_speed_squared(points) :
                     body->stress->wave_speed_squared(points));
        for (std::size_t p = 0; p < points.size; ++p)
          {
            double squared = 0;
            for (int d = 0; d < dim; ++d)
              squared += points.velocity[d][p] * points.velocity[d][p];
            extremes.speed_squared = std::max(extremes.speed_squared, squared);
          }
      }
    relocation.reduce(extremes);
    wave_speed  = std::sqrt(extremes.wave_squared);
    point_speed = std::sqrt(extremes.speed_squared);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::reinit()
  {
    parts.nodes.reinit();
    keeps_velocity = false;
    sweeps.reinit();
    if (full_mass)
      full_mass->reinit();
    if (contact)
      contact->reinit();
    if (cut_cells)
      cut_cells->reinit(time);
    if (obstacles)
      obstacles->reinit();
    if (surfaces)
      surfaces->reinit();
    for (auto &body : parts.bodies)
      body->reinit_sums(parts.grid);
    liquid_means.reinit();
    density_control.reinit();
    shifting.reinit();
    loads.reinit();
    relocation.reinit();
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::advance(const double now, const double length)
  {
    time = now;
    step = length;
    stopwatch.start();

    clear();
    covered.find(time);
    if (cut_cells)
      cut_cells->find(time);
    liquid_means.find();
    loads.look_at_cells(parts.nodes.vertices());
    lap(Verb::stabilize);
    control_checkerboards();
    do_scheme();
    relocation.end_step(extremes,
                        obstacles ? obstacles->put_out(time, step) : 0);
    shifting.follow(extremes.displacement);
    wave_speed  = std::sqrt(extremes.wave_squared);
    point_speed = std::sqrt(extremes.speed_squared);
    if (obstacles)
      obstacles->approach(longest_way());
    lap(Verb::relocate);
    return step;
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::reorganise(const double now)
  {
    stopwatch.start();
    const bool exchanged = relocation.reorganise(extremes.displacement);
    const bool spread    = spread_points(now);
    lap(Verb::relocate);
    return exchanged || (spread && parallel);
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::spread_points(const double now)
  {
    if (!shifting.is_due())
      return false;
    if (parallel)
      relocation.exchange_points();
    if (cut_cells)
      cut_cells->find(now);
    shifting.shift();
    // as Relocation::bring_points_home()
    if (parallel && parts.grid.reaches_beyond_cells())
      relocation.exchange_points();
    else
      relocation.adopt_places();
    return true;
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::bring_points_home()
  {
    return relocation.bring_points_home();
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::imbalance() const
  {
    return relocation.imbalance();
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::largest_displacement() const
  {
    // A displacement in a large cell is more cells where these are small.
    return parts.grid.has_levels() ?
             std::max(extremes.displacement,
                      point_speed * step / parts.grid.smallest_edge) :
             extremes.displacement;
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::points_were_lost() const
  {
    return relocation.points_were_lost();
  }



  template <int dim>
  const std::vector<LostPointOfBody<dim>> &
  ExplicitIntegrator<dim>::lost_points() const
  {
    return relocation.lost_points();
  }



  template <int dim>
  std::vector<std::pair<std::string, double>>
  ExplicitIntegrator<dim>::verb_seconds() const
  {
    constexpr const char *names[] = {"points to grid",
                                     "stabilize",
                                     "add loads",
                                     "solve pressure",
                                     "sum shared nodes",
                                     "advance nodes",
                                     "contact",
                                     "apply boundaries",
                                     "check nodes",
                                     "grid to points",
                                     "update stress",
                                     "relocate"};
    static_assert(std::size(names) == std::size_t(Verb::n_verbs));
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t v = 0; v < seconds.size(); ++v)
      if ((Verb(v) != Verb::solve_pressure ||
           parts.problem.method.integration ==
             TimeIntegration::semi_implicit) &&
          (Verb(v) != Verb::touch || contact || obstacles))
        result.emplace_back(names[v], seconds[v]);
    return result;
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::longest_step() const
  {
    const Method &method = parts.problem.method;
    if (method.time_step > 0)
      return method.time_step;

    const double h    = relocation.smallest_edge();
    double       step = method.courant_number * h / (wave_speed + point_speed);
    // explicit viscosity
    if (viscosity > 0)
      step = std::min(step, method.courant_number * h * h / (4 * viscosity));
    // never more than one cell
    return std::min(step, h / std::max(point_speed, 1e-300));
  }



  template <int dim>
  IntegratorState<dim>
  ExplicitIntegrator<dim>::state() const
  {
    return {wave_speed,
            point_speed,
            extremes.displacement,
            extremes.largest_mass,
            steps_since_filter,
            step,
            shifting.way_since(),
            loads.pieces(),
            0,
            0,
            full_mass ? full_mass->filtered_nodes() :
                        std::vector<FilteredNode<dim>>(),
            nodes_to_keep()};
  }



  // With contact; without it the next step finds the same from the points.
  template <int dim>
  std::vector<KeptNode<dim>>
  ExplicitIntegrator<dim>::nodes_to_keep() const
  {
    std::vector<KeptNode<dim>> own, result;
    if (!keeps_velocity || !obstacles || !obstacles->any())
      return result;
    const std::vector<std::uint64_t> places = places_of_nodes(parts.grid);
    for (const std::uint32_t node : parts.nodes.active_nodes())
      if (parts.nodes.owns(node))
        {
          KeptNode<dim> kept;
          kept.place    = places[node];
          kept.is_owned = true;
          std::copy_n(parts.nodes.record(node) + Layout::strain_velocity,
                      dim,
                      kept.velocity.begin_raw());
          own.push_back(kept);
        }
    for (const auto &action : obstacles->actions_to_come())
      {
        KeptNode<dim> kept;
        kept.place  = places[action.node];
        kept.across = action.across;
        kept.along  = action.along;
        own.push_back(kept);
      }
    for (const auto &of_rank :
         gather_records(own, parts.grid.communicator, true))
      result.insert(result.end(), of_rank.begin(), of_rank.end());
    return result;
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::restore_kept_nodes()
  {
    const std::vector<std::uint64_t> places = places_of_nodes(parts.grid);
    std::unordered_map<std::uint64_t, std::uint32_t> node_at;
    for (std::uint32_t node = 0; node < places.size(); ++node)
      if (places[node] != no_place)
        node_at.emplace(places[node], node);
    std::vector<typename ObstacleContact<dim>::Action> actions;
    for (const KeptNode<dim> &kept : kept_nodes)
      if (const auto found = node_at.find(kept.place); found != node_at.end())
        {
          if (kept.is_owned)
            std::copy_n(kept.velocity.begin_raw(),
                        dim,
                        parts.nodes.record(found->second) +
                          Layout::strain_velocity);
          else if (parts.nodes.owns(found->second))
            actions.push_back({found->second, kept.across, kept.along});
        }
    if (obstacles)
      obstacles->restore(std::move(actions));
    kept_nodes.clear();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::restore(const IntegratorState<dim> &former)
  {
    wave_speed            = former.wave_speed;
    point_speed           = former.point_speed;
    extremes.displacement = former.displacement;
    extremes.largest_mass = former.largest_mass;
    steps_since_filter    = former.steps_since_filter;
    step                  = former.step;
    shifting.restore(former.way_since_shifting);
    unstrained       = 0;
    stress_is_behind = false;
    loads.restore(former.face_pieces);
    reinit();
    kept_nodes = former.kept_nodes;
    if (full_mass)
      full_mass->restore(former.filtered_nodes);
  }



  template class ExplicitIntegrator<2>;
  template class ExplicitIntegrator<3>;
} // namespace limber
