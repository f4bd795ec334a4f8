// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>

#include <algorithm>

/**
 * @file The velocity of the nodes that FMPM(k) and XPIC(k) give the points, and
 * what these lose to it.
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



  // Points then take it as with PIC; in steps between, as with FLIP.
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
        if (contact)
          hold = [this](const unsigned int slot) { contact->hold(slot); };
        const auto action = full_mass->apply(parts.nodes,
                                             parts.bodies,
                                             method.transfer_order,
                                             method.transfer == Transfer::xpic,
                                             hold);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          parts.ledger.side_impulse[side] += action.impulse[side];
        // What points lose to the filter contains it.
        parts.ledger.boundary_work += action.work;
        parts.ledger.transfer += action.work;
      }
    lap(Verb::grid_to_points);
  }



  // The points have lost to the transfer what is missing of their energy when
  // the forces have worked on the velocities that strain them: half of the step
  // on that of the step before and half on that of this one, as the stress
  // grows in between. The filter makes these differ from those that points
  // bring and that the nodes get: both differences are booked (the first by
  // note_forces()), and the energy of the nodes in the place of that which
  // increments would give the points.
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
