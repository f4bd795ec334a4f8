// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/base/exceptions.h>
#include <limber/fem/reference_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

/**
 * @file Residual forces, Newton's method, and the steps of a reference that
 * need it: load steps, and time steps of the HHT-alpha method (Hilber, Hughes
 * and Taylor 1977).
 */
namespace limber
{
  namespace
  {
    constexpr double       infinite = std::numeric_limits<double>::infinity();
    constexpr unsigned int most_iterations = 25;
    // of a load step, before it is given up
    constexpr double       smallest_part = 1. / 256;
    constexpr unsigned int most_halvings = 8; // of a time step, likewise
    // alpha of Hilber, Hughes and Taylor (1977): the share of the forces of the
    // step before. It damps what the step does not resolve, by 10 % a step.
    constexpr double delay = 0.05;
    // Modified Newton: a kept tangent has to reduce the residual to this share.
    constexpr double good_reduction = 0.1;
  } // namespace



  // Stresses have an error of some last bits of a strain of one: a residual of
  // a body at rest below this is round-off, N.
  template <int dim>
  double
  ReferenceSolver<dim>::round_off_of_forces() const
  {
    constexpr double strain = 16 * std::numeric_limits<double>::epsilon();
    const double     wave   = model.element->pressure_wave_speed;
    return strain * model.element->density * wave * wave *
           std::pow(model.smallest_edge, dim - 1) *
           std::sqrt(double(model.dof_handler.n_dofs()));
  }



  // Residual forces at the present displacement, relative to the largest force:
  // zero within round-off, infinite where an element is inverted.
  template <int dim>
  double
  ReferenceSolver<dim>::evaluate_residual(const double time,
                                          const double mass_factor)
  {
    state.displacement.update_ghost_values();
    if (!model.internal_forces(state.displacement, internal))
      return infinite;
    model.loads(state.displacement, time, load);
    load *= load_factor;
    unbalanced = load;
    unbalanced.add(load_factor, model.gravity());
    const double external = unbalanced.l2_norm();
    if (mass_factor != 0)
      {
        state.acceleration = state.displacement;
        state.acceleration -= predicted;
        state.acceleration *= (1 - delay) * mass_factor;
        model.mass_matrix().vmult(inertia, state.acceleration);
      }
    unbalanced -= internal;
    net_force = unbalanced;
    support   = inertia;
    support -= unbalanced;
    NodalVector of_free = support;
    model.held().clear(of_free);
    support -= of_free;

    // HHT-alpha: with a share of the forces of the step before, over that of
    // the new ones
    if (mass_factor != 0)
      unbalanced.add(delay / (1 - delay),
                     former_net_force,
                     -1 / (1 - delay),
                     inertia);
    else
      unbalanced -= inertia;
    model.held().clear(unbalanced);

    const double scale =
      std::max({external, internal.l2_norm(), inertia.l2_norm()});
    const double residual_norm = unbalanced.l2_norm();
    return residual_norm <= round_off_of_forces() ? 0 : residual_norm / scale;
  }



  template <int dim>
  void
  ReferenceSolver<dim>::renew_tangent(const double       mass_factor,
                                      const NodalVector *former)
  {
    model.assemble(state.displacement, mass_factor, *matrix, former);
    linear_solver.set_matrix(*matrix);
    matrix_mass_factor = mass_factor;
    ++state.factorisations;
  }



  // Newton's method from the present displacement; false where it fails.
  template <int dim>
  bool
  ReferenceSolver<dim>::solve(const double time,
                              const double mass_factor,
                              const bool   keep_tangent)
  {
    NodalVector correction = model.make_vector(), before = correction;
    double      former = infinite;
    relative_residual  = evaluate_residual(time, mass_factor);
    for (unsigned int k = 0;
         k < most_iterations && std::isfinite(relative_residual);
         ++k)
      {
        if (relative_residual <= model.problem.reference.tolerance)
          return true;
        if (!keep_tangent || !matrix_serves(mass_factor) ||
            relative_residual > good_reduction * former)
          renew_tangent(mass_factor, k > 0 ? &before : nullptr);
        before = state.displacement;
        linear_solver.solve(correction, unbalanced);
        ++state.newton_steps;
        // Where forces nearly cancel, round-off of large ones remains.
        if (relative_residual <= 1e-4 &&
            correction.l2_norm() <= 1e-11 * state.displacement.l2_norm())
          return true;

        former = relative_residual;
        state.displacement += correction;
        relative_residual = evaluate_residual(time, mass_factor);
        for (unsigned int half = 0; half < 8 && relative_residual == infinite;
             ++half)
          {
            correction *= 0.5;
            state.displacement -= correction;
            relative_residual = evaluate_residual(time, mass_factor);
          }
      }
    return relative_residual <= model.problem.reference.tolerance;
  }



  template <int dim>
  bool
  ReferenceSolver<dim>::matrix_serves(const double mass_factor) const
  {
    return std::abs(matrix_mass_factor - mass_factor) <=
           1e-6 * std::abs(mass_factor);
  }



  template <int dim>
  void
  ReferenceSolver<dim>::fail(const double time, const std::string &entry) const
  {
    std::ostringstream text;
    text << "Newton's method of the finite element reference ends with "
         << relative_residual << " of the forces unbalanced at time " << time
         << " s. Usually the step is too long, the body buckles or its flow "
            "bears no more load, or the tolerance is finer than round-off. "
            "Set 'Reference/"
         << entry << "' finer, or 'Reference/Tolerance' above that number.";
    throw ComputationError(text.str());
  }



