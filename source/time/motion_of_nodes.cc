// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/explicit_integrator.h>
#include <limber/transfer/chequerboard.h>
#include <limber/transfer/hourglass.h>

#include <algorithm>
#include <cmath>
#include <utility>

/**
 * @file What a step does to the nodes between the sweeps over points: forces
 * that do not come from stress, new velocities, sides, and the limits within
 * which a step makes sense.
 */
namespace limber
{
  // Before points give anything to the nodes: the records of those at the
  // corners of cells serve here.
  template <int dim>
  void
  ExplicitIntegrator<dim>::control_chequerboards()
  {
    for (auto &body : bodies)
      {
        const double strength = body->description.chequerboard_control;
        if (!(strength > 0))
          continue;
        const double share =
          std::min(strength * wave_speed * step / grid.smallest_edge,
                   1. / (1 << dim));
        NodalFields<dim> &vertices = nodes.vertices();
        gather_chequerboards<dim>(vertices.owned_occupied_cells(),
                                  vertices.view(),
                                  body->cell_sums->view());
        // A node in the middle of an edge has not all cells around it.
        for (const HangingNode &hanging : grid.vertices.hanging)
          std::fill_n(vertices.record(hanging.node),
                      NodeLayout<dim>::stride,
                      0.);
        vertices.start_sum(0, n_chequerboard_slots<dim>);
        vertices.finish_sum();
        for (const auto *const cells : {&vertices.owned_occupied_cells(),
                                        &vertices.ghost_occupied_cells()})
          find_chequerboard_shifts<dim>(*cells,
                                        vertices.view(),
                                        body->cell_sums->view(),
                                        share,
                                        body->cell_shift.data());
        vertices.clear();
        lap(Verb::update_stress);
      }
  }



