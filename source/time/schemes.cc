// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>

#include <algorithm>
#include <cmath>

/**
 * @file The schemes of an explicit step: the order of its verbs. They differ in
 * when the stress is updated (USF, USL, MUSL, USAVG), and in the velocity that
 * strains the points: that which points bring to the nodes, the new one, or the
 * re-mapped one, that of the points' new velocities.
 */
namespace limber
{
  template <int dim>
  void
  ExplicitIntegrator<dim>::do_scheme()
  {
    switch (parts.problem.method.order)
      {
        case StressUpdateOrder::usf:
          return usf();
        case StressUpdateOrder::usl:
          if (full_mass && steps_since_filter > 0)
            return between_filters();
          return in_initial_frame ? usl_in_initial_frame() : usl();
        case StressUpdateOrder::musl:
          return in_initial_frame ? leapfrog(0) : musl();
        case StressUpdateOrder::automatic: // has been chosen long before
        case StressUpdateOrder::usavg:
          return in_initial_frame ? leapfrog(0.5 * step) : usavg();
      }
  }



  // Update stress first, by the velocity that the points bring.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usf()
  {
    p2g_before_strain();
    control_density();
    strain_at_start(step);
    p2g_force();
    accelerate_nodes();
    account_loads(Layout::velocity);
    g2p_and_move();
  }



  // Update stress last, by the new velocity of the nodes.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usl()
  {
    p2g();
    control_density();
    note_forces();
    accelerate_nodes();
    account_loads(Layout::velocity);
    filter_and_account();
    g2p_update_stress_and_move();
  }



  // Update stress last, by the re-mapped velocity.
  template <int dim>
  void
  ExplicitIntegrator<dim>::musl()
  {
    p2g();
    control_density();
    note_forces();
    accelerate_nodes();
    g2p_and_remap();
    account_loads(Layout::strain_velocity);
    move_as_strained();
    interpolate_hanging();
    // a single nodal velocity to look up, where that moves points as well
    update_stress_and_move(step,
                           moves_as_strained ? Layout::velocity :
                                               Layout::strain_velocity);
  }



  // The average of the first and the last: half of the strain at either end,
  // loads and motion at the middle.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usavg()
  {
    p2g_before_strain();
    control_density();
    strain_at_start(0.5 * step);
    p2g_force();
    accelerate_nodes();
    g2p_and_remap();
    account_loads(Layout::strain_velocity);
    centre_velocity();
    interpolate_hanging();
    update_stress_and_move(0.5 * step, Layout::strain_velocity);
  }



  // MUSL and USAVG in the initial frame, as a leapfrog. There the shape
  // functions at the points never change: what points give back to the nodes
  // (re-mapped) is what they bring to the next step, without another P2G. One
  // velocity strains them at the end of a step and at the beginning of the
  // next, in one sweep, which forms the forces as well. @p ahead (s) is the
  // part that belongs to the beginning.
  template <int dim>
  void
  ExplicitIntegrator<dim>::leapfrog(const double ahead)
  {
    if (!keeps_velocity)
      {
        p2g_momentum();
        if (kept_nodes.empty())
          form_velocity_before();
        else
          restore_kept_nodes();
        interpolate_hanging();
      }
    strain_and_give_force(unstrained + ahead);
    find_contact();
    sum_shared_nodes(Layout::force, Layout::force + dim);
    clear_remapped();
    accelerate_nodes();
    g2p_and_remap();
    account_loads(Layout::strain_velocity);
    interpolate_hanging();
    unstrained     = step - ahead;
    keeps_velocity = true;
  }



  // The strain of a step is deferred to the next, where the same sweep forms
  // the forces.
  template <int dim>
  void
  ExplicitIntegrator<dim>::usl_in_initial_frame()
  {
    strain_and_give_force(unstrained);
    clear_momentum();
    p2g_momentum();
    note_forces();
    accelerate_nodes();
    account_loads(Layout::velocity);
    filter_and_account();
    g2p();
    strain_by_new_velocity();
    unstrained = step;
  }



