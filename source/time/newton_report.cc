// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/time/newton_integrator.h>

/** @file What implicit and quasi-static runs tell: warnings, effort, failure.
 */
namespace limber
{
  template <int dim>
  std::vector<std::pair<std::string, double>>
  NewtonIntegrator<dim>::verb_seconds() const
  {
    const auto &seconds = clock.seconds; // in the order of NewtonVerb
    return {{"number nodes", seconds[0]},
            {"evaluate forces", seconds[1]},
            {"assemble tangent", seconds[2]},
            {"solve equations", seconds[3]},
            {"move points", seconds[4]}};
  }



  template <int dim>
  std::string
  NewtonIntegrator<dim>::warning()
  {
    if (collapses && !told_of_collapse)
      {
        told_of_collapse = true;
        return "loads begin to move the material ten times as far, for the "
               "same increase, as at first. Usually it collapses or buckles "
               "(limit load). Take the load from the rows around; what "
               "follows depends on 'Grid/Cells'.";
      }
    if (is_unstable && !told_of_instability)
      {
        told_of_instability = true;
        return "the equilibrium is not stable: the stiffness is negative along "
               "one motion. Usually a slender body is compressed by more than "
               "its buckling load, and stays straight as all is symmetric. "
               "Give it an imperfection, as a side load of a thousandth, and "
               "set a shorter 'Method/Time step', to follow the shape that it "
               "really takes.";
      }
    if (warned || equations.failure_of_iterations().empty())
      return "";
    warned = true;
    return equations.failure_of_iterations() +
           (equations.gave_up_iterating() ?
              ". All " + std::to_string(equations.size()) +
                " unknowns are factorised from now on, which takes longer." :
              ". The step was tried again with half the length.") +
           " Usually Poisson's ratio is close to 0.5 or the body buckles. Set "
           "'Locking treatment = cell', a shorter 'Method/Time step', or "
           "coarser 'Grid/Cells'.";
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
           (lost_in_time != 0 ?
              "; damped by generalised-alpha: " + brief(lost_in_time) + " J" :
              "") +
           (equations.linear_iterations() > 0 ?
              std::string(
                equations.is_mixed() ?
                  "; generalised minimal residuals of displacements and "
                  "pressures: " :
                  "; conjugate gradients: ") +
                brief(double(equations.linear_iterations()) /
                      double(std::max(1ul, newton.corrections()))) +
                " iterations a correction" +
                (equations.gave_up_iterating() ?
                   ", until " + equations.failure_of_iterations() +
                     "; factorised since" :
                   "") :
              "");
  }



  template <int dim>
  void
  NewtonIntegrator<dim>::fail(const double time, const double step) const
  {
    throw ComputationError(
      "No step was found from time " + brief(time) + " s on, down to one of " +
      brief(step) + " s: " + obstacle +
      ". Usually the load is the largest that can be borne "
      "(limit load), or the body buckles, tears or is "
      "crushed. Look at the last state, refine "
      "'Grid/Cells', or set 'Time integration = "
      "explicit'.");
  }



#define INSTANTIATE(dim)                                            \
  template std::vector<std::pair<std::string, double>>              \
                       NewtonIntegrator<dim>::verb_seconds() const; \
  template std::string NewtonIntegrator<dim>::warning();            \
  template std::string NewtonIntegrator<dim>::effort() const;       \
  template void        NewtonIntegrator<dim>::fail(double, double) const;

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace limber