  // Its forces are summed up in the re-mapped slots, which are not in use
  // before the nodes advance, and then join the others.
  template <int dim>
  void
  ExplicitIntegrator<dim>::resist_hourglass()
  {
    using Layout = NodeLayout<dim>;

    resisting.clear();
    for (auto &body : bodies)
      if (body->description.hourglass_control > 0)
        resisting.push_back({body->cell_sums->view(),
                             body->description.hourglass_control * wave_speed});
    if (resisting.empty())
      return;

    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(nodes.record(node) + Layout::remapped, dim, 0.);
    limber::resist_hourglass<dim>(nodes.owned_occupied_cells(),
                                  nodes.view(),
                                  resisting,
                                  step);
    lap(Verb::points_to_grid);
    sum_shared_nodes(Layout::remapped, Layout::remapped + dim);
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        const double  mass   = record[Layout::mass];
        if (!(mass > 0))
          continue;
        for (int d = 0; d < dim; ++d)
          {
            const double force = std::exchange(record[Layout::remapped + d], 0);
            // heat, but for the change of velocity within the step
            if (nodes.owns(node))
              ledger.viscous -=
                step * force * record[Layout::momentum + d] / mass;
            record[Layout::force + d] += force;
          }
      }
    lap(Verb::advance_nodes);
  }



  // The velocity at the beginning of the step shrinks by exp(-alpha dt), as it
  // does exactly without other forces, for any alpha dt.
  template <int dim>
  void
  ExplicitIntegrator<dim>::damp()
  {
    using Layout = NodeLayout<dim>;

    const double lost_share = -std::expm1(-problem.method.damping_rate * step);
    if (lost_share == 0)
      return;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        for (int d = 0; d < dim; ++d)
          {
            const double lost = lost_share * record[Layout::momentum + d];
            record[Layout::force + d] -= lost / step;
            if (nodes.owns(node))
              ledger.load_impulse[d] -= lost;
          }
      }
    lap(Verb::advance_nodes);
  }



  // Loads act at the time of the stress.
  template <int dim>
  void
  ExplicitIntegrator<dim>::add_loads()
  {
    const bool at_middle = problem.method.order == StressUpdateOrder::usavg;
    if (loads.any())
      loads.add(nodes, at_middle ? time + 0.5 * step : time);
    lap(Verb::add_loads);
  }



  // v_i = p_i / m_i,  dv_i = dt (f_i / m_i + g)
  template <int dim>
  void
  ExplicitIntegrator<dim>::advance_nodes()
  {
    using Layout = NodeLayout<dim>;

    std::array<double, dim> gravity_step;
    for (int d = 0; d < dim; ++d)
      gravity_step[d] = step * problem.loads.gravity[d];

    double total_mass = 0, checked_speed = 0, all = 0;
    // A node that only touches the material may be fast for a moment.
    const double checked_mass = 0.1 * largest_mass;
    largest_mass              = 0;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        const double  mass   = record[Layout::mass];
        if (!(mass > 0))
          continue;
        const double inverse = 1 / mass;
        double       squared = 0;
        for (int d = 0; d < dim; ++d)
          {
            const double before = record[Layout::momentum + d] * inverse;
            const double change =
              step * record[Layout::force + d] * inverse + gravity_step[d];
            const double after            = before + change;
            record[Layout::increment + d] = change;
            record[Layout::velocity + d]  = after;
            squared += after * after;
          }
        if (nodes.owns(node))
          total_mass += mass;
        largest_mass = std::max(largest_mass, mass);
        all += squared;
        if (mass > checked_mass)
          checked_speed = std::max(checked_speed, squared);
      }
    for (int d = 0; d < dim; ++d)
      ledger.gravity_impulse[d] += total_mass * gravity_step[d];

    fastest_node = std::isfinite(all) ?
                     std::sqrt(checked_speed) * step / grid.smallest_edge :
                     1e300;
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::check_nodes()
  {
    if (parallel)
      MPI_Allreduce(
        MPI_IN_PLACE, &fastest_node, 1, MPI_DOUBLE, MPI_MAX, grid.communicator);
    lap(Verb::check_nodes);
    const double cells = fastest_node;
    if (cells <= 1)
      return;

    const std::string where = " at time " + brief(time) + " s.";
    if (cells >= 1e300)
      throw ComputationError(
        "The run is unstable: the velocity of a node is not finite," + where,
        FailureKind::not_finite);
    throw ComputationError("The run is unstable: a node moves by " +
                             brief(cells) + " cells in one step of " +
                             brief(step) + " s, at " +
                             brief(cells * grid.smallest_edge / step) +
                             " m/s," + where,
                           FailureKind::growing_energy);
  }



  // Forces do work with the mean of the velocities at the ends of the step. For
  // points that take dv_p = sum N_ip f_i dt / m_i, this is exact when the later
  // one is re-mapped: sum_p m_p dv_p . (v_p + v_p') / 2 is the sum over nodes
  // of dt f_i . (v_i + v_i') / 2 with m_i v_i' = sum_p m_p N_ip v_p'.
  template <int dim>
  void
  ExplicitIntegrator<dim>::account_loads(const unsigned int velocity_after)
  {
    using Layout = NodeLayout<dim>;

    const double lost_share = -std::expm1(-problem.method.damping_rate * step);
    const bool   loaded     = loads.any();
    if (!loaded && lost_share == 0)
      return;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double *const record = nodes.record(node);
        if (!nodes.owns(node) || !(record[Layout::mass] > 0))
          continue;
        dealii::Tensor<1, dim> force;
        if (loaded)
          force = loads.on_node(node);
        ledger.load_impulse += step * force;
        for (int d = 0; d < dim; ++d)
          {
            const double before =
              record[Layout::velocity + d] - record[Layout::increment + d];
            const double mean = 0.5 * (before + record[velocity_after + d]);
            ledger.load_work += step * force[d] * mean;
            ledger.viscous += lost_share * record[Layout::mass] * before * mean;
          }
      }
    lap(Verb::add_loads);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::apply_boundaries()
  {
    boundaries.apply(nodes,
                     time + step,
                     [this](const unsigned int            side,
                            const dealii::Tensor<1, dim> &impulse,
                            const double                  work) {
                       ledger.side_impulse[side] += impulse;
                       ledger.boundary_work += work;
                     });
    lap(Verb::apply_boundaries);
  }



  // A velocity in the re-mapped slot, with the boundary conditions on it.
  template <int dim>
  void
  ExplicitIntegrator<dim>::divide_remapped(const unsigned int momentum,
                                           const double       when)
  {
    using Layout = NodeLayout<dim>;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        const double  mass   = record[Layout::mass];
        if (!(mass > 0))
          continue;
        const double inverse = 1 / mass;
        for (int d = 0; d < dim; ++d)
          record[Layout::remapped + d] = record[momentum + d] * inverse;
      }
    lap(Verb::advance_nodes);
    boundaries.apply_trial(nodes, Layout::remapped, when);
    lap(Verb::apply_boundaries);
  }



  // From the new velocity to that of the middle of the step, with which points
  // move to second order in time.
  template <int dim>
  void
  ExplicitIntegrator<dim>::centre_velocity()
  {
    using Layout = NodeLayout<dim>;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        for (int d = 0; d < dim; ++d)
          record[Layout::increment + d] =
            record[Layout::velocity + d] - 0.5 * record[Layout::increment + d];
      }
    lap(Verb::advance_nodes);
    boundaries.apply_trial(nodes, Layout::increment, time + 0.5 * step);
    lap(Verb::apply_boundaries);
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        std::copy_n(record + Layout::increment, dim, record + Layout::velocity);
      }
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::interpolate_hanging()
  {
    nodes.interpolate_hanging();
    lap(Verb::apply_boundaries);
  }



  template void
  ExplicitIntegrator<2>::control_chequerboards();
  template void
  ExplicitIntegrator<2>::resist_hourglass();
  template void
  ExplicitIntegrator<2>::damp();
  template void
  ExplicitIntegrator<2>::add_loads();
  template void
  ExplicitIntegrator<2>::advance_nodes();
  template void
  ExplicitIntegrator<2>::check_nodes();
  template void
  ExplicitIntegrator<2>::account_loads(unsigned int);
  template void
  ExplicitIntegrator<2>::apply_boundaries();
  template void
  ExplicitIntegrator<2>::divide_remapped(unsigned int, double);
  template void
  ExplicitIntegrator<2>::centre_velocity();
  template void
  ExplicitIntegrator<2>::interpolate_hanging();
  template void
  ExplicitIntegrator<3>::control_chequerboards();
  template void
  ExplicitIntegrator<3>::resist_hourglass();
  template void
  ExplicitIntegrator<3>::damp();
  template void
  ExplicitIntegrator<3>::add_loads();
  template void
  ExplicitIntegrator<3>::advance_nodes();
  template void
  ExplicitIntegrator<3>::check_nodes();
  template void
  ExplicitIntegrator<3>::account_loads(unsigned int);
  template void
  ExplicitIntegrator<3>::apply_boundaries();
  template void
  ExplicitIntegrator<3>::divide_remapped(unsigned int, double);
  template void
  ExplicitIntegrator<3>::centre_velocity();
  template void
  ExplicitIntegrator<3>::interpolate_hanging();
} // namespace limber
