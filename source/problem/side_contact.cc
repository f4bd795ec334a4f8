// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/materials/law_list.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/side_contact.h>

namespace limber
{
  namespace
  {
    /** Whether points go on to be what they were to the surface of a body. */
    template <int dim>
    bool
    keeps_surface(const Body<dim> &body)
    {
      return !body.is_liquid &&
             (!body.is_plastic || flows_like_metal(body.law, body.material));
    }



    /** Why nodes feel one-sided sides, and not surfaces; empty if these do. */
    template <int dim>
    std::string
    why_at_nodes(const Body<dim> &body, const Problem<dim> &problem)
    {
      if (problem.method.integration != TimeIntegration::explicit_steps)
        return "steps are not explicit";
      if (filters_velocity(problem.method.transfer))
        return "the transfer is 'fmpm' or 'xpic'";
      if (!keeps_surface(body))
        return "its material flows without end";
      for (const Body<dim> &other : problem.bodies)
        if (other.nodal_field == body.nodal_field && !keeps_surface(other))
          return "it shares nodes with body " + in_quotes(other.name) +
                 ", which flows without end";
      return "";
    }
  } // namespace



  template <int dim>
  void
  choose_side_contact(Problem<dim> &problem)
  {
    std::vector<std::string> names;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (problem.sides[side].one_sided)
        names.push_back(in_quotes(side_names(dim)[side]));
    if (names.empty())
      return;
    bool any = false;
    for (Body<dim> &body : problem.bodies)
      {
        const std::string reason = why_at_nodes(body, problem);
        body.meets_sides         = reason.empty();
        any                      = any || body.meets_sides;
        if (!body.meets_sides && !body.is_liquid)
          problem.notes.push_back(
            "Body " + in_quotes(body.name) + " feels " +
            (names.size() > 1 ? "the sides " : "the side ") +
            join(names, ", ") + " at nodes, as " + reason +
            ": it ends up to a cell before them; if it rolls, it is braked" +
            (reason.find("transfer") != std::string::npos ?
               ". 'Transfer = flip' does better." :
               "."));
      }
    for (Side<dim> &side : problem.sides)
      side.meets_surfaces = side.one_sided && any;
  }



  template <int dim>
  Obstacle<dim>
  half_space_beyond(const unsigned int side, const Problem<dim> &problem)
  {
    dealii::Tensor<1, dim> inward;
    inward[side / 2] = side % 2 == 0 ? 1 : -1;
    Obstacle<dim> result;
    result.name     = side_names(dim)[side];
    result.friction = problem.sides[side].friction;
    result.shape =
      std::make_shared<HalfSpaceShape<dim>>(side % 2 == 0 ? problem.grid.lower :
                                                            problem.grid.upper,
                                            inward);
    return result;
  }



  template void
  choose_side_contact(Problem<2> &);
  template void
  choose_side_contact(Problem<3> &);
  template Obstacle<2>
  half_space_beyond(unsigned int, const Problem<2> &);
  template Obstacle<3>
  half_space_beyond(unsigned int, const Problem<3> &);
} // namespace limber
