// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/time/averaged_volumes.h>
#include <limber/time/newton_equations.h>
#include <limber/time/newton_tangent.h>

#include <algorithm>
#include <cmath>

/** @file The linear equations of a correction of Newton's method. */
namespace limber
{
  template <int dim>
  bool
  NewtonEquations<dim>::solve(const std::vector<double> &unbalanced,
                              const std::vector<double> &of_held,
                              std::vector<double>       &correction)
  {
    if (!is_iterated() && !volumes->all().empty())
      condense_volumes();
    const NodalVector right_side = tangent->right_side(unbalanced, of_held);
    NodalVector       solution(size());
    try
      {
        n_linear_iterations += volumes->all().empty() ?
                                 solve_condensed(solution, right_side) :
                                 volumes->solve(tangent->values(),
                                                rigid_motions(),
                                                of_held,
                                                right_side,
                                                solution);
      }
    catch (const IterationsFailed &failure)
      {
        failed_iterations = failure.event;
        too_large         = size() > most_factorised;
        if (too_large)
          {
            why_unsolved = failure.event + ", and " + std::to_string(size()) +
                           " unknowns are too many to factorise (at most " +
                           std::to_string(most_factorised) + ")";
            return false;
          }
        factorises_all = true; // from now on
        return solve(unbalanced, of_held, correction);
      }
    catch (const ComputationError &)
      {
        why_unsolved = "the equations have no unique solution";
        return false;
      }
    correction.resize(size());
    double all = 0;
    for (std::size_t k = 0; k < size(); ++k)
      {
        // multigrid leaves round-off on held components, with which Newton's
        // method would never converge
        correction[k] = is_held(k) ? of_held[k] : solution[k];
        all += std::abs(correction[k]);
      }
    if (!std::isfinite(all))
      why_unsolved = "the equations have no unique solution";
    return std::isfinite(all);
  }



  template <int dim>
  SolutionMethod
  NewtonEquations<dim>::solution_method() const
  {
    if (is_iterated())
      return SolutionMethod::conjugate_gradients;
    // At large plastic flow entries differ across the diagonal by 2e-3 of the
    // largest one with J2 as well (block_collapse): with one triangle of them
    // Newton's method fails there.
    const bool flows = std::any_of(parts.bodies.begin(),
                                   parts.bodies.end(),
                                   [](const auto &body) {
                                     return body->description.is_plastic;
                                   });
    const bool is_symmetric =
      !flows && (followers == nullptr || !followers->any());
    return is_symmetric ? SolutionMethod::cholesky : SolutionMethod::lu;
  }



  // The multigrid of a step's first tangent serves the others as long as it
  // takes few more iterations: to set it up takes as long as thirteen of them
  // (a bar in torsion).
  template <int dim>
  unsigned int
  NewtonEquations<dim>::solve_condensed(NodalVector       &solution,
                                        const NodalVector &right_side)
  {
    constexpr double     still_serves = 1.5; // times the iterations
    const SolutionMethod method       = solution_method();
    const bool           is_former =
      is_iterated() && set_up_serves && solver->method == method;
    if (!is_factorised || solver->method != method)
      {
        // Factors keep the order of the equations, multigrid nothing.
        if (!solver || solver->method != method ||
            (is_iterated() && !is_former))
          solver.emplace(method,
                         dim,
                         is_iterated() ? rigid_motions() :
                                         std::vector<double>(),
                         most_iterations);
        if (!is_former)
          solver->set_matrix(tangent->values());
      }
    is_factorised = set_up_serves = true;
    try
      {
        const unsigned int n = solver->solve(solution, right_side);
        if (!is_former)
          iterations_of_set_up = n;
        set_up_serves = n <= still_serves * iterations_of_set_up;
        return n;
      }
    catch (const IterationsFailed &)
      {
        if (!is_former)
          throw;
        is_factorised = set_up_serves = false;
        return solve_condensed(solution, right_side);
      }
  }



  template bool
  NewtonEquations<2>::solve(const std::vector<double> &,
                            const std::vector<double> &,
                            std::vector<double> &);
  template SolutionMethod
  NewtonEquations<2>::solution_method() const;
  template unsigned int
  NewtonEquations<2>::solve_condensed(NodalVector &, const NodalVector &);
  template bool
  NewtonEquations<3>::solve(const std::vector<double> &,
                            const std::vector<double> &,
                            std::vector<double> &);
  template SolutionMethod
  NewtonEquations<3>::solution_method() const;
  template unsigned int
  NewtonEquations<3>::solve_condensed(NodalVector &, const NodalVector &);
} // namespace limber