  // Predictor: the increment of prescribed displacements is spread to the other
  // nodes by the tangent at the start, so that no element inverts before
  // Newton's method begins.
  template <int dim>
  void
  ReferenceSolver<dim>::follow_held(const NodalVector &former)
  {
    NodalVector direction = state.displacement;
    direction -= former;
    const double size = direction.linfty_norm();
    if (size == 0)
      return;
    const double step  = 1e-6 * model.smallest_edge / size;
    NodalVector  ahead = model.make_vector(), moved = former;
    moved.add(step, direction);
    moved.update_ghost_values();
    NodalVector start = former;
    start.update_ghost_values();
    if (!model.internal_forces(moved, ahead) ||
        !model.internal_forces(start, internal))
      return;
    ahead -= internal;
    ahead *= -1 / step;
    model.held().clear(ahead);
    model.assemble(start, 0, *matrix);
    linear_solver.set_matrix(*matrix);
    matrix_mass_factor = 0;
    ++state.factorisations;
    linear_solver.solve(moved, ahead);
    state.displacement += moved;
  }



  // Loads of an equilibrium. A quasi-static scene says which loads act at a
  // time. For a scene in motion its history of loads is not followed, as
  // inertia is part of it; they grow from zero to what they are at the end.
  template <int dim>
  void
  ReferenceSolver<dim>::choose_loads(const double time)
  {
    const Problem<dim> &problem = model.problem;
    const bool          is_told =
      problem.method.integration == TimeIntegration::quasi_static;
    time_of_loads = is_told ? time : problem.end_time;
    load_factor   = is_told && !problem.loads.factor.empty() ?
                      problem.loads.factor.value({}, time) :
                      time / problem.end_time;
  }



  // A load step in which Newton's method fails is divided (adaptive steps).
  template <int dim>
  void
  ReferenceSolver<dim>::load_step(const double step)
  {
    double      time = state.time, part = step;
    NodalVector velocity = model.make_vector(), none = velocity;
    while (time < state.time + step * (1 - 1e-9))
      {
        const NodalVector former = state.displacement;
        part                     = std::min(part, state.time + step - time);
        choose_loads(time + part);
        model.held().prescribe(
          time, former, time + part, state.displacement, velocity, none);
        follow_held(former);
        if (solve(time_of_loads, 0, false))
          {
            state.displacement.update_ghost_values();
            state.plastic_work += model.accept(state.displacement);
            time += part;
            part *= 2;
            continue;
          }
        state.displacement = former;
        part /= 2;
        if (part < smallest_part * step)
          fail(time, "Load steps");
      }
  }



  // A time step in which Newton's method fails is halved.
  template <int dim>
  void
  ReferenceSolver<dim>::newmark_step(const double       step,
                                     const unsigned int halved)
  {
    const SolidMotion<dim> start = state;
    if (try_newmark_step(step))
      {
        state.displacement.update_ghost_values();
        state.plastic_work += model.accept(state.displacement);
        return close_step(start.displacement, step);
      }
    const auto newton_steps = state.newton_steps,
               tangents     = state.factorisations;
    state                   = start;
    state.newton_steps      = newton_steps;
    state.factorisations    = tangents;
    if (halved == most_halvings)
      fail(state.time + step, "Time step");
    newmark_step(step / 2, halved + 1);
    newmark_step(step / 2, halved + 1);
  }



  template <int dim>
  bool
  ReferenceSolver<dim>::try_newmark_step(const double step)
  {
    const double      time                = state.time + step;
    const double      beta                = (1 + delay) * (1 + delay) / 4;
    const double      gamma               = 0.5 + delay;
    const double      factor              = 1 / (beta * step * step);
    const NodalVector former              = state.displacement;
    const NodalVector former_velocity     = state.velocity;
    const NodalVector former_acceleration = state.acceleration;

    predicted = state.displacement;
    predicted.add(step,
                  state.velocity,
                  (0.5 - beta) * step * step,
                  state.acceleration);
    // predictor: the acceleration of the step before
    state.displacement = predicted;
    state.displacement.add(1 / factor, state.acceleration);
    NodalVector held_acceleration = model.make_vector();
    model.held().prescribe(state.time,
                           former,
                           time,
                           state.displacement,
                           state.velocity,
                           held_acceleration);
    // so that the Newmark formulas give the prescribed displacement and
    // acceleration of held components
    NodalVector held_predicted = state.displacement;
    held_predicted.add(-1 / factor, held_acceleration);
    model.held().replace(predicted, held_predicted);

    if (!solve(time, factor / (1 - delay), true))
      return false;

    NodalVector held_velocity = state.velocity;
    state.velocity            = former_velocity;
    state.velocity.add((1 - gamma) * step,
                       former_acceleration,
                       gamma * step,
                       state.acceleration);
    model.held().replace(state.velocity, held_velocity);
    return true;
  }



  template double
  ReferenceSolver<2>::evaluate_residual(const double, const double);
  template void
  ReferenceSolver<2>::choose_loads(const double);
  template void
  ReferenceSolver<2>::load_step(const double);
  template void
  ReferenceSolver<2>::newmark_step(const double, const unsigned int);
  template double
  ReferenceSolver<3>::evaluate_residual(const double, const double);
  template void
  ReferenceSolver<3>::choose_loads(const double);
  template void
  ReferenceSolver<3>::load_step(const double);
  template void
  ReferenceSolver<3>::newmark_step(const double, const unsigned int);
} // namespace limber
