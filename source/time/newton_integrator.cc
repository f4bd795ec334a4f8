// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>
#include <limber/time/newton_integrator.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limber
{
  namespace
  {
    // A step that took no more iterations may be followed by a longer one.
    constexpr unsigned int quick  = 5;
    constexpr double       growth = 1.25;
    // Halved more often than this a step will not be found.
    constexpr unsigned int most_halvings = 10;



    // Growth of the compliance since the first step from which on the load is
    // said to be the limit load.
    constexpr double collapsing = 10;



    double
    size_of(const std::vector<double> &forces)
    {
      return std::sqrt(
        std::inner_product(forces.begin(), forces.end(), forces.begin(), 0.));
    }
  } // namespace



  template <int dim>
  NewtonIntegrator<dim>::NewtonIntegrator(const RunParts<dim> &parts)
    : parts(parts)
    , in_motion(parts.problem.method.integration ==
                TimeIntegration::implicit_steps)
    , loads(parts.problem, parts.grid, parts.bodies)
    , relocation(parts, loads)
    , equations(parts)
    , followers(parts, equations.numbered_nodes(), loads)
    , mass(equations.numbered_nodes())
    , newton(equations, mass, parts.problem.method.newton_tolerance, clock)
    , scheme(in_motion ? parts.problem.method.spectral_radius : 1)
    , longest(parts.problem.method.time_step > 0 ?
                parts.problem.method.time_step :
                parts.problem.end_time / default_load_steps)
    , next_step(longest)
  {
    equations.set_followers(&followers);
    relocation.reinit();
    measure_waves();
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::measure_waves()
  {
    double squared = 0;
    for (const auto &body : parts.bodies)
      squared = std::max(squared,
                         body->stress->wave_speed_squared(body->points.view()));
    wave_speed =
      std::sqrt(dealii::Utilities::MPI::max(squared, parts.grid.communicator));
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::reinit()
  {
    parts.nodes.reinit();
    equations.reinit();
    mass.clear();
    for (auto &body : parts.bodies)
      body->reinit_sums(parts.grid);
    loads.reinit();
    relocation.reinit();
    measure_waves();
  }



  template <int dim>
  IntegratorState<dim>
  NewtonIntegrator<dim>::state() const
  {
    IntegratorState<dim> result;
    result.wave_speed    = wave_speed;
    result.point_speed   = std::sqrt(extremes.speed_squared);
    result.displacement  = extremes.displacement;
    result.step          = next_step;
    result.largest_force = largest_force;
    result.compliance    = first_compliance;
    result.face_pieces   = loads.pieces();
    return result;
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::restore(const IntegratorState<dim> &former)
  {
    extremes.speed_squared = former.point_speed * former.point_speed;
    extremes.displacement  = former.displacement;
    next_step              = std::min(longest, former.step);
    largest_force          = former.largest_force;
    first_compliance       = former.compliance;
    loads.restore(former.face_pieces);
    reinit();
  }



  template <int dim>
  double
  NewtonIntegrator<dim>::advance(const double time, const double length)
  {
    clock.stopwatch.start();
    begin_step();
    double step = length;
    for (unsigned int halved = 0; !try_step(time, step); ++halved)
      {
        if (halved == most_halvings)
          fail(time, step);
        step /= 2;
        next_step = step;
        ++halvings;
      }
    if (newton.iterations() <= quick)
      next_step = std::min(longest, std::max(next_step, growth * step));
    ++steps;
    iterations += newton.iterations();
    most_iterations = std::max(most_iterations, newton.iterations());
    look_at_stability();

    relocation.end_step(extremes);
    relocation.reinit(); // sorted, as the equations want the points
    measure_waves();
    clock.lap(NewtonVerb::move_points);
    return step;
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::begin_step()
  {
    extremes.speed_squared = extremes.displacement = 0;
    relocation.begin_step();
    const bool renumbered = equations.begin_step();
    if (!in_motion && renumbered)
      {
        if (const auto free = equations.free_motion())
          throw ComputationError(
            "Nothing holds what lies between " + brief<dim>(free->lower) +
            " and " + brief<dim>(free->upper) + " m against " + free->motion +
            ", so it has no place of equilibrium. Usually a side in "
            "'Boundaries' is free or slip by mistake, or a hinge is left where "
            "cells touch in a corner. Set a side that it touches to 'no slip', "
            "or 'Method/Time integration = implicit'.");
      }
    gather_nodes();
    clock.lap(NewtonVerb::number_nodes);
  }



  namespace
  {
    // Views of what P2G and G2P of velocities are to map.
    template <int dim>
    PointView<dim>
    with_velocity(const PointView<dim> &points)
    {
      return points;
    }

    template <int dim>
    PointView<dim>
    with_acceleration_as_velocity(const PointView<dim> &points)
    {
      PointView<dim> result = points;
      result.velocity       = points.acceleration;
      return result;
    }
  } // namespace



  // Masses, and in motion the velocities and accelerations that points bring.
  template <int dim>
  void
  NewtonIntegrator<dim>::gather_nodes()
  {
    const Values momentum = gather(with_velocity<dim>);
    velocities.assign(equations.size(), 0.);
    accelerations.assign(equations.size(), 0.);
    if (!in_motion)
      return;
    mass.update(parts, masses);
    velocities = mass.velocity(momentum);
    if (scheme.needs_acceleration())
      accelerations = mass.velocity(gather(with_acceleration_as_velocity<dim>));
  }



  // P2G of what a view has as velocity: the momenta of the nodes, by equation;
  // also their lumped masses.
  template <int dim>
  typename NewtonIntegrator<dim>::Values
  NewtonIntegrator<dim>::gather(const View view)
  {
    parts.nodes.clear();
    P2GOptions what;
    what.force = false;
    for (const auto &body : parts.bodies)
      points_to_grid<dim>(view(body->points.view()),
                          parts.nodes.view(),
                          what,
                          nullptr);
    masses.assign(equations.size(), 0.);
    Values momentum(equations.size());
    parts.nodes.start_sum(Layout::mass, Layout::momentum + dim);
    parts.nodes.finish_sum();
    const NumberedNodes<dim> &nodes = equations.numbered_nodes();
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (nodes.owns(k / dim))
        {
          const double *const record =
            parts.nodes.record(nodes.on_grid()[k / dim]);
          masses[k]   = record[Layout::mass];
          momentum[k] = record[Layout::momentum + k % dim];
        }
    nodes.sum(masses);
    nodes.sum(momentum);
    return momentum;
  }



  // Displacement along an increase of the loads, over that: of the whole scene.
  // Where sides move as well it is not that of the loads alone.
  // Ten times that of the first step is a failure, plastic or by buckling, also
  // if Newton's method goes on to find places of equilibrium, as surfaces that
  // sink are held up anew.
  template <int dim>
  void
  NewtonIntegrator<dim>::look_at_compliance(const Values &increase,
                                            const Values &displacement)
  {
    const double size = size_of(increase);
    if (!(size > 1e-6 * largest_force))
      return; // constant loads: sides move
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (equations.is_held(k) && displacement[k] != 0)
        return;
    const double compliance = std::inner_product(increase.begin(),
                                                 increase.end(),
                                                 displacement.begin(),
                                                 0.) /
                              (size * size);
    if (!(first_compliance > 0))
      first_compliance = compliance;
    collapses = collapses || compliance > collapsing * first_compliance;
  }



  // Of elastic bodies: plastic flow shows in the compliance. Not in every step
  // where it takes as long as a correction; a straight column stays unstable.
  template <int dim>
  void
  NewtonIntegrator<dim>::look_at_stability()
  {
    constexpr unsigned long interval = 4; // steps
    if (in_motion || is_unstable ||
        (equations.is_iterated() && steps % interval != 0) ||
        std::any_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.is_plastic;
                    }))
      return;
    is_unstable = !equations.is_stable();
    clock.lap(NewtonVerb::solve_equations);
  }



  // Leaves points and ledger as they are where it returns false.
  template <int dim>
  bool
  NewtonIntegrator<dim>::try_step(const double time, const double step)
  {
    StepQuestion question;
    Values       given, new_given;
    const Values former_loads = loads_at(time, &given);
    question.external         = loads_at(time + step, &new_given);
    for (std::size_t k = 0; k < equations.size(); ++k)
      given[k] = 0.5 * (given[k] + new_given[k]);

    // sides move with their velocity at the middle of the step
    question.held = equations.held_velocities(time + 0.5 * step);
    for (double &displacement : question.held)
      displacement *= step;

    // Forces at the start of the step, on the present nodes
    Values displacement(equations.size());
    followers.set(time, load_factor(time));
    equations.expect(nullptr);
    equations.evaluate(displacement, nullptr);
    const Values former_followers = equations.follower_forces();
    Values       net(equations.size()); // out of balance
    for (std::size_t k = 0; k < equations.size(); ++k)
      net[k] = former_loads[k] + former_followers[k] - equations.forces()[k];
    if (!in_motion)
      largest_force = std::max({largest_force,
                                size_of(former_loads),
                                size_of(former_followers),
                                size_of(equations.forces())});
    question.largest_former_force = largest_force;
    followers.set(time + step, load_factor(time + step));
    question.followers_at_rest.assign(equations.size(), 0.);
    followers.add_forces(displacement, question.followers_at_rest);
    equations.numbered_nodes().sum(question.followers_at_rest);

    // Initial acceleration from the forces. By lumped masses: those of light
    // nodes would have a large part in the others.
    Values former_acceleration = accelerations;
    if (scheme.needs_acceleration() && time == 0)
      for (std::size_t k = 0; k < equations.size(); ++k)
        former_acceleration[k] =
          masses[k] > 0 && !equations.is_held(k) ? net[k] / masses[k] : 0;

    question.inertial_displacement.assign(equations.size(), 0.);
    const Values of_sides = equations.held_velocities(time + step);
    if (in_motion)
      {
        question.inertia = scheme.inertia() / (step * step);
        for (std::size_t k = 0; k < equations.size(); ++k)
          {
            // what is held gets the velocity of its side, whatever its
            // displacement: the neighbours feel that change
            question.inertial_displacement[k] =
              equations.is_held(k) ?
                question.held[k] - (1 + scheme.share_of_beginning()) / step *
                                     (of_sides[k] - velocities[k]) /
                                     question.inertia :
                scheme.ahead(velocities[k], former_acceleration[k], step);
            question.external[k] += scheme.share_of_beginning() * net[k];
          }
        question.former_momentum =
          question.inertia *
          size_of(mass.times(question.inertial_displacement));
      }
    clock.lap(NewtonVerb::evaluate_forces);
    if (in_motion)
      {
        equations.expect(&question.inertial_displacement);
        newton.guess(question, displacement);
      }
    if (!newton.find(question, displacement))
      {
        obstacle = newton.obstacle();
        return false;
      }
    if (!stays_with_ranks(displacement))
      return false;
    if (!in_motion)
      {
        Values increase(equations.size());
        for (std::size_t k = 0; k < equations.size(); ++k)
          increase[k] = question.external[k] + equations.follower_forces()[k] -
                        former_loads[k] - former_followers[k];
        look_at_compliance(increase, displacement);
      }

    // Follower loads are known now; to the account they are loads like others,
    // and the forces of both ends count alike.
    for (std::size_t k = 0; k < equations.size(); ++k)
      {
        question.external[k] +=
          equations.follower_forces()[k] +
          (in_motion ? (1 - scheme.share_of_beginning()) * net[k] : 0);
        given[k] +=
          0.5 * (former_followers[k] + equations.follower_forces()[k]);
      }

    // Velocities of sides at the end, and accelerations by their change.
    Values new_velocity(equations.size()), new_acceleration(equations.size());
    if (in_motion)
      {
        new_velocity         = of_sides;
        const Values of_side = equations.held_velocities(time);
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (equations.is_held(k))
            new_acceleration[k] = (new_velocity[k] - of_side[k]) / step;
          else
            {
              new_velocity[k]     = scheme.velocity(displacement[k],
                                                velocities[k],
                                                former_acceleration[k],
                                                step);
              new_acceleration[k] = scheme.acceleration(displacement[k],
                                                        velocities[k],
                                                        former_acceleration[k],
                                                        step);
            }
      }
    account(question, displacement, new_velocity, given, net, time, step);
    account_for_damping(question, displacement, new_velocity, step);
    last_step = step;
    take_motion(displacement, new_velocity, new_acceleration);
    clock.lap(NewtonVerb::move_points);
    return true;
  }



  // On several ranks no point may move by more than a cell: there is one layer
  // of ghost cells.
  template <int dim>
  bool
  NewtonIntegrator<dim>::stays_with_ranks(const Values &displacement)
  {
    if (!equations.numbered_nodes().is_parallel() ||
        std::all_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.frame == Frame::initial;
                    }) ||
        equations.longest_way(displacement) <= 1)
      return true;
    obstacle = "points would pass more than a cell, which is as far as ranks "
               "follow them (one rank does, and so does 'Frame = initial')";
    return false;
  }



  template <int dim>
  double
  NewtonIntegrator<dim>::kinetic_energy() const
  {
    double result = 0;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (int d = 0; d < dim; ++d)
          for (std::size_t p = 0; p < points.size; ++p)
            result += 0.5 * points.mass[p] * points.velocity[d][p] *
                      points.velocity[d][p];
      }
    return result;
  }



  // Update the points, at their former places, and account for it.
  template <int dim>
  void
  NewtonIntegrator<dim>::take_motion(const Values &displacement,
                                     const Values &new_velocity,
                                     const Values &new_acceleration)
  {
    const NumberedNodes<dim> &nodes    = equations.numbered_nodes();
    const auto                for_each = [&](const auto &work) {
      for (std::size_t k = 0; k < equations.size(); ++k)
        if (nodes.on_grid()[k / dim] != invalid_cell)
          work(k, parts.nodes.record(nodes.on_grid()[k / dim]) + k % dim);
      parts.nodes.interpolate_hanging();
    };
    if (loads.any())
      {
        for_each([&](const std::size_t k, double *const record) {
          record[Layout::velocity] = displacement[k] / last_step;
        });
        StressSweep what;
        what.step = last_step;
        loads.deform(parts.nodes, what);
      }
    for_each([&](const std::size_t k, double *const record) {
      record[Layout::increment] = new_velocity[k] - velocities[k];
      record[Layout::velocity]  = new_velocity[k];
    });
    if (in_motion)
      {
        // G2P gives points less of short waves than the lumped masses of light
        // nodes have.
        double       expected     = kinetic_energy();
        const Values momentum     = mass.times(velocities),
                     new_momentum = mass.times(new_velocity);
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (nodes.owns(k / dim))
            {
              const double before = 0.5 * momentum[k] * velocities[k],
                           after  = 0.5 * new_momentum[k] * new_velocity[k];
              expected += after - before;
              parts.ledger.kinetic_action += last_step * 0.5 * (before + after);
              parts.ledger.action_of_changes +=
                last_step * 0.5 * (new_momentum[k] - momentum[k]) *
                (new_velocity[k] - velocities[k]);
            }
        for (const auto &body : parts.bodies)
          extremes.speed_squared =
            std::max(extremes.speed_squared,
                     grid_to_points<dim>(
                       body->points.view(), parts.nodes.view(), {}, nullptr)
                       .speed_squared);
        parts.ledger.viscous += expected - kinetic_energy();
      }
    if (scheme.needs_acceleration())
      {
        for_each([&](const std::size_t k, double *const record) {
          record[Layout::increment] = new_acceleration[k] - accelerations[k];
          record[Layout::velocity]  = new_acceleration[k];
        });
        for (const auto &body : parts.bodies)
          grid_to_points<dim>(with_acceleration_as_velocity(
                                body->points.view()),
                              parts.nodes.view(),
                              {},
                              nullptr);
      }
    const AcceptedMotion accepted = equations.accept(displacement);
    extremes.displacement         = accepted.longest_way;
    parts.ledger.plastic += accepted.plastic_work;
  }



  template class NewtonIntegrator<2>;
  template class NewtonIntegrator<3>;
} // namespace limber
