// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /**
     * Whether a liquid is driven without end (stirred): by a side with a
     * velocity or a rotating obstacle. A displaced obstacle may be a piston,
     * which is no stirrer.
     */
    template <int dim>
    bool
    is_stirred(const Problem<dim> &problem)
    {
      const auto does_something = [](const Formula<dim> &formula) {
        return !formula.empty() && !formula.is_zero();
      };
      return std::any_of(problem.sides.begin(),
                         problem.sides.end(),
                         [&](const Side<dim> &side) {
                           return does_something(side.velocity);
                         }) ||
             std::any_of(problem.obstacles.begin(),
                         problem.obstacles.end(),
                         [&](const Obstacle<dim> &obstacle) {
                           return does_something(obstacle.rotation);
                         });
    }
  } // namespace



  template <int dim>
  void
  choose_histories(const Section &root, Problem<dim> &problem)
  {
    // 'crossing' relaxes within the time in which a point crosses a cell, which
    // differs between cells of several sizes.
    if (problem.method.integration != TimeIntegration::explicit_steps ||
        (problem.grid.kernel != KernelKind::linear &&
         problem.grid.kernel != KernelKind::quadratic) ||
        problem.grid.levels > 0 || !is_stirred(problem))
      return;
    for (Body<dim> &body : problem.bodies)
      if (body.is_liquid && averages_volume_in_cells(body.treatment) &&
          root.subsection("Body " + body.name).text("History") == "auto")
        {
          body.history = HistoryTreatment::crossing;
          problem.notes.push_back(
            "Body " + in_quotes(body.name) +
            ": history 'auto' is 'crossing', as in a liquid that is stirred "
            "the volumes of points drift apart until one turns inside out.");
        }
  }



  template void
  choose_histories<2>(const Section &, Problem<2> &);
  template void
  choose_histories<3>(const Section &, Problem<3> &);
} // namespace limber
