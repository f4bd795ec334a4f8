// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/explicit_integrator.h>

#include <algorithm>
#include <cmath>

/**
 * @file What a step does to the nodes between the sweeps over points: forces
 * that do not come from stress, new velocities, sides, and the limits within
 * which a step makes sense. The velocities that strain and move points are in
 * velocities_of_nodes.cc.
 */
namespace limber
{
  template <int dim>
  void
  ExplicitIntegrator<dim>::clear()
  {
    if (unstrained > 0 || keeps_velocity) // other slots are still needed
      for (const std::uint32_t node : parts.nodes.active_nodes())
        {
          double *const record = parts.nodes.record(node);
          if (shows_velocity)
            std::copy_n(record + Layout::force, dim, record + Layout::momentum);
          std::fill_n(record + Layout::force, dim, 0.);
        }
    else
      parts.nodes.clear();
    shows_velocity         = false;
    extremes.speed_squared = extremes.wave_squared = extremes.displacement = 0;
    history_time = step;
    if (full_mass)
      steps_since_filter =
        (steps_since_filter + 1) % parts.problem.method.transfer_period;
    relocation.begin_step();
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::control_checkerboards()
  {
    stabilization.control_checkerboards(step, wave_speed);
    lap(Verb::stabilize);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::control_density()
  {
    density_control.act(point_speed * step / parts.grid.smallest_edge);
    lap(Verb::stabilize);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::resist_hourglass()
  {
    stabilization.resist_hourglass(step, wave_speed);
    lap(Verb::stabilize);
  }



  // The velocity at the beginning of the step shrinks by exp(-alpha dt), as it
  // does exactly without other forces, for any alpha dt.
  template <int dim>
  void
  ExplicitIntegrator<dim>::damp()
  {
    const double lost_share =
      -std::expm1(-parts.problem.method.damping_rate * step);
    if (lost_share == 0)
      return;
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes())
        {
          double *const record = parts.nodes.record(node);
          for (int d = 0; d < dim; ++d)
            {
              const double lost = lost_share * record[Layout::momentum + d];
              record[Layout::force + d] -= lost / step;
              // A hanging node has no mass; its momentum is that of its
              // masters.
              if (parts.nodes.owns(node) && record[Layout::mass] > 0)
                parts.ledger.load_impulse[d] -= lost;
            }
        }
    });
    lap(Verb::advance_nodes);
  }



  // Loads act at the time of the stress.
  template <int dim>
  void
  ExplicitIntegrator<dim>::add_loads()
  {
    const bool at_middle =
      parts.problem.method.order == StressUpdateOrder::usavg;
    if (loads.any())
      loads.add(parts.nodes, at_middle ? time + 0.5 * step : time);
    lap(Verb::add_loads);
  }



