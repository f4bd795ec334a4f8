// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>

#include <algorithm>

/**
 * @file The velocities of the nodes that strain points (before or after the
 * step, or re-mapped from points) and that move them, with sides and contact.
 */
namespace limber
{
  // The velocity that strains points, from mass and a momentum.
  template <int dim>
  void
  ExplicitIntegrator<dim>::form_velocity(const unsigned int momentum)
  {
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          double *const record = parts.nodes.record(node);
          const double  mass   = record[Layout::mass];
          if (!(mass > 0))
            continue;
          const double inverse = 1 / mass;
          for (int d = 0; d < dim; ++d)
            record[Layout::strain_velocity + d] =
              record[momentum + d] * inverse;
        }
    });
    lap(Verb::advance_nodes);
  }



  // The same of the momentum that points bring, with contact and sides: for
  // strain at the start of a step (USF, USAVG).
  template <int dim>
  void
  ExplicitIntegrator<dim>::form_velocity_before()
  {
    form_velocity(Layout::momentum);
    if (contact)
      contact->hold_before(Layout::strain_velocity, step);
    if (obstacles)
      obstacles->hold_before(Layout::strain_velocity, step);
    lap(Verb::touch);
    parts.nodes.for_each_field([&]() {
      boundaries.apply_trial(parts.nodes,
                             Layout::strain_velocity,
                             time,
                             BoundaryConditions<dim>::Trial::strain_before,
                             step);
    });
    lap(Verb::apply_boundaries);
  }



  // The same of the re-mapped momentum: for strain at the end of a step (MUSL,
  // USAVG).
  template <int dim>
  void
  ExplicitIntegrator<dim>::form_velocity_after()
  {
    form_velocity(Layout::remapped);
    if (contact)
      contact->hold_after(Layout::strain_velocity, flip_share());
    if (obstacles)
      obstacles->hold_after(Layout::strain_velocity, flip_share());
    lap(Verb::touch);
    parts.nodes.for_each_field([&]() {
      if (!leapfrogs()) // whose former velocities take the slot of increments
        {
          const auto action =
            boundaries.action_on_remapped(parts.nodes, Layout::strain_velocity);
          parts.ledger.contact += flip_share() * action.loss;
          parts.ledger.friction += flip_share() * action.friction;
        }
      boundaries.apply_trial(parts.nodes,
                             Layout::strain_velocity,
                             time + step,
                             BoundaryConditions<dim>::Trial::strain_after);
    });
    lap(Verb::apply_boundaries);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::clear_remapped()
  {
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes())
        std::fill_n(parts.nodes.record(node) + Layout::remapped, dim, 0.);
    });
    lap(Verb::advance_nodes);
  }



  // Clear the forces of p2g_before_strain(): the stress has changed since.
  template <int dim>
  void
  ExplicitIntegrator<dim>::clear_trial_force()
  {
    if (!needs_trial_force())
      return;
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes())
        std::fill_n(parts.nodes.record(node) + Layout::force, dim, 0.);
      // What these have taken from their masters is not given back to them.
      for (const HangingNode &hanging : parts.nodes.table.hanging)
        std::fill_n(parts.nodes.record(hanging.node) + Layout::force, dim, 0.);
    });
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::clear_momentum()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const record = parts.nodes.record(node);
        record[Layout::mass] = 0;
        std::fill_n(record + Layout::momentum, dim, 0.);
        std::fill_n(record + Layout::remapped, dim, 0.);
      }
    lap(Verb::advance_nodes);
  }



  // What points have given back is the momentum of the next step; the velocity
  // at the beginning of this one is still wanted for the work of loads.
  template <int dim>
  void
  ExplicitIntegrator<dim>::keep_momentum()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const record = parts.nodes.record(node);
        for (int d = 0; d < dim; ++d)
          {
            record[Layout::former_velocity + d] =
              record[Layout::velocity + d] - record[Layout::increment + d];
            record[Layout::momentum + d] = record[Layout::remapped + d];
          }
      }
    lap(Verb::advance_nodes);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::strain_by_new_velocity()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const record = parts.nodes.record(node);
        std::copy_n(record + Layout::velocity,
                    dim,
                    record + Layout::strain_velocity);
      }
    lap(Verb::advance_nodes);
  }



  // For output of nodal velocities: their slot holds momenta in a leapfrog,
  // which wait in that of forces until clear().
  template <int dim>
  void
  ExplicitIntegrator<dim>::show_velocity()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const record = parts.nodes.record(node);
        std::copy_n(record + Layout::momentum, dim, record + Layout::force);
        std::copy_n(record + Layout::strain_velocity,
                    dim,
                    record + Layout::velocity);
      }
    shows_velocity = true;
  }



  // The midpoint velocity, with which points move to second order in time; or
  // the mean of the two velocities that strain them.
  template <int dim>
  void
  ExplicitIntegrator<dim>::centre_velocity()
  {
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          double *const record = parts.nodes.record(node);
          for (int d = 0; d < dim; ++d)
            record[Layout::middle_velocity + d] =
              moves_as_strained ? 0.5 * (record[Layout::velocity + d] -
                                         record[Layout::increment + d] +
                                         record[Layout::strain_velocity + d]) :
                                  record[Layout::velocity + d] -
                                    0.5 * record[Layout::increment + d];
        }
    });
    lap(Verb::advance_nodes);
    if (contact)
      contact->hold(Layout::middle_velocity);
    if (obstacles)
      obstacles->hold(Layout::middle_velocity);
    lap(Verb::touch);
    parts.nodes.for_each_field([&]() {
      boundaries.apply_trial(parts.nodes,
                             Layout::middle_velocity,
                             time + 0.5 * step,
                             BoundaryConditions<dim>::Trial::motion);
    });
    lap(Verb::apply_boundaries);
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          double *const record = parts.nodes.record(node);
          std::copy_n(record + Layout::middle_velocity,
                      dim,
                      record + Layout::moving_velocity);
        }
    });
    lap(Verb::advance_nodes);
  }



  // Solids creep less if the velocity that strains points moves them as well.
  template <int dim>
  void
  ExplicitIntegrator<dim>::move_as_strained()
  {
    if (!moves_as_strained)
      return;
    parts.nodes.for_each_field([&]() {
      for (const std::uint32_t node : parts.nodes.active_nodes_of_field())
        {
          double *const record = parts.nodes.record(node);
          std::copy_n(record + Layout::strain_velocity,
                      dim,
                      record + Layout::moving_velocity);
        }
    });
    lap(Verb::advance_nodes);
  }



  template void
  ExplicitIntegrator<2>::form_velocity(unsigned int);
  template void
  ExplicitIntegrator<2>::form_velocity_before();
  template void
  ExplicitIntegrator<2>::form_velocity_after();
  template void
  ExplicitIntegrator<2>::clear_trial_force();
  template void
  ExplicitIntegrator<2>::clear_remapped();
  template void
  ExplicitIntegrator<2>::clear_momentum();
  template void
  ExplicitIntegrator<2>::keep_momentum();
  template void
  ExplicitIntegrator<2>::strain_by_new_velocity();
  template void
  ExplicitIntegrator<2>::show_velocity();
  template void
  ExplicitIntegrator<2>::centre_velocity();
  template void
  ExplicitIntegrator<2>::move_as_strained();
  template void
  ExplicitIntegrator<3>::form_velocity(unsigned int);
  template void
  ExplicitIntegrator<3>::form_velocity_before();
  template void
  ExplicitIntegrator<3>::form_velocity_after();
  template void
  ExplicitIntegrator<3>::clear_trial_force();
  template void
  ExplicitIntegrator<3>::clear_remapped();
  template void
  ExplicitIntegrator<3>::clear_momentum();
  template void
  ExplicitIntegrator<3>::keep_momentum();
  template void
  ExplicitIntegrator<3>::strain_by_new_velocity();
  template void
  ExplicitIntegrator<3>::show_velocity();
  template void
  ExplicitIntegrator<3>::centre_velocity();
  template void
  ExplicitIntegrator<3>::move_as_strained();
} // namespace limber