  // Steps with FLIP between two that filter the velocity (XPIC, FMPM). Strained
  // by the new velocity, as these are, points would lose in each of them the
  // work of the forces on the part of it that no point takes.
  template <int dim>
  void
  ExplicitIntegrator<dim>::between_filters()
  {
    if (!in_initial_frame)
      return musl();
    strain_and_give_force(unstrained);
    clear_momentum();
    p2g_momentum();
    clear_remapped();
    note_forces();
    accelerate_nodes();
    g2p_and_remap();
    account_loads(Layout::strain_velocity);
    interpolate_hanging();
    unstrained = step;
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::leapfrogs() const
  {
    return in_initial_frame &&
           parts.problem.method.order != StressUpdateOrder::usl;
  }



  // Strain over @p length while points stay, by the velocity that they bring.
  template <int dim>
  void
  ExplicitIntegrator<dim>::strain_at_start(const double length)
  {
    form_velocity_before();
    interpolate_hanging();
    update_stress(length);
    clear_remapped();
    clear_trial_force();
  }



  // Whether contact or a separating side is active at a node depends on the
  // force as well.
  template <int dim>
  bool
  ExplicitIntegrator<dim>::needs_trial_force() const
  {
    return boundaries.any_one_sided() || contact || obstacles;
  }



  // Without contact in the step before, it is looked for before the forces are
  // known: nearly always there is none, and they are not needed.
  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g_before_strain()
  {
    if (boundaries.any_one_sided() || touched)
      p2g();
    else
      p2g_momentum();
    if (!contact && !obstacles)
      return;
    const bool touches =
      dealii::Utilities::MPI::max<unsigned int>((contact && contact->any()) ||
                                                  (obstacles &&
                                                   obstacles->any()),
                                                parts.grid.communicator) > 0;
    if (touches && !touched && !boundaries.any_one_sided())
      p2g_force();
    touched = touches;
  }



  // From the forces of the stress to the new velocity: all other forces,
  // contact and sides.
  template <int dim>
  void
  ExplicitIntegrator<dim>::accelerate_nodes()
  {
    resist_hourglass();
    damp();
    add_loads();
    advance_nodes();
    smooth_surfaces(share_of_smoothing());
    exchange_between_bodies();
    apply_boundaries();
    interpolate_hanging();
    check_nodes();
  }



  // Coefficient c of the increment f = 1 + a + c a^2 of the deformation
  // gradient, a = dt grad v over the part of the step that is strained at a
  // time, so that f is that of the motion of the points. With the new velocity
  // x' = (1 + a) x; the velocity that points bring (USF) has moved them by
  // (1 - a)^-1 before. The forces of USAVG are those of the middle of the step
  // at the places of its beginning: strained as they move, 1 + a + b (c = -1/2
  // in each half), bodies that turn by w would gain the fraction w^2 dt t of
  // their energy; strained by exp(a) exp(b) they keep it, and their radius
  // grows by half of that.
  template <int dim>
  double
  ExplicitIntegrator<dim>::square_of_strain() const
  {
    if (parts.problem.method.integration == TimeIntegration::semi_implicit)
      return 0.5; // as points move, see StressSweep::curved
    switch (parts.problem.method.order)
      {
        case StressUpdateOrder::usf:
          return 1;
        case StressUpdateOrder::usl:
        case StressUpdateOrder::musl:
          return 0;
        case StressUpdateOrder::automatic: // has been chosen long before
        case StressUpdateOrder::usavg:
          return 0.5;
      }
    return 0;
  }



  // The motion that alternates along a surface grows by gravity
  // (Rayleigh-Taylor), at a rate of about sqrt(g/h). With a tenth of this
  // damping, water at rest around a disc on 32 x 48 cells has seven times the
  // energy; without a limit the water that slips along a disc that moves is
  // held.
  template <int dim>
  double
  ExplicitIntegrator<dim>::share_of_smoothing() const
  {
    return std::min(1.,
                    50 * step *
                      std::sqrt(parts.problem.loads.gravity.norm() /
                                parts.grid.smallest_edge));
  }



  template void
  ExplicitIntegrator<2>::do_scheme();
  template double
  ExplicitIntegrator<2>::square_of_strain() const;
  template double
  ExplicitIntegrator<2>::share_of_smoothing() const;
  template void
  ExplicitIntegrator<2>::between_filters();
  template bool
  ExplicitIntegrator<2>::leapfrogs() const;
  template bool
  ExplicitIntegrator<2>::needs_trial_force() const;
  template void
  ExplicitIntegrator<3>::do_scheme();
  template double
  ExplicitIntegrator<3>::square_of_strain() const;
  template double
  ExplicitIntegrator<3>::share_of_smoothing() const;
  template void
  ExplicitIntegrator<3>::between_filters();
  template bool
  ExplicitIntegrator<3>::leapfrogs() const;
  template bool
  ExplicitIntegrator<3>::needs_trial_force() const;
} // namespace limber