  // v_i = p_i / m_i,  dv_i = dt (f_i / m_i + g)
  template <int dim>
  void
  ExplicitIntegrator<dim>::advance_nodes()
  {
    std::array<double, dim> gravity_step;
    for (int d = 0; d < dim; ++d)
      gravity_step[d] = step * parts.problem.loads.gravity[d];

    double total_mass = 0, checked_speed = 0, all = 0;
    // A node of hardly any mass (small cut) may be fast for a moment.
    const double checked_mass = 0.1 * extremes.largest_mass;
    extremes.largest_mass     = 0;
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          double *const record = parts.nodes.record(node);
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
          if (parts.nodes.owns(node))
            total_mass += mass;
          extremes.largest_mass = std::max(extremes.largest_mass, mass);
          all += squared;
          if (mass > checked_mass)
            checked_speed = std::max(checked_speed, squared);
        }
    });
    for (int d = 0; d < dim; ++d)
      parts.ledger.gravity_impulse[d] += total_mass * gravity_step[d];

    fastest_node = std::isfinite(all) ? std::sqrt(checked_speed) * step /
                                          relocation.smallest_edge() :
                                        1e300;
    lap(Verb::advance_nodes);
  }



  // Find the largest nodal speed anew, after velocities have been changed.
  template <int dim>
  void
  ExplicitIntegrator<dim>::measure_nodes()
  {
    double       checked_speed = 0, all = 0;
    const double checked_mass = 0.1 * extremes.largest_mass;
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        const double *const record = parts.nodes.record(node);
        if (!(record[Layout::mass] > 0))
          continue;
        double squared = 0;
        for (int d = 0; d < dim; ++d)
          squared +=
            record[Layout::velocity + d] * record[Layout::velocity + d];
        all += squared;
        if (record[Layout::mass] > checked_mass)
          checked_speed = std::max(checked_speed, squared);
      }
    fastest_node = std::isfinite(all) ? std::sqrt(checked_speed) * step /
                                          relocation.smallest_edge() :
                                        1e300;
    lap(Verb::advance_nodes);
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::way_of_fastest_node()
  {
    if (parallel)
      MPI_Allreduce(MPI_IN_PLACE,
                    &fastest_node,
                    1,
                    MPI_DOUBLE,
                    MPI_MAX,
                    parts.grid.communicator);
    lap(Verb::check_nodes);
    return fastest_node;
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::check_nodes()
  {
    const double cells = way_of_fastest_node();
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
                             brief(cells * relocation.smallest_edge() / step) +
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
    const double lost_share =
      -std::expm1(-parts.problem.method.damping_rate * step);
    if (surfaces)
      surfaces->account(velocity_after);
    const bool loaded = loads.any();
    if (!loaded && lost_share == 0)
      return;
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          const double *const record = parts.nodes.record(node);
          if (!parts.nodes.owns(node) || !(record[Layout::mass] > 0))
            continue;
          dealii::Tensor<1, dim> force;
          if (loaded)
            force = loads.on_node(parts.nodes.selected_field(), node);
          parts.ledger.load_impulse += step * force;
          for (int d = 0; d < dim; ++d)
            {
              const double before =
                leapfrogs() ?
                  record[Layout::former_velocity + d] :
                  record[Layout::velocity + d] - record[Layout::increment + d];
              const double mean = 0.5 * (before + record[velocity_after + d]);
              parts.ledger.load_work += step * force[d] * mean;
              parts.ledger.viscous +=
                lost_share * record[Layout::mass] * before * mean;
            }
        }
    });
    lap(Verb::add_loads);
  }



  // Damps what alternates along surfaces of obstacles (SmoothSurfaces), before
  // contact: by what the velocities before the step ask for.
  template <int dim>
  void
  ExplicitIntegrator<dim>::smooth_surfaces(const double share)
  {
    if (surfaces && share > 0)
      surfaces->apply(boundaries, time, step, share);
    lap(Verb::touch);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::exchange_between_bodies()
  {
    if (contact)
      contact->exchange();
    if (obstacles)
      obstacles->exchange();
    lap(Verb::touch);
  }



  // In the initial frame all points stay with the nodes that they had at the
  // start; else they may land on a side at any time.
  template <int dim>
  void
  ExplicitIntegrator<dim>::apply_boundaries()
  {
    parts.nodes.for_each_field([&]() {
      boundaries.apply(parts.nodes,
                       {time, time + step, flip_share(), in_initial_frame},
                       [this](const unsigned int side, const auto &action) {
                         parts.ledger.side_impulse[side] += action.impulse;
                         parts.ledger.boundary_work +=
                           action.work + action.transfer_work;
                         parts.ledger.friction += action.friction;
                         parts.ledger.contact += action.loss;
                         // What points lose to the transfer contains it.
                         parts.ledger.transfer += action.transfer_work;
                       });
    });
    lap(Verb::apply_boundaries);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::interpolate_hanging()
  {
    parts.nodes.for_each_field([&]() { parts.nodes.interpolate_hanging(); });
    lap(Verb::apply_boundaries);
  }



  template void
  ExplicitIntegrator<2>::clear();
  template void
  ExplicitIntegrator<2>::control_checkerboards();
  template void
  ExplicitIntegrator<2>::control_density();
  template void
  ExplicitIntegrator<2>::resist_hourglass();
  template void
  ExplicitIntegrator<2>::damp();
  template void
  ExplicitIntegrator<2>::add_loads();
  template void
  ExplicitIntegrator<2>::advance_nodes();
  template void
  ExplicitIntegrator<2>::measure_nodes();
  template double
  ExplicitIntegrator<2>::way_of_fastest_node();
  template void
  ExplicitIntegrator<2>::check_nodes();
  template void
  ExplicitIntegrator<2>::account_loads(unsigned int);
  template void
  ExplicitIntegrator<2>::smooth_surfaces(double);
  template void
  ExplicitIntegrator<2>::exchange_between_bodies();
  template void
  ExplicitIntegrator<2>::apply_boundaries();
  template void
  ExplicitIntegrator<2>::interpolate_hanging();
  template void
  ExplicitIntegrator<3>::clear();
  template void
  ExplicitIntegrator<3>::control_checkerboards();
  template void
  ExplicitIntegrator<3>::control_density();
  template void
  ExplicitIntegrator<3>::resist_hourglass();
  template void
  ExplicitIntegrator<3>::damp();
  template void
  ExplicitIntegrator<3>::add_loads();
  template void
  ExplicitIntegrator<3>::advance_nodes();
  template void
  ExplicitIntegrator<3>::measure_nodes();
  template double
  ExplicitIntegrator<3>::way_of_fastest_node();
  template void
  ExplicitIntegrator<3>::check_nodes();
  template void
  ExplicitIntegrator<3>::account_loads(unsigned int);
  template void
  ExplicitIntegrator<3>::smooth_surfaces(double);
  template void
  ExplicitIntegrator<3>::exchange_between_bodies();
  template void
  ExplicitIntegrator<3>::apply_boundaries();
  template void
  ExplicitIntegrator<3>::interpolate_hanging();
} // namespace limber
