// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/time/explicit_integrator.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>
#include <limber/transfer/project_on_nodes.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

namespace limber
{
  namespace
  {
    /** The sums of a projected body for the sweeps; nothing for others. */
    template <int dim>
    std::optional<CellSums<dim>>
    sums_of(MaterialBody<dim> &body)
    {
      if (!body.cell_sums)
        return std::nullopt;
      return body.cell_sums->view();
    }



    /** The records of a body with means around nodes; null for others. */
    template <int dim>
    double *
    nodal_means_of(MaterialBody<dim> &body)
    {
      return body.nodal_means ? body.nodal_means->data() : nullptr;
    }
  } // namespace



  const char *
  name_of(const Verb verb)
  {
    static constexpr const char *names[] = {"points to grid",
                                            "add loads",
                                            "sum shared nodes",
                                            "advance nodes",
                                            "apply boundaries",
                                            "check nodes",
                                            "grid to points",
                                            "update stress",
                                            "relocate"};
    return names[std::size_t(verb)];
  }



  template <int dim>
  ExplicitIntegrator<dim>::ExplicitIntegrator(
    const Problem<dim>                              &problem,
    BackgroundGrid<dim>                             &grid,
    NodalFields<dim>                                &nodes,
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
    Ledger<dim>                                     &ledger)
    : problem(problem)
    , grid(grid)
    , nodes(nodes)
    , bodies(bodies)
    , ledger(ledger)
    , boundaries(problem.sides)
    , loads(problem, grid, bodies)
    , parallel(dealii::Utilities::MPI::n_mpi_processes(grid.communicator) > 1)
  {
    if (filters_velocity(problem.method.transfer))
      full_mass.emplace(grid, boundaries);
    for (const auto &body : bodies)
      {
        viscosity =
          std::max(viscosity,
                   body->stress->viscosity() / body->stress->density());
        const PointView<dim> points = body->points.view();
        wave_squared =
          std::max(wave_squared, body->stress->wave_speed_squared(points));
        for (std::size_t p = 0; p < points.size; ++p)
          {
            double squared = 0;
            for (int d = 0; d < dim; ++d)
              squared += points.velocity[d][p] * points.velocity[d][p];
            speed_squared = std::max(speed_squared, squared);
          }
      }
    reduce_extremes();
    sort_points(/*agree=*/true);
    gather_cells();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::reinit()
  {
    nodes.reinit();
    if (full_mass)
      full_mass->reinit();
    for (auto &body : bodies)
      {
        if (body->cell_sums)
          body->cell_sums->reinit();
        if (body->cell_shift.size() > 0)
          body->cell_shift.reinit(grid.n_cells());
        if (body->deviator_sums)
          body->deviator_sums->reinit();
        if (body->nodal_means)
          body->nodal_means->reinit();
      }
    loads.reinit();
    travelled = 0;
    sort_points(/*agree=*/true);
    gather_cells();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::advance(const double now, const double length)
  {
    time = now;
    step = length;
    stopwatch.start();

    clear();
    control_chequerboards();
    switch (problem.method.order)
      {
        case StressUpdateOrder::usf:
          usf();
          break;
        case StressUpdateOrder::usl:
          usl();
          break;
        case StressUpdateOrder::musl:
          musl();
          break;
        case StressUpdateOrder::automatic: // has been chosen long before
        case StressUpdateOrder::usavg:
          usavg();
          break;
      }
    relocate();
  }



  // Update stress first: strained by the velocity that the points bring.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usf()
  {
    strain_before_forces(step);
    accelerate_nodes();
    account_loads(NodeLayout<dim>::velocity);
    g2p_and_move();
  }



  // Update stress last: strained by the new velocity of the nodes.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usl()
  {
    p2g();
    accelerate_nodes();
    account_loads(NodeLayout<dim>::velocity);
    filter_velocity();
    g2p_update_stress_and_move();
  }



  // The same by the velocity that the points give back to the nodes.
  template <int dim>
  void
  ExplicitIntegrator<dim>::musl()
  {
    p2g();
    accelerate_nodes();
    strain_after_motion(step);
  }



  // The average of the first and the last.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usavg()
  {
    strain_before_forces(0.5 * step);
    accelerate_nodes();
    strain_after_motion(0.5 * step);
  }



  // Strain over @p length with the velocity that the points bring to the grid,
  // and only then the forces.
  template <int dim>
  void
  ExplicitIntegrator<dim>::strain_before_forces(const double length)
  {
    using Layout = NodeLayout<dim>;

    p2g_momentum();
    divide_remapped(Layout::momentum, time);
    interpolate_hanging();
    update_stress(length);
    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(nodes.record(node) + Layout::remapped, dim, 0.);
    lap(Verb::advance_nodes);
    p2g_force();
  }



  // Velocities and places at the end of the step; strain over @p length with
  // the velocity that the points would bring back to the nodes.
  template <int dim>
  void
  ExplicitIntegrator<dim>::strain_after_motion(const double length)
  {
    using Layout = NodeLayout<dim>;

    g2p_and_remap();
    divide_remapped(Layout::remapped, time + step);
    account_loads(Layout::remapped);
    if (problem.method.order == StressUpdateOrder::usavg)
      centre_velocity();
    interpolate_hanging();
    update_stress_and_move(length);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::accelerate_nodes()
  {
    resist_hourglass();
    damp();
    add_loads();
    advance_nodes();
    apply_boundaries();
    interpolate_hanging();
    check_nodes();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::clear()
  {
    nodes.clear();
    speed_squared = wave_squared = displacement = 0;
    n_batches                                   = 0;
    lost.clear();
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g()
  {
    points_to_grid({true, true});
    sum_shared_nodes(0, NodeLayout<dim>::remapped);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g_momentum()
  {
    points_to_grid({true, false});
    sum_shared_nodes(0, NodeLayout<dim>::remapped);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g_force()
  {
    points_to_grid({false, true});
    sum_shared_nodes(NodeLayout<dim>::force, NodeLayout<dim>::force + dim);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::points_to_grid(GiveToGrid what)
  {
    what.affine = what.momentum && problem.method.transfer == Transfer::apic;
    n_batches   = 0;
    if (what.force)
      project_on_nodes([&](MaterialBody<dim> &body, double *const records) {
        sum_pressure<dim>(body.points.view(), nodes.view(), records);
      });
    for (auto &body : bodies)
      {
        what.inverse_density = 1 / body->stress->density();
        what.projection      = body->stress->projection();
        what.initial_frame   = body->stress->initial_frame();
        what.nodal_pressure  = nodal_means_of(*body);
        const auto sums      = sums_of(*body);
        n_batches += limber::points_to_grid<dim>(body->points.view(),
                                                 nodes.view(),
                                                 what,
                                                 sums ? &*sums : nullptr);
      }
    lap(Verb::points_to_grid);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::sum_shared_nodes(const unsigned int first,
                                            const unsigned int last)
  {
    nodes.start_sum(first, last);
    nodes.finish_sum();
    lap(Verb::sum_shared_nodes);
  }



  // Means around nodes for the bodies that are averaged so; sum(body, records)
  // adds what the points give.
  template <int dim>
  template <class Sum>
  void
  ExplicitIntegrator<dim>::project_on_nodes(const Sum &sum)
  {
    const NodalFields<dim> &vertices = nodes.vertices();
    for (auto &body : bodies)
      if (body->nodal_means)
        {
          body->nodal_means->clear(vertices.active_nodes());
          sum(*body, body->nodal_means->data());
          body->nodal_means->start_completion(vertices.node_plan());
        }
    for (auto &body : bodies)
      if (body->nodal_means)
        body->nodal_means->finish_completion(vertices.active_nodes());
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_and_move()
  {
    TakeFromGrid what;
    what.move = step;
    grid_to_points(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_and_remap()
  {
    using Layout = NodeLayout<dim>;
    TakeFromGrid what;
    what.remap = true;
    grid_to_points(what);
    sum_shared_nodes(Layout::remapped, Layout::remapped + dim);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::grid_to_points(const TakeFromGrid &what)
  {
    for (auto &body : bodies)
      grid_to_points(*body, what);
    lap(Verb::grid_to_points);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::grid_to_points(MaterialBody<dim> &body,
                                          TakeFromGrid       what)
  {
    what.affine      = problem.method.transfer == Transfer::apic;
    what.flip_share  = flip_share();
    const auto sums  = sums_of(body);
    const auto found = limber::grid_to_points<dim>(body.points.view(),
                                                   nodes.view(),
                                                   what,
                                                   sums ? &*sums : nullptr);
    speed_squared    = std::max(speed_squared, found.speed_squared);
    displacement     = std::max(displacement, found.displacement);
    ledger.transfer += found.removed;
  }



  // The share of velocity increments in what points take; the rest is PIC.
  template <int dim>
  double
  ExplicitIntegrator<dim>::flip_share() const
  {
    const Method &method = problem.method;
    if (method.transfer == Transfer::pic ||
        (full_mass && steps_since_filter == 0))
      return 0;
    return method.damping_time > 0 ?
             std::max(0., 1 - step / method.damping_time) :
             1;
  }



  // Points then take it as with PIC; in steps between, as with FLIP.
  template <int dim>
  void
  ExplicitIntegrator<dim>::filter_velocity()
  {
    if (!full_mass)
      return;
    const Method &method = problem.method;
    steps_since_filter   = (steps_since_filter + 1) % method.transfer_period;
    if (steps_since_filter == 0)
      {
        const auto action = full_mass->apply(nodes,
                                             bodies,
                                             method.transfer_order,
                                             method.transfer == Transfer::xpic);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          ledger.side_impulse[side] += action.impulse[side];
        // What points lose to the filter contains it.
        ledger.boundary_work += action.work;
        ledger.transfer += action.work;
      }
    lap(Verb::grid_to_points);
  }



  // The share of the way to the mean that a history goes in that time.
  template <int dim>
  double
  ExplicitIntegrator<dim>::relaxation(const Body<dim>       &body,
                                      const HistoryTreatment history,
                                      const double           length) const
  {
    switch (history)
      {
        case HistoryTreatment::keep:
          return 0;
        case HistoryTreatment::relax:
          return -std::expm1(-length / body.relaxation_time);
        case HistoryTreatment::crossing:
          return -std::expm1(-length * point_speed / grid.smallest_edge);
        case HistoryTreatment::replace:
          return 1;
      }
    return 0;
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::relax_deviators(const double length)
  {
    for (auto &body : bodies)
      if (body->deviator_sums)
        body->stress->sum_deviators(body->points.view(),
                                    body->deviator_sums->view());
    complete_cells(&MaterialBody<dim>::deviator_sums);
    for (auto &body : bodies)
      if (body->deviator_sums)
        {
          const Body<dim> &description = body->description;
          ledger.history += body->stress->relax_deviators(
            body->points.view(),
            body->deviator_sums->view().now,
            relaxation(description, description.deviatoric_history, length));
        }
  }



  // With the velocity that has been given back, while points stay.
  template <int dim>
  void
  ExplicitIntegrator<dim>::update_stress(const double length)
  {
    StressSweep what;
    what.step     = length;
    what.remapped = true;
    update_stress(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::update_stress_and_move(const double length)
  {
    StressSweep what;
    what.step     = length;
    what.remapped = true;
    what.move     = step;
    update_stress(what);
  }



  // With the new velocity of the nodes. Points with a stencil of their own
  // take their velocities in the same sweep, which spares looking it up again.
  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_update_stress_and_move()
  {
    for (auto &body : bodies)
      if (!body->stress->takes_velocity())
        grid_to_points(*body, {});
    lap(Verb::grid_to_points);
    StressSweep what;
    what.step       = step;
    what.move       = step;
    what.flip_share = flip_share();
    update_stress(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::update_stress(StressSweep what)
  {
    const double length = what.step;
    loads.deform(nodes, what.remapped, length);
    // The means over cells are those of the beginning of the step: histories
    // tend to them before anything is strained.
    const bool begins =
      what.move == 0 || problem.method.order != StressUpdateOrder::usavg;
    relax_deviators(length);
    project_on_nodes([&](MaterialBody<dim> &body, double *const records) {
      sum_divergence<dim>(body.points.view(),
                          nodes.view(),
                          what.remapped,
                          records);
    });
    for (auto &body : bodies)
      {
        const Body<dim> &description = body->description;
        what.nodal_divergence        = nodal_means_of(*body);
        what.relaxation =
          begins ? relaxation(description, description.history, step) : 0;
        what.shift       = description.chequerboard_control > 0 ?
                             body->cell_shift.data() :
                             nullptr;
        what.shift_share = length / step;
        const auto sums  = sums_of(*body);
        const auto found = body->stress->update(body->points.view(),
                                                nodes.view(),
                                                sums ? &*sums : nullptr,
                                                what);
        wave_squared     = std::max(wave_squared, found.wave_speed_squared);
        displacement     = std::max(displacement, found.displacement);
        speed_squared    = std::max(speed_squared, found.speed_squared);
        ledger.viscous += found.viscous;
        ledger.history += found.history;
        ledger.transfer += found.removed;
      }
    lap(Verb::update_stress);
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::longest_step() const
  {
    const Method &method = problem.method;
    if (method.time_step > 0)
      return method.time_step;

    const double h    = grid.smallest_edge;
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
            displacement,
            largest_mass,
            steps_since_filter,
            loads.pieces()};
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::restore(const IntegratorState<dim> &former)
  {
    wave_speed         = former.wave_speed;
    point_speed        = former.point_speed;
    displacement       = former.displacement;
    largest_mass       = former.largest_mass;
    steps_since_filter = former.steps_since_filter;
    loads.restore(former.face_pieces);
    reinit();
  }



  template class ExplicitIntegrator<2>;
  template class ExplicitIntegrator<3>;
} // namespace limber
