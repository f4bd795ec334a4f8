// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>
#include <limber/time/point_deformation.h>

#include <algorithm>
#include <utility>

/** @file The sweeps of an explicit step over the points of all bodies. */
namespace limber
{
  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g()
  {
    give({});
    sum_shared_nodes(0, Layout::remapped);
    finish_giving({});
    find_contact();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g_momentum()
  {
    P2GOptions what;
    what.force = false;
    give(what);
    sum_shared_nodes(0, Layout::remapped);
    finish_giving(what);
    find_contact();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::p2g_force()
  {
    P2GOptions what;
    what.momentum = false;
    give(what);
    sum_shared_nodes(Layout::force, Layout::force + dim);
    finish_giving(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::give(P2GOptions what)
  {
    what.affine = what.momentum && is_affine(parts.problem.method.transfer);
    relocation.note_batches(sweeps.points_to_grid(what));
    lap(Verb::points_to_grid);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::finish_giving(const P2GOptions &what)
  {
    sweeps.finish_points_to_grid(what);
    lap(Verb::points_to_grid);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::sum_shared_nodes(const unsigned int first,
                                            const unsigned int last)
  {
    parts.nodes.for_each_field([&]() {
      parts.nodes.start_sum(first, last);
      parts.nodes.finish_sum();
    });
    lap(Verb::sum_shared_nodes);
  }



  // Find contact of bodies and obstacles, as soon as nodal masses are known.
  template <int dim>
  void
  ExplicitIntegrator<dim>::find_contact()
  {
    if (contact)
      contact->find(step);
    if (obstacles)
      obstacles->find(time, step);
    lap(Verb::touch);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_and_move()
  {
    G2POptions what;
    what.move = step;
    take(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p()
  {
    take({});
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_and_remap()
  {
    G2POptions what;
    what.remap = true;
    take(what);
    sum_shared_nodes(Layout::remapped, Layout::remapped + dim);
    if (leapfrogs())
      keep_momentum();
    form_velocity_after();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::take(G2POptions what)
  {
    what.affine              = is_affine(parts.problem.method.transfer);
    what.flip_share          = flip_share();
    what.light_density       = light_share();          // times that of a body
    const bool asks_for_mass = what.light_density > 0; // of all nodes
    if (asks_for_mass)
      parts.nodes.for_each_field(
        [this]() { parts.nodes.lend_mass_to_hanging(); });
    sweeps.grid_to_points(what, extremes);
    if (asks_for_mass)
      parts.nodes.for_each_field(
        [this]() { parts.nodes.take_mass_from_hanging(); });
    lap(Verb::grid_to_points);
  }



  // For APIC: nodes with less mass than this share of that of a full cell are
  // light. Of two directions in which nodes may be light C^2/2 is the least
  // that is stable; four times as much costs no energy that one would notice
  // (dam break). AFLIP has no such bound.
  template <int dim>
  double
  ExplicitIntegrator<dim>::light_share() const
  {
    if (parts.problem.method.transfer != Transfer::apic)
      return 0;
    const double courant_number =
      wave_speed * step / relocation.smallest_edge();
    return 2 * courant_number * courant_number;
  }



  // Share of FLIP in the velocities of points; the rest is PIC.
  template <int dim>
  double
  ExplicitIntegrator<dim>::flip_share() const
  {
    const Method &method = parts.problem.method;
    if (method.transfer == Transfer::pic || method.transfer == Transfer::apic ||
        (full_mass && steps_since_filter == 0))
      return 0;
    return method.blend_time > 0 ? std::max(0., 1 - step / method.blend_time) :
                                   1;
  }



  // While points stay where they are.
  template <int dim>
  void
  ExplicitIntegrator<dim>::update_stress(const double length)
  {
    StressSweep what;
    what.step     = length;
    what.remapped = true;
    strain(what);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::update_stress_and_move(const double       length,
                                                  const unsigned int slot)
  {
    StressSweep what;
    what.step     = length;
    what.remapped = slot == Layout::strain_velocity;
    what.move     = step;
    strain(what);
  }



  // By the new velocity of the nodes. Points with a stencil of their own take
  // their velocities in the same sweep, which spares looking it up once more.
  template <int dim>
  void
  ExplicitIntegrator<dim>::g2p_update_stress_and_move()
  {
    G2POptions taken;
    taken.affine     = is_affine(parts.problem.method.transfer);
    taken.flip_share = flip_share();
    sweeps.grid_to_points_ahead(taken, extremes);
    lap(Verb::grid_to_points);

    StressSweep what;
    what.step       = step;
    what.move       = step;
    what.flip_share = taken.flip_share;
    strain(what);
  }



  // In the initial frame. Forces have yet to be summed over ranks.
  template <int dim>
  void
  ExplicitIntegrator<dim>::strain_and_give_force(const double length)
  {
    StressSweep what;
    what.step       = length;
    what.remapped   = true;
    what.give_force = true;
    strain(what);
    unstrained       = 0;
    stress_is_behind = true;
  }



  // Bring stress up to date, for output. Wave speeds remain those of the steps:
  // the next one is to be as long whether anybody has looked or not. Where a
  // step has failed, nodes may hold anything.
  template <int dim>
  void
  ExplicitIntegrator<dim>::synchronise()
  {
    if (!stress_is_behind)
      return;
    stopwatch.start();
    if (!(unstrained > 0))
      clear_remapped();
    const StepExtremes those_of_the_step = extremes;
    StressSweep        what;
    what.step     = std::exchange(unstrained, 0.);
    what.remapped = true;
    strain(what);
    if (leapfrogs() && what.step > 0)
      show_velocity();
    extremes         = those_of_the_step;
    stress_is_behind = false;
  }



  // Loaded faces and surfaces in contact are strained by the same velocity. The
  // means over cells are those of the beginning of the step: volumetric
  // histories relax towards them once, before anything is strained.
  template <int dim>
  void
  ExplicitIntegrator<dim>::strain(StressSweep what)
  {
    what.shift_share = what.step / step;
    what.square      = square_of_strain();
    what.curved =
      parts.problem.method.integration == TimeIntegration::semi_implicit;
    sweeps.average_gradients(what.remapped ? Layout::strain_velocity :
                                             Layout::velocity);
    loads.deform(parts.nodes, what, sweeps.mean_gradients());
    for (auto &body : parts.bodies)
      deform_surface(parts.nodes, *body, what, sweeps.mean_gradients());
    sweeps.update_stress(what,
                         {std::exchange(history_time, 0.),
                          what.step,
                          point_speed},
                         extremes);
    lap(Verb::update_stress);
  }



  template void
  ExplicitIntegrator<2>::p2g();
  template void
  ExplicitIntegrator<2>::p2g_momentum();
  template void
  ExplicitIntegrator<2>::p2g_force();
  template void
  ExplicitIntegrator<2>::find_contact();
  template void
  ExplicitIntegrator<2>::g2p_and_move();
  template void
  ExplicitIntegrator<2>::g2p();
  template void
  ExplicitIntegrator<2>::g2p_and_remap();
  template void
  ExplicitIntegrator<2>::update_stress(double);
  template void
  ExplicitIntegrator<2>::update_stress_and_move(double, unsigned int);
  template void
  ExplicitIntegrator<2>::g2p_update_stress_and_move();
  template void
  ExplicitIntegrator<2>::strain_and_give_force(double);
  template void
  ExplicitIntegrator<2>::synchronise();
  template void
  ExplicitIntegrator<3>::p2g();
  template void
  ExplicitIntegrator<3>::p2g_momentum();
  template void
  ExplicitIntegrator<3>::p2g_force();
  template void
  ExplicitIntegrator<3>::find_contact();
  template void
  ExplicitIntegrator<3>::g2p_and_move();
  template void
  ExplicitIntegrator<3>::g2p();
  template void
  ExplicitIntegrator<3>::g2p_and_remap();
  template void
  ExplicitIntegrator<3>::update_stress(double);
  template void
  ExplicitIntegrator<3>::update_stress_and_move(double, unsigned int);
  template void
  ExplicitIntegrator<3>::g2p_update_stress_and_move();
  template void
  ExplicitIntegrator<3>::strain_and_give_force(double);
  template void
  ExplicitIntegrator<3>::synchronise();
} // namespace limber
