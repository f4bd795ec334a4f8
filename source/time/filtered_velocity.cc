// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>

#include <algorithm>

/**
 * @file The filtered nodal velocity of FMPM(k) and XPIC(k), and the energy that
 * points lose by it.
 */
namespace limber
{
  template <int dim>
  void
  ExplicitIntegrator<dim>::note_forces()
  {
    if (!full_mass)
      return;
    parts.ledger.transfer +=
      0.5 * step *
      full_mass->note_forces(parts.nodes, parts.problem.loads.gravity);
    lap(Verb::advance_nodes);
  }



  // Points take the filtered velocity as in PIC; in steps between two that
  // filter (Transfer period) they are updated by FLIP.
  template <int dim>
  void
  ExplicitIntegrator<dim>::filter_velocity()
  {
    if (!full_mass)
      return;
    const Method &method = parts.problem.method;
    if (steps_since_filter == 0)
      {
        typename FullMassFilter<dim>::Hold hold;
        if (contact || obstacles)
          hold = [this](const unsigned int slot) {
            if (contact)
              contact->hold(slot);
            if (obstacles)
              obstacles->hold_filtered(slot);
          };
        const auto action = full_mass->apply(parts.nodes,
                                             parts.bodies,
                                             method.transfer_order,
                                             method.transfer == Transfer::xpic,
                                             hold);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          parts.ledger.side_impulse[side] += action.impulse[side];
        // the loss of the points by the filter contains this work
        parts.ledger.boundary_work += action.work;
        parts.ledger.transfer += action.work;
        if (obstacles && method.transfer_order > 1)
          parts.ledger.transfer += obstacles->account_filtered();
      }
    lap(Verb::grid_to_points);
  }



  // Energy removed by the transfer: what the energy of the points lacks after
  // the work of the forces on the velocities that strain them, half of the step
  // on that of the step before and half on that of this one, as the stress
  // grows in between. The filter makes these velocities differ from those
  // mapped from the points and from the new nodal ones: both differences are
  // booked (the first by note_forces()), and the energy of the nodes instead of
  // that which increments would give the points.
  template <int dim>
  void
  ExplicitIntegrator<dim>::filter_and_account()
  {
    if (!full_mass || steps_since_filter > 0)
      return;
    const double gained = full_mass->energy_of_step(parts.nodes);
    const double before = full_mass->power(parts.nodes);
    filter_velocity();
    parts.ledger.transfer +=
      gained + 0.5 * step * (full_mass->power(parts.nodes) - before);
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        std::fill_n(parts.nodes.record(node) + Layout::increment, dim, 0.);
    });
    interpolate_hanging();
    lap(Verb::grid_to_points);
  }



  template void
  ExplicitIntegrator<2>::note_forces();
  template void
  ExplicitIntegrator<2>::filter_velocity();
  template void
  ExplicitIntegrator<2>::filter_and_account();
  template void
  ExplicitIntegrator<3>::note_forces();
  template void
  ExplicitIntegrator<3>::filter_velocity();
  template void
  ExplicitIntegrator<3>::filter_and_account();
} // namespace limber
