// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/newton_integrator.h>

#include <cmath>
#include <numeric>

namespace limber
{
  template <int dim>
  double
  NewtonIntegrator<dim>::load_factor(const double time) const
  {
    const Problem<dim> &problem = parts.problem;
    if (in_motion)
      return 1;
    if (problem.loads.factor.empty())
      return time / problem.end_time;
    const double factor = problem.loads.factor.value({}, time);
    if (!std::isfinite(factor))
      throw ComputationError("'Loads/Load factor' is not finite at time " +
                             brief(time) +
                             " s. Usually the formula is undefined there. Set "
                             "one that is finite at all times.");
    return factor;
  }



  // External forces on the nodes at a time, N, without follower loads. @p
  // given: the same less the full weight, i.e. loads and, as long as the load
  // factor is not 1, what it changes of the weight.
  template <int dim>
  typename NewtonIntegrator<dim>::Values
  NewtonIntegrator<dim>::loads_at(const double time, Values *const given)
  {
    if (loads.any())
      loads.add(parts.nodes, time, false);
    const double              factor = load_factor(time);
    const NumberedNodes<dim> &nodes  = equations.numbered_nodes();
    Values                    result(equations.size());
    if (loads.any())
      {
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (nodes.owns(k / dim))
            result[k] = loads.on_node(0, nodes.on_grid()[k / dim])[k % dim];
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



  // In a step, kg m/s; zero in equilibrium.
  template <int dim>
  typename NewtonIntegrator<dim>::Values
  NewtonIntegrator<dim>::gained_momentum(const Values &new_velocity) const
  {
    Values change = new_velocity;
    if (!in_motion)
      return change;
    for (std::size_t k = 0; k < change.size(); ++k)
      change[k] -= velocities[k];
    return mass.times(change);
  }



  // Loads and sides do work on the displacement with the mean of their forces
  // at both ends; the work of the ghost penalty is lost. So is, in equilibrium,
  // the work of residual forces at the start of the step: points that have
  // crossed cells act on other nodes, the ghost penalty starts from zero, and a
  // body jumps to its new equilibrium as if damped.
  template <int dim>
  void
  NewtonIntegrator<dim>::account(const StepQuestion &question,
                                 const Values       &displacement,
                                 const Values       &new_velocity,
                                 const Values       &given,
                                 const Values       &net,
                                 const double        time,
                                 const double        step)
  {
    // Nodal values are the same on all ranks, but ledgers are summed.
    if (dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator) > 0)
      return;
    Ledger<dim> &ledger = parts.ledger;
    ledger.load_work +=
      std::inner_product(given.begin(), given.end(), displacement.begin(), 0.);
    ledger.viscous += equations.ghost_work() + equations.reset_work();
    const double factor        = load_factor(time + step);
    double       between_steps = 0;
    const Values gained        = gained_momentum(new_velocity);
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
        // Reaction of the side, at the end and as the mean of the step
        double force = 0, mean = 0;
        if (in_motion)
          {
            force = mean = gained[k] / step -
                           0.5 * (question.external[k] - equations.forces()[k]);
            // The difference between the velocities of the points and of the
            // side is lost as in an impact.
            ledger.viscous +=
              gained[k] * (displacement[k] / step -
                           0.5 * (new_velocity[k] + velocities[k]));
          }
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



  // Generalised-alpha changes the momentum by other forces than the mean of
  // those at the ends of the step: energy and impulse are those of its damping.
  // The trapezoidal rule has none.
  template <int dim>
  void
  NewtonIntegrator<dim>::account_for_damping(const StepQuestion &question,
                                             const Values       &displacement,
                                             const Values       &new_velocity,
                                             const double        step)
  {
    if (!scheme.needs_acceleration() ||
        dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator) > 0)
      return;
    double       damped = 0;
    const Values gained = gained_momentum(new_velocity);
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (!equations.is_held(k))
        {
          const double mean =
            0.5 * (question.external[k] - equations.forces()[k]);
          damped += mean * displacement[k] -
                    0.5 * gained[k] * (new_velocity[k] + velocities[k]);
          parts.ledger.load_impulse[k % dim] += gained[k] - step * mean;
        }
    parts.ledger.viscous += damped;
    lost_in_time += damped;
  }



#define INSTANTIATE(dim)                                                         \
  template double              NewtonIntegrator<dim>::load_factor(double) const; \
  template std::vector<double> NewtonIntegrator<dim>::loads_at(double,           \
                                                               Values *);        \
  template std::vector<double> NewtonIntegrator<dim>::gained_momentum(           \
    const Values &) const;                                                       \
  template void NewtonIntegrator<dim>::account(const StepQuestion &,             \
                                               const Values &,                   \
                                               const Values &,                   \
                                               const Values &,                   \
                                               const Values &,                   \
                                               double,                           \
                                               double);                          \
  template void NewtonIntegrator<dim>::account_for_damping(                      \
    const StepQuestion &, const Values &, const Values &, double);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace limber
