// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/base/exceptions.h>
#include <limber/base/records_of_ranks.h>
#include <limber/fem/free_motions.h>
#include <limber/fem/reference_solver.h>
#include <limber/fem/solid_totals.h>

#include <cmath>
#include <string>

/**
 * @file Initialisation of a reference, its explicit steps, and the sums over
 * every step. Steps by Newton's method are in newton.cc.
 */
namespace limber
{
  namespace
  {
    constexpr double share_of_longest_step = 0.8;
    // Explicit steps between two estimates of the stability limit
    constexpr unsigned int steps_between_looks = 200;



    /** The mass matrix on the components that are not held. */
    template <int dim>
    struct FreeMass
    {
      const SolidModel<dim> &model;

      void
      vmult(NodalVector &result, const NodalVector &vector) const
      {
        model.mass_matrix().vmult(result, vector);
        model.held().clear(result);
      }
    };



    /** Multiplication by the inverse of the lumped mass matrix (row sums). */
    struct LumpedMass
    {
      const NodalVector &masses;

      void
      vmult(NodalVector &result, const NodalVector &vector) const
      {
        for (const auto i : vector.locally_owned_elements())
          result[i] = vector[i] / masses[i];
      }
    };
  } // namespace



  namespace
  {
    template <int dim>
    SolutionMethod
    solution_method(const SolidModel<dim> &model)
    {
      if (!is_small(model))
        return SolutionMethod::conjugate_gradients;
      // as in implicit steps, see NewtonEquations::solution_method()
      return model.element->n_memory() == 0 ? SolutionMethod::cholesky :
                                              SolutionMethod::lu;
    }
  } // namespace



  template <int dim>
  ReferenceSolver<dim>::ReferenceSolver(SolidModel<dim> &model)
    : model(model)
    , method(model.problem.reference.method)
    , linear_solver(solution_method(model), dim, model.rigid_motions())
    , matrix(std::make_unique<typename SolidModel<dim>::Matrix>())
  {
    state.displacement = state.acceleration = model.make_vector();
    internal = load = inertia = unbalanced = support = model.make_vector();
    former_load = former_support = predicted = model.make_vector();
    net_force = former_net_force = model.make_vector();
    state.velocity               = method == ReferenceMethod::quasi_static ?
                                     model.make_vector() :
                                     model.initial_velocity();
    if (method != ReferenceMethod::explicit_steps)
      {
        if (!model.element->has_symmetric_tangent() && !is_small(model))
          throw InputError(
            "The material '" + model.problem.bodies.front().law +
            "' makes unsymmetric equations, which the finite element "
            "reference solves by factors alone, and " +
            std::to_string(model.dof_handler.n_dofs()) +
            " of them are too many for that. Set 'Reference/Elements over "
            "depth' smaller.");
        model.reinit(*matrix);
      }
    start();
  }



  template <int dim>
  ReferenceSolver<dim>::~ReferenceSolver() = default;



