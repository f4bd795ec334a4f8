// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/newton_integrator.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace limber
{
  namespace
  {
    constexpr double infinite = std::numeric_limits<double>::infinity();

    constexpr unsigned int most_newton_iterations = 20;
    constexpr unsigned int most_searches          = 8; // of a line, by halves
    constexpr double       sufficient_decrease    = 1e-4; // Armijo
    // A step that took no more iterations may be followed by a longer one.
    constexpr unsigned int quick  = 5;
    constexpr double       growth = 1.25;
    // Of a quasi-static run that does not say how long its steps are
    constexpr double share_of_run = 0.1;
    // Where a body flies freely, inertia is a difference of numbers that are
    // alike, and below this share of them nothing but round-off.
    constexpr double known_share = 1e-6;
    // Halved more often than this a step will not be found.
    constexpr unsigned int most_halvings = 10;



    double
    norm(const std::vector<double> &values)
    {
      return std::sqrt(
        std::inner_product(values.begin(), values.end(), values.begin(), 0.));
    }



    double
    product(const std::vector<double> &a, const std::vector<double> &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
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
    , longest(parts.problem.method.time_step > 0 ?
                parts.problem.method.time_step :
                share_of_run * parts.problem.end_time)
    , next_step(longest)
  {
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
    result.wave_speed   = wave_speed;
    result.point_speed  = std::sqrt(extremes.speed_squared);
    result.displacement = extremes.displacement;
    result.step         = next_step;
    result.face_pieces  = loads.pieces();
    return result;
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::restore(const IntegratorState<dim> &former)
  {
    extremes.speed_squared = former.point_speed * former.point_speed;
    extremes.displacement  = former.displacement;
    next_step              = std::min(longest, former.step);
    loads.restore(former.face_pieces);
    reinit();
  }



  template <int dim>
  std::vector<std::pair<std::string, double>>
  NewtonIntegrator<dim>::verb_seconds() const
  {
    return {{"number nodes", seconds[number_nodes]},
            {"evaluate forces", seconds[evaluate_forces]},
            {"assemble tangent", seconds[assemble_tangent]},
            {"solve equations", seconds[solve_equations]},
            {"move points", seconds[move_points]}};
  }



  template <int dim>
  std::string
  NewtonIntegrator<dim>::effort() const
  {
    return "Newton's method: " +
           brief(double(iterations) / double(std::max(1ul, steps))) +
           " iterations a step, at most " + std::to_string(most_iterations) +
           "; steps halved: " + std::to_string(halvings) +
           (lost_between_steps != 0 ?
              "; lost to forces out of balance between steps: " +
                brief(lost_between_steps) + " J" :
              "") +
           (equations.linear_iterations() > 0 ?
              std::string(equations.is_mixed() ?
                            "; minimal residuals of displacements and "
                            "pressures: " :
                            "; conjugate gradients: ") +
                brief(double(equations.linear_iterations()) /
                      double(std::max(1ul, corrections))) +
                " iterations a correction" +
                (equations.gave_up_iterating() ?
                   ", until they failed; factorised since" :
                   "") :
              "");
  }



  template <int dim>
  double
  NewtonIntegrator<dim>::advance(const double time, const double length)
  {
    stopwatch.start();
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
    if (last_iterations <= quick)
      next_step = std::min(longest, std::max(next_step, growth * step));
    ++steps;
    iterations += last_iterations;
    most_iterations = std::max(most_iterations, last_iterations);

    relocation.end_step(extremes);
    relocation.reinit(); // sorted, as the equations want the points
    measure_waves();
    lap(move_points);
    return step;
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::fail(const double time, const double step) const
  {
    throw ComputationError("No step was found from time " + brief(time) +
                           " s on, down to one of " + brief(step) +
                           " s: " + obstacle +
                           ". Usually the body buckles, tears or is crushed "
                           "there. Look at the last state, refine 'Grid/Cells',"
                           " or set 'Time integration = explicit'.");
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::begin_step()
  {
    extremes.speed_squared = extremes.displacement = 0;
    relocation.begin_step();
    equations.begin_step();
    if (!in_motion)
      {
        const std::string motion = equations.free_motion();
        if (!motion.empty())
          throw ComputationError(
            "Nothing holds a body against " + motion +
            ", so it has no place of equilibrium. Usually a side in "
            "'Boundaries' is free or slip by mistake. Set one that the body "
            "touches to 'no slip', or 'Method/Time integration = implicit'.");
      }
    gather_nodes();
    lap(number_nodes);
  }



  // Lumped masses, and in motion the velocities that points bring.
  template <int dim>
  void
  NewtonIntegrator<dim>::gather_nodes()
  {
    parts.nodes.clear();
    GiveToGrid what;
    what.force = false;
    for (const auto &body : parts.bodies)
      points_to_grid<dim>(body->points.view(),
                          parts.nodes.view(),
                          what,
                          nullptr);
    masses.assign(equations.size(), 0.);
    velocities.assign(equations.size(), 0.);
    parts.nodes.start_sum(Layout::mass, Layout::momentum + dim);
    parts.nodes.finish_sum();
    const NumberedNodes<dim> &nodes = equations.numbered_nodes();
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (nodes.owns(k / dim))
        {
          const double *const record =
            parts.nodes.record(nodes.on_grid()[k / dim]);
          masses[k] = record[Layout::mass];
          if (masses[k] > 0)
            velocities[k] = record[Layout::momentum + k % dim] / masses[k];
        }
    nodes.sum(masses);
    nodes.sum(velocities);
  }



  template <int dim>
  double
  NewtonIntegrator<dim>::load_factor(const double time) const
  {
    const Problem<dim> &problem = parts.problem;
    return in_motion                    ? 1 :
           problem.loads.factor.empty() ? time / problem.end_time :
                                          problem.loads.factor.value({}, time);
  }



  // Forces on the nodes at a time, N; @p given are those of them that are not
  // the weight, with what holds part of it while the load grows.
  template <int dim>
  typename NewtonIntegrator<dim>::Values
  NewtonIntegrator<dim>::loads_at(const double time, Values *const given)
  {
    if (loads.any())
      loads.add(parts.nodes, time);
    const double              factor = load_factor(time);
    const NumberedNodes<dim> &nodes  = equations.numbered_nodes();
    Values                    result(equations.size());
    if (loads.any())
      {
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (nodes.owns(k / dim))
            result[k] = loads.on_node(nodes.on_grid()[k / dim])[k % dim];
        nodes.sum(result);
      }
    if (given != nullptr)
      given->resize(equations.size());
    for (std::size_t k = 0; k < equations.size(); ++k)
      {
        const double weight = masses[k] * parts.problem.loads.gravity[k % dim];
        result[k]           = factor * (weight + result[k]);
        if (given != nullptr)
          (*given)[k] = result[k] - weight;
      }
    return result;
  }



  // Leaves points and ledger as they are where it returns false.
  template <int dim>
  bool
  NewtonIntegrator<dim>::try_step(const double time, const double step)
  {
    Question     question;
    Values       given, new_given;
    const Values former_loads = loads_at(time, &given);
    question.external         = loads_at(time + step, &new_given);
    for (std::size_t k = 0; k < equations.size(); ++k)
      given[k] = 0.5 * (given[k] + new_given[k]);

    // a side goes on its way with the velocity of the middle of the step
    question.held = equations.held_velocities(time + 0.5 * step);
    for (double &displacement : question.held)
      displacement *= step;

    // The forces of the beginning, at the present places
    Values displacement(equations.size());
    equations.evaluate(displacement, nullptr);
    Values net(equations.size()); // as they would accelerate
    for (std::size_t k = 0; k < equations.size(); ++k)
      net[k] = former_loads[k] - equations.forces()[k];

    question.inertia.assign(equations.size(), 0.);
    question.inertial_displacement.assign(equations.size(), 0.);
    if (in_motion)
      for (std::size_t k = 0; k < equations.size(); ++k)
        {
          question.inertia[k]               = 4 * masses[k] / (step * step);
          question.inertial_displacement[k] = step * velocities[k];
          question.external[k] += net[k];
        }
    lap(evaluate_forces);
    // Whole corrections take fewer iterations, shortened ones arrive more
    // often.
    if (in_motion)
      guess(question, displacement);
    const Values start = displacement;
    if (!solve(question, false, displacement))
      {
        displacement = start;
        if (!solve(question, true, displacement))
          return false;
      }
    if (!stays_with_ranks(displacement))
      return false;

    // v1 = v0 + 2 (u / dt - v0); sides say how fast they are at the end
    Values new_velocity(equations.size());
    if (in_motion)
      {
        new_velocity = equations.held_velocities(time + step);
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (!equations.is_held(k))
            new_velocity[k] = 2 * displacement[k] / step - velocities[k];
      }
    account(question, displacement, new_velocity, given, net, time, step);
    last_step = step;
    take_motion(displacement, new_velocity);
    lap(move_points);
    return true;
  }



  // Of several ranks: each knows one layer of cells around its own.
  template <int dim>
  bool
  NewtonIntegrator<dim>::stays_with_ranks(const Values &displacement)
  {
    const NumberedNodes<dim> &nodes = equations.numbered_nodes();
    if (!nodes.is_parallel() || std::none_of(parts.bodies.begin(),
                                             parts.bodies.end(),
                                             [](const auto &body) {
                                               return body->description.frame ==
                                                      Frame::current;
                                             }))
      return true;
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (std::abs(displacement[k]) > nodes.edge(k % dim))
        {
          obstacle = "points would pass more than a cell, which is as far as "
                     "ranks follow them (one rank does, and so does 'Frame = "
                     "initial')";
          return false;
        }
    return true;
  }



  // As if nothing accelerated, where that is nearer to balance than no
  // displacement.
  template <int dim>
  void
  NewtonIntegrator<dim>::guess(const Question &question, Values &displacement)
  {
    Values ahead = question.inertial_displacement;
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (equations.is_held(k))
        ahead[k] = question.held[k];
    Values left;
    if (unbalance(question, ahead, left) <
        unbalance(question, displacement, left))
      displacement = ahead;
  }



  template <int dim>
  double
  NewtonIntegrator<dim>::unbalance(const Question &question,
                                   const Values   &displacement,
                                   Values         &left)
  {
    const bool admissible = equations.evaluate(displacement, nullptr);
    lap(evaluate_forces);
    if (!admissible)
      return infinite;
    left.resize(equations.size());
    double of_inertia = 0, of_momentum = 0;
    for (std::size_t k = 0; k < equations.size(); ++k)
      {
        const double inertia =
          question.inertia[k] *
          (displacement[k] - question.inertial_displacement[k]);
        left[k] = equations.is_held(k) ?
                    0 :
                    question.external[k] - equations.forces()[k] - inertia;
        of_inertia += inertia * inertia;
        const double momentum =
          question.inertia[k] * question.inertial_displacement[k];
        of_momentum += momentum * momentum;
      }
    const double scale = std::max({norm(question.external),
                                   norm(equations.forces()),
                                   std::sqrt(of_inertia),
                                   known_share * std::sqrt(of_momentum),
                                   equations.round_off()});
    return norm(left) / scale;
  }



  // Whose derivative is the unbalance
  template <int dim>
  double
  NewtonIntegrator<dim>::potential(const Question &question,
                                   const Values   &displacement) const
  {
    double result =
      equations.energy() - product(question.external, displacement);
    for (std::size_t k = 0; k < equations.size(); ++k)
      {
        const double way = displacement[k] - question.inertial_displacement[k];
        result += 0.5 * question.inertia[k] * way * way;
      }
    return result;
  }



  // Newton's method from the given displacement on.
  template <int dim>
  bool
  NewtonIntegrator<dim>::solve(const Question &question,
                               const bool      search,
                               Values         &displacement)
  {
    Values left, correction, former, of_held(equations.size());
    last_iterations = 0;
    rest            = unbalance(question, displacement, left);
    while (true)
      {
        double remaining = 0; // of the way of held components
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (equations.is_held(k))
            {
              of_held[k] = question.held[k] - displacement[k];
              remaining  = std::max(remaining, std::abs(of_held[k]));
            }
        if (remaining == 0 && rest <= parts.problem.method.newton_tolerance)
          return true;
        if (last_iterations == most_newton_iterations)
          {
            obstacle = "after " + std::to_string(last_iterations) +
                       " iterations " + brief(rest) +
                       " of the forces are out of balance";
            return false;
          }
        ++last_iterations;
        ++corrections;

        const double before = potential(question, displacement);
        equations.evaluate(displacement,
                           &question.inertia,
                           search || former.empty() ? nullptr : &former);
        former = displacement;
        lap(assemble_tangent);
        const bool solved = equations.solve(left, of_held, correction);
        lap(solve_equations);
        if (!solved)
          {
            obstacle = "the equations have no unique solution";
            return false;
          }
        // where forces nearly vanish, round-off of large ones remains
        if (remaining == 0 && rest <= 1e-4 &&
            norm(correction) <= 1e-11 * norm(displacement))
          return true;
        const bool any = remaining > 0 || !search;
        if (!improves(question,
                      correction,
                      any ? infinite : before,
                      any ? infinite : rest,
                      displacement,
                      left))
          {
            obstacle = rest == infinite ? "a point is turned inside out" :
                                          "no direction lowers the energy";
            return false;
          }
      }
  }



  // Goes along the correction until energy or unbalance are less; where these
  // are infinite, until no point is turned inside out.
  template <int dim>
  bool
  NewtonIntegrator<dim>::improves(const Question &question,
                                  const Values   &correction,
                                  const double    former_potential,
                                  const double    former_rest,
                                  Values         &displacement,
                                  Values         &left)
  {
    const double expected = product(left, correction);
    const Values start    = displacement;
    double       share    = 1;
    for (unsigned int k = 0; k < most_searches; ++k, share /= 2)
      {
        for (std::size_t i = 0; i < start.size(); ++i)
          displacement[i] = start[i] + share * correction[i];
        rest = unbalance(question, displacement, left);
        if (rest == infinite)
          continue;
        if (rest < 0.5 * former_rest ||
            (expected > 0 &&
             potential(question, displacement) <=
               former_potential - sufficient_decrease * share * expected))
          return true;
      }
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



  // The points take what has been found, at their former places.
  template <int dim>
  void
  NewtonIntegrator<dim>::take_motion(const Values &displacement,
                                     const Values &new_velocity)
  {
    const NumberedNodes<dim> &nodes    = equations.numbered_nodes();
    const auto                for_each = [&](const auto &work) {
      for (std::size_t k = 0; k < equations.size(); ++k)
        if (nodes.on_grid()[k / dim] != invalid_cell)
          work(k, parts.nodes.record(nodes.on_grid()[k / dim]) + k % dim);
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
        // Points get less of short waves than lumped masses have.
        double expected = kinetic_energy();
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (nodes.owns(k / dim))
            expected += 0.5 * masses[k] *
                        (new_velocity[k] * new_velocity[k] -
                         velocities[k] * velocities[k]);
        for (const auto &body : parts.bodies)
          extremes.speed_squared =
            std::max(extremes.speed_squared,
                     grid_to_points<dim>(
                       body->points.view(), parts.nodes.view(), {}, nullptr)
                       .speed_squared);
        parts.ledger.viscous += expected - kinetic_energy();
      }
    const AcceptedMotion accepted = equations.accept(displacement);
    extremes.displacement         = accepted.longest_way;
    parts.ledger.plastic += accepted.plastic_work;
  }



  // Loads and sides work along the way of the step with the mean of their
  // forces; what is spent on jumps of the strain is lost. So is, in
  // equilibrium, the work of forces that were out of balance when the step
  // began: points that have crossed cells give theirs to other nodes, the ghost
  // penalty begins anew, and what is loaded springs to its new place as if
  // damped.
  template <int dim>
  void
  NewtonIntegrator<dim>::account(const Question &question,
                                 const Values   &displacement,
                                 const Values   &new_velocity,
                                 const Values   &given,
                                 const Values   &net,
                                 const double    time,
                                 const double    step)
  {
    // All ranks know the same of nodes; what is on record they sum up.
    if (dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator) > 0)
      return;
    Ledger<dim> &ledger = parts.ledger;
    ledger.load_work += product(given, displacement);
    ledger.viscous += equations.ghost_energy();
    const double factor        = load_factor(time + step);
    double       between_steps = 0;
    for (std::size_t k = 0; k < equations.size(); ++k)
      {
        const int    d = k % dim;
        const double weight =
          factor * masses[k] * parts.problem.loads.gravity[d];
        const double load =
          in_motion ? given[k] : question.external[k] - weight;
        ledger.gravity_impulse[d] += step * weight;
        ledger.load_impulse[d] += step * load;
        if (!equations.is_held(k))
          {
            if (!in_motion)
              between_steps += 0.5 * net[k] * displacement[k];
            continue;
          }
        // What the side gives, at the end and as the mean of the step
        double force = 0, mean = 0;
        if (in_motion)
          force = mean = masses[k] * (new_velocity[k] - velocities[k]) / step -
                         0.5 * (question.external[k] - equations.forces()[k]);
        else
          {
            force = equations.forces()[k] - question.external[k];
            mean  = 0.5 * (force - net[k]);
          }
        ledger.side_impulse[equations.side(k)][d] += step * force;
        ledger.boundary_work += mean * displacement[k];
      }
    ledger.viscous += between_steps;
    lost_between_steps += between_steps;
  }



  template class NewtonIntegrator<2>;
  template class NewtonIntegrator<3>;
} // namespace limber
