// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/newton_method.h>
#include <limber/time/nodal_mass.h>

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
    constexpr unsigned int most_searches          = 8;    // backtracking steps
    constexpr double       sufficient_decrease    = 1e-4; // Armijo
    // Where a body flies freely, inertia is a difference of nearly equal
    // numbers, and below this share of them nothing but round-off.
    constexpr double known_share = 1e-6;
    // The ghost penalty is restarted so often within a step (its reference is
    // set to the current displacement), each time when the relative residual is
    // below this share. A beam that has been bent by its length and let go
    // stays bent by 1.4 % without, by 0.04 % with one restart, by 1e-5 with
    // two, which cost less than one iteration. A body half a cell thick, all of
    // whose cells are cut, takes more, as the penalty is stiffer than it is;
    // one that flows plastically may collapse along the way.
    constexpr unsigned int most_renewals = 12, most_if_plastic = 2;
    constexpr double       nearly_found = 0.1;
    // Share of the strain energy below which the ghost penalty does not matter
    // and is not restarted. Cook's membrane would take twice the iterations
    // with a tenth of it.
    constexpr double known_ghost_energy = 1e-4;



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



    [[noreturn]] void
    refuse(const std::string &obstacle)
    {
      throw ComputationError(
        "The equations of this step cannot be solved: " + obstacle +
        ". Usually Poisson's ratio is close to 0.5. Set 'Locking treatment = "
        "cell', 'Kernel = linear', or coarser 'Grid/Cells'.");
    }
  } // namespace



  template <int dim>
  bool
  NewtonMethod<dim>::find(const StepQuestion &question, Values &displacement)
  {
    const Values start = displacement;
    if (solve(question, false, displacement))
      return true;
    displacement = start;
    return solve(question, true, displacement);
  }



  template <int dim>
  void
  NewtonMethod<dim>::guess(const StepQuestion &question, Values &displacement)
  {
    Values ahead = question.inertial_displacement;
    for (std::size_t k = 0; k < equations.size(); ++k)
      if (equations.is_held(k))
        ahead[k] = question.held[k];
    // At rest first: its forces are known from the start of the step, and those
    // of what is usually nearer will be asked for again.
    Values       residual;
    const double at_rest = evaluate_residual(question, displacement, residual);
    if (evaluate_residual(question, ahead, residual) < at_rest)
      displacement = ahead;
  }



  template <int dim>
  typename NewtonMethod<dim>::Values
  NewtonMethod<dim>::inertial_forces(const StepQuestion &question,
                                     const Values       &displacement) const
  {
    Values way(displacement.size());
    if (question.inertia == 0)
      return way;
    for (std::size_t k = 0; k < way.size(); ++k)
      way[k] = question.inertia *
               (displacement[k] - question.inertial_displacement[k]);
    return mass.times(way);
  }



  template <int dim>
  double
  NewtonMethod<dim>::evaluate_residual(const StepQuestion &question,
                                       const Values       &displacement,
                                       Values             &residual)
  {
    const bool admissible = equations.evaluate(displacement, nullptr);
    clock.lap(NewtonVerb::evaluate_forces);
    if (!admissible)
      return infinite;
    residual.resize(equations.size());
    const Values inertia = inertial_forces(question, displacement);
    for (std::size_t k = 0; k < equations.size(); ++k)
      residual[k] = equations.is_held(k) ?
                      0 :
                      question.external[k] + equations.follower_forces()[k] -
                        equations.forces()[k] - inertia[k];
    const double scale         = std::max({norm(question.external),
                                           norm(equations.follower_forces()),
                                           norm(equations.forces()),
                                           norm(inertia),
                                           known_share * question.former_momentum,
                                           question.largest_former_force});
    const double residual_norm = norm(residual);
    return residual_norm <= equations.round_off(displacement) ?
             0 :
             residual_norm / scale;
  }



  // Total potential, whose derivative is the residual, but for the work of
  // follower loads, which is that of the mean of their forces before and after.
  template <int dim>
  double
  NewtonMethod<dim>::potential(const StepQuestion &question,
                               const Values       &displacement) const
  {
    double result = equations.energy() -
                    product(question.external, displacement) -
                    0.5 * (product(question.followers_at_rest, displacement) +
                           product(equations.follower_forces(), displacement));
    const Values inertia = inertial_forces(question, displacement);
    for (std::size_t k = 0; k < equations.size(); ++k)
      result += 0.5 * inertia[k] *
                (displacement[k] - question.inertial_displacement[k]);
    return result;
  }



  // Restart the ghost penalty at the displacement that was found, or further on
  // along the way from the @p last restart (empty: there was none), to where
  // the potential without the penalty is least (by the secant): what the
  // penalty resists most would approach in many small steps. Not with plastic
  // bodies.
  template <int dim>
  void
  NewtonMethod<dim>::renew_ghost_penalty(const StepQuestion &question,
                                         const Values       &last,
                                         Values             &displacement,
                                         Values             &residual)
  {
    constexpr double longest_way = 100; // over that since the last restart
    const auto       restart_at  = [&](const Values &place) {
      equations.count_jumps_from(place);
      relative_residual = evaluate_residual(question, place, residual);
    };
    restart_at(displacement);
    if (last.empty() || equations.any_flows())
      return;
    const Values found = displacement;
    Values       way   = found;
    for (std::size_t k = 0; k < way.size(); ++k)
      way[k] -= last[k];
    const auto go = [&](const double share) {
      for (std::size_t k = 0; k < way.size(); ++k)
        displacement[k] = found[k] + share * way[k];
      restart_at(displacement);
    };
    const double pull = product(residual, way);
    go(1);
    const double pull_ahead =
      relative_residual < infinite ? product(residual, way) : pull;
    if (pull > 0 && pull_ahead < pull)
      go(std::min(pull / (pull - pull_ahead), longest_way));
    if (!(pull > 0 && pull_ahead < pull) || relative_residual == infinite)
      go(0);
  }



  // Newton's method from the given displacement on.
  template <int dim>
  bool
  NewtonMethod<dim>::solve(const StepQuestion &question,
                           const bool          search,
                           Values             &displacement)
  {
    Values residual, correction, former, last_restart,
      of_held(equations.size());
    const unsigned int most =
      equations.any_flows() ? most_if_plastic : most_renewals;
    unsigned int renewals = 0;
    n_iterations          = 0;
    equations.count_jumps_from(Values(equations.size(), 0.));
    relative_residual = evaluate_residual(question, displacement, residual);
    while (true)
      {
        double remaining = 0; // of prescribed displacements
        for (std::size_t k = 0; k < equations.size(); ++k)
          if (equations.is_held(k))
            {
              of_held[k] = question.held[k] - displacement[k];
              remaining  = std::max(remaining, std::abs(of_held[k]));
            }
        // Near convergence the ghost penalty is relaxed: nodes of small cuts
        // are about where they are going to be.
        if (remaining == 0 && relative_residual <= nearly_found &&
            n_iterations > 0 && renewals < most &&
            equations.ghost_energy() > known_ghost_energy * equations.energy())
          {
            ++renewals;
            renew_ghost_penalty(question, last_restart, displacement, residual);
            last_restart = displacement;
          }
        if (remaining == 0 && relative_residual <= tolerance)
          return true;
        if (n_iterations == most_newton_iterations + renewals)
          {
            reason = "after " + std::to_string(n_iterations) + " iterations " +
                     brief(relative_residual) +
                     " of the forces are out of balance";
            return false;
          }
        ++n_iterations;
        ++n_corrections;

        const double       before = potential(question, displacement);
        const Inertia<dim> inertia{mass, question.inertia};
        equations.evaluate(displacement,
                           &inertia,
                           search || former.empty() ? nullptr : &former);
        former = displacement;
        clock.lap(NewtonVerb::assemble_tangent);
        const bool solved = equations.solve(residual, of_held, correction);
        clock.lap(NewtonVerb::solve_equations);
        if (!solved)
          {
            // shorter steps would fail alike with their first correction
            if (equations.is_too_large() && n_iterations == 1)
              refuse(equations.obstacle());
            reason = equations.obstacle();
            return false;
          }
        // where forces nearly vanish, round-off of large ones remains
        if (remaining == 0 && relative_residual <= 1e-4 &&
            norm(correction) <= 1e-11 * norm(displacement))
          return true;
        const bool any = remaining > 0 || !search;
        if (!improves(question,
                      correction,
                      any ? infinite : before,
                      any ? infinite : relative_residual,
                      displacement,
                      residual))
          {
            reason = relative_residual == infinite ?
                       "a point is turned inside out" :
                       "no direction lowers the energy";
            return false;
          }
      }
  }



  // Backtracking line search along the correction, until the potential (Armijo)
  // or the residual decreases enough; where these are infinite, until no point
  // is inverted.
  template <int dim>
  bool
  NewtonMethod<dim>::improves(const StepQuestion &question,
                              const Values       &correction,
                              const double        former_potential,
                              const double        former_residual,
                              Values             &displacement,
                              Values             &residual)
  {
    const double expected = product(residual, correction);
    const Values start    = displacement;
    double       share    = 1;
    for (unsigned int k = 0; k < most_searches; ++k, share /= 2)
      {
        for (std::size_t i = 0; i < start.size(); ++i)
          displacement[i] = share == 1 && equations.is_held(i) ?
                              question.held[i] :
                              start[i] + share * correction[i];
        relative_residual = evaluate_residual(question, displacement, residual);
        if (relative_residual == infinite)
          continue;
        if (relative_residual < 0.5 * former_residual ||
            (expected > 0 &&
             potential(question, displacement) <=
               former_potential - sufficient_decrease * share * expected))
          return true;
      }
    return false;
  }



  template class NewtonMethod<2>;
  template class NewtonMethod<3>;
} // namespace limber