  // A body in equilibrium that nothing holds could be anywhere.
  template <int dim>
  void
  ReferenceSolver<dim>::check_free_motion() const
  {
    struct Node
    {
      dealii::Point<dim>    place;
      std::array<bool, dim> held;
    };
    std::vector<Node> own;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      Node node{place, {}};
      for (unsigned int d = 0; d < dim; ++d)
        node.held[d] = model.held().constraints().is_constrained(dofs[d]);
      own.push_back(node);
    });
    std::vector<dealii::Point<dim>>         places;
    std::vector<std::array<bool, dim>>      held;
    std::vector<std::vector<std::uint32_t>> parts(1);
    for (const auto &of_rank : gather_records(own, model.communicator))
      for (const Node &node : of_rank)
        {
          parts[0].push_back(places.size());
          places.push_back(node.place);
          held.push_back(node.held);
        }
    if (const auto free = free_rigid_motion<dim>(places, held, parts))
      throw ComputationError(
        "Nothing holds the body of the finite element reference against " +
        free->motion +
        ", so it has no place of equilibrium. Usually a side in 'Boundaries' "
        "is free or slip by mistake. Set a side that it touches to 'no slip', "
        "or 'Reference/Method = implicit'.");
  }



  template <int dim>
  void
  ReferenceSolver<dim>::start()
  {
    const ReferenceRequest &request = model.problem.reference;
    if (method == ReferenceMethod::quasi_static)
      {
        check_free_motion();
        step_limit = model.problem.end_time / request.load_steps;
        choose_loads(0);
        evaluate_residual(time_of_loads, 0);
        former_load      = load;
        former_support   = support;
        state.side_force = model.held().sum_over_sides(support);
        return;
      }

    // initial accelerations: those of held components are prescribed
    evaluate_residual(0, 0);
    NodalVector  ignored = model.make_vector(), held = model.make_vector();
    const double moment =
      1e-6 * model.smallest_edge / model.element->pressure_wave_speed;
    model.held().prescribe(
      0, state.displacement, moment, ignored, ignored, held);
    if (method == ReferenceMethod::explicit_steps)
      {
        LumpedMass{model.nodal_masses()}.vmult(state.acceleration, unbalanced);
        state.acceleration += held;
        support += model.held().inertia(model.nodal_masses(), held);
        step_limit =
          request.time_step > 0 ? request.time_step : explicit_step_limit(60);
      }
    else
      {
        model.mass_matrix().vmult(inertia, held);
        unbalanced -= inertia;
        model.held().clear(unbalanced);
        dealii::SolverControl control(1000, 1e-12 * unbalanced.l2_norm());
        dealii::SolverCG<NodalVector>(control).solve(FreeMass<dim>{model},
                                                     state.acceleration,
                                                     unbalanced,
                                                     LumpedMass{
                                                       model.nodal_masses()});
        state.acceleration += held;
        model.mass_matrix().vmult(inertia, state.acceleration);
        held = 0;
        model.held().replace(held, inertia);
        support += held;
        inertia    = 0;
        step_limit = request.time_step > 0 ?
                       request.time_step :
                       model.smallest_edge / model.element->shear_wave_speed;
      }
    state.acceleration.update_ghost_values();
    former_load      = load;
    former_support   = support;
    former_net_force = net_force;
    state.side_force = model.held().sum_over_sides(support);
  }



  // Stability limit of central differences: two over the highest circular
  // frequency.
  template <int dim>
  double
  ReferenceSolver<dim>::explicit_step_limit(const unsigned int n_iterations)
  {
    if (!fastest_mode)
      fastest_mode.emplace(model);
    const double frequency =
      fastest_mode->circular_frequency(state.displacement, n_iterations);
    if (!(frequency > 0))
      throw ComputationError(
        "The finite element reference finds no stable step at time " +
          std::to_string(state.time) +
          " s: the body resists no motion, or an element is turned inside out. "
          "Usually an earlier step was too long. Set 'Reference/Method = "
          "implicit'.",
        FailureKind::growing_energy);
    return share_of_longest_step * 2 / frequency;
  }



  template <int dim>
  void
  ReferenceSolver<dim>::explicit_step(const double step)
  {
    if (model.problem.reference.time_step == 0 &&
        state.step % steps_between_looks == 0 && state.step > 0)
      step_limit = explicit_step_limit(6);

    const double      time   = state.time + step;
    const NodalVector former = state.displacement;
    state.velocity.add(step / 2, state.acceleration);
    state.displacement.add(step, state.velocity);
    model.held().prescribe(state.time,
                           former,
                           time,
                           state.displacement,
                           state.velocity,
                           state.acceleration);
    inertia = model.held().inertia(model.nodal_masses(), state.acceleration);
    const double relative_residual = evaluate_residual(time, 0);
    if (!std::isfinite(relative_residual) ||
        !std::isfinite(state.velocity.linfty_norm()))
      throw ComputationError(
        "An element of the explicit finite element reference is turned inside "
        "out or not finite at time " +
          std::to_string(time) + " s with step " + std::to_string(step) +
          " s. Usually the step is too long. Set 'Reference/Time step = 0', or "
          "'Method = implicit'.",
        FailureKind::not_finite);
    NodalVector acceleration = model.make_vector();
    LumpedMass{model.nodal_masses()}.vmult(acceleration, unbalanced);
    model.held().replace(acceleration, state.acceleration);
    NodalVector held_velocity = state.velocity;
    state.acceleration        = acceleration;
    state.velocity.add(step / 2, state.acceleration);
    model.held().replace(state.velocity, held_velocity);
  }



  template <int dim>
  void
  ReferenceSolver<dim>::advance(const double step)
  {
    if (method == ReferenceMethod::implicit_steps)
      return newmark_step(step, 0);
    const NodalVector former = state.displacement;
    if (method == ReferenceMethod::quasi_static)
      load_step(step);
    else
      explicit_step(step);
    close_step(former, step);
  }



  template <int dim>
  void
  ReferenceSolver<dim>::close_step(const NodalVector &former, const double step)
  {
    state.displacement.update_ghost_values();
    state.velocity.update_ghost_values();
    account(former, step);
    state.time += step;
    state.step_size = step;
    ++state.step;
  }



  // Work and impulse of external forces by the trapezoidal rule, which is of
  // second order.
  template <int dim>
  void
  ReferenceSolver<dim>::account(const NodalVector &former, const double step)
  {
    NodalVector moved = state.displacement;
    moved -= former;
    state.load_work += 0.5 * (moved * load + moved * former_load);
    state.boundary_work += 0.5 * (moved * support + moved * former_support);
    state.outer_power = state.velocity * load + state.velocity * support;
    state.load_impulse +=
      0.5 * step *
      (sum_over_nodes(model, load) + sum_over_nodes(model, former_load));
    const auto force = model.held().sum_over_sides(support);
    for (unsigned int s = 0; s < 2 * dim; ++s)
      {
        state.side_impulse[s] += 0.5 * step * (force[s] + state.side_force[s]);
        state.side_force[s] = force[s];
      }
    former_load      = load;
    former_support   = support;
    former_net_force = net_force;
  }



  template class ReferenceSolver<2>;
  template class ReferenceSolver<3>;
} // namespace limber
