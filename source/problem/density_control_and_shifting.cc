// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/read_parts.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // 'auto' of the density control: share of the excess of the points' volume
    // over the volume of a node that a step removes
    constexpr double density_control = 0.2;

    // 'auto' of the particle shifting, found with water that has been stirred.
    constexpr double particle_shifting = 2;



    /**
     * Whether the box is full, with no free surface for bodies to move into:
     * the centres of all cells are in bodies or obstacles at the start.
     */
    template <int dim>
    bool
    is_full(const Problem<dim> &problem)
    {
      std::vector<ObstaclePlace<dim>> places;
      for (const auto &obstacle : problem.obstacles)
        places.emplace_back(obstacle, 0);
      const auto is_in_any = [&](const dealii::Point<dim> &x) {
        return std::any_of(problem.bodies.begin(),
                           problem.bodies.end(),
                           [&](const auto &body) {
                             return body.shape->contains(x);
                           }) ||
               std::any_of(places.begin(),
                           places.end(),
                           [&](const auto &place) {
                             return place.distance(x).value < 0;
                           });
      };
      const auto   &grid = problem.grid;
      unsigned long n    = 1;
      for (const unsigned int cells : grid.cells)
        n *= cells;
      // from the last cell on: empty cells are most often at the top
      for (unsigned long cell = n; cell-- > 0;)
        {
          dealii::Point<dim> middle;
          unsigned long      rest = cell;
          for (unsigned int d = 0; d < dim; ++d)
            {
              middle[d] =
                grid.lower[d] + (rest % grid.cells[d] + 0.5) * grid.edge(d);
              rest /= grid.cells[d];
            }
          if (!is_in_any(middle))
            return false;
        }
      return true;
    }



    /**
     * Whether the volume that the points at a node should have is known: not
     * with solids, which may have less volume than at first.
     */
    template <int dim>
    bool
    may_control_density(const Problem<dim> &problem, const Body<dim> &body)
    {
      if (problem.method.integration == TimeIntegration::semi_implicit)
        return std::all_of(problem.bodies.begin(),
                           problem.bodies.end(),
                           [](const auto &other) { return other.is_liquid; });
      return problem.method.integration == TimeIntegration::explicit_steps &&
             body.is_liquid && body.treatment == Treatment::cell &&
             problem.grid.kernel == KernelKind::linear &&
             problem.grid.levels == 0 &&
             std::count_if(problem.bodies.begin(),
                           problem.bodies.end(),
                           [&](const auto &other) {
                             return other.nodal_field == body.nodal_field;
                           }) == 1;
    }



    /**
     * Whether there is room to expand into, or need to. In explicit steps what
     * is pushed apart in a full box raises the pressure everywhere; in
     * semi-implicit ones points move instead, at the price of a second solution
     * of the pressure, and without it stirred water that has weight parts from
     * its lid and sinks.
     */
    template <int dim>
    bool
    may_expand(const Problem<dim> &problem)
    {
      return (problem.method.integration == TimeIntegration::semi_implicit &&
              problem.loads.gravity.norm() > 0) ||
             !is_full(problem);
    }



    template <int dim>
    void
    read_density_control(const Section      &section,
                         const Problem<dim> &problem,
                         Body<dim>          &body)
    {
      const bool possible  = may_control_density(problem, body);
      const bool automatic = section.text("Density control") == "auto";
      body.density_control = !automatic ? section.number("Density control") :
                             possible && may_expand(problem) ? density_control :
                                                               0;
      if (body.density_control > 0 && !possible)
        throw InputError("The entry 'Density control' in " +
                         section.where("Density control") +
                         " is for liquids alone: in 'semi-implicit' steps in "
                         "the scene, in explicit ones at their nodes, with "
                         "'cell', linear functions, equal cells. Set "
                         "'Density control = auto'.");
    }



    /**
     * Particle shifting is for volume ratios averaged over cells, or around
     * nodes: only there points that gather (clumping) weigh more than their
     * pressure balances. It has not been tried with other kernels.
     */
    template <int dim>
    bool
    may_shift(const Problem<dim> &problem, const Body<dim> &body)
    {
      return body.is_liquid &&
             (problem.grid.kernel == KernelKind::linear ?
                body.treatment == Treatment::cell :
                problem.grid.kernel == KernelKind::quadratic &&
                  (body.treatment == Treatment::cell ||
                   body.treatment == Treatment::node));
    }



    template <int dim>
    void
    read_particle_shifting(const Section      &section,
                           const Problem<dim> &problem,
                           Body<dim>          &body)
    {
      const bool possible    = may_shift(problem, body);
      body.particle_shifting = section.text("Particle shifting") != "auto" ?
                                 section.number("Particle shifting") :
                               possible ? particle_shifting :
                                          0;
      if (body.particle_shifting > 0 && !possible)
        throw InputError("The particle shifting " +
                         section.text("Particle shifting") + " in " +
                         section.where("Particle shifting") +
                         " is for liquids with 'Locking treatment = cell' and "
                         "'Kernel = linear' or 'quadratic'. Usually one of "
                         "them was changed alone. Set 'Particle shifting = "
                         "auto'.");
    }
  } // namespace



  template <int dim>
  void
  choose_density_control_and_shifting(const Section &root,
                                      Problem<dim>  &problem)
  {
    for (auto &body : problem.bodies)
      {
        const Section section = root.subsection("Body " + body.name);
        read_density_control(section, problem, body);
        read_particle_shifting(section, problem, body);
      }
  }



  template void
  choose_density_control_and_shifting(const Section &, Problem<2> &);
  template void
  choose_density_control_and_shifting(const Section &, Problem<3> &);
} // namespace limber
