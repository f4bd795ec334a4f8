// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/side_contact.h>

namespace limber
{
  namespace
  {
    /** Why nodes feel one-sided sides, and not surfaces; empty if these do. */
    template <int dim>
    std::string
    why_at_nodes(const Body<dim> &body, const Problem<dim> &problem)
    {
      if (problem.method.integration != TimeIntegration::explicit_steps)
        return "steps are not explicit";
      if (filters_velocity(problem.method.transfer))
        return "the transfer is 'fmpm' or 'xpic'";
      if (!body.keeps_surface)
        return "its material flows without end";
      for (const Body<dim> &other : problem.bodies)
        if (other.nodal_field == body.nodal_field && !other.keeps_surface)
          return "it shares nodes with body " + in_quotes(other.name) +
                 ", which flows without end";
      return "";
    }
  } // namespace



  // What rolls or slides needs the surface, or its friction has the wrong arm;
  // an impact on nodes is softer and loses less.
  template <int dim>
  void
  choose_side_contact(Problem<dim> &problem)
  {
    std::vector<std::string> rough, smooth; // names of sides
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (problem.sides[side].one_sided)
        (problem.sides[side].friction > 0 ? rough : smooth)
          .push_back(in_quotes(side_names(dim)[side]));
    bool any = false;
    for (Body<dim> &body : problem.bodies)
      {
        const std::string reason = why_at_nodes(body, problem);
        body.meets_sides         = reason.empty();
        any                      = any || body.meets_sides;
        if (body.is_liquid)
          continue;
        const std::string feels = "Body " + in_quotes(body.name) + " feels ";
        if (!rough.empty() && !reason.empty())
          problem.notes.push_back(feels + join(rough, ", ") + " at nodes, as " +
                                  reason +
                                  ": it may end up to a cell before the side, "
                                  "and is braked by a quarter if it rolls (8 "
                                  "cells over its radius).");
        if (!smooth.empty())
          problem.notes.push_back(
            feels + join(smooth, ", ") +
            " at nodes, where impacts lose least: it may end up to a cell "
            "before the side, and what turns there is braked. For that, a "
            "'half-space' as obstacle touches its surface.");
      }
    for (Side<dim> &side : problem.sides)
      side.meets_surfaces = side.one_sided && side.friction > 0 && any;
  }



  template <int dim>
  Sides<dim>
  sides_at_nodes(Sides<dim> sides)
  {
    for (Side<dim> &side : sides)
      if (side.meets_surfaces)
        {
          side.held      = HeldComponents::none;
          side.one_sided = false;
        }
    return sides;
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
    result.shape    = std::make_shared<HalfSpaceShape<dim>>(
      side % 2 == 0 ? problem.grid.lower : problem.grid.upper, inward);
    return result;
  }



  template void
  choose_side_contact(Problem<2> &);
  template void
                    choose_side_contact(Problem<3> &);
  template Sides<2> sides_at_nodes(Sides<2>);
  template Sides<3> sides_at_nodes(Sides<3>);
  template Obstacle<2>
  half_space_beyond(unsigned int, const Problem<2> &);
  template Obstacle<3>
  half_space_beyond(unsigned int, const Problem<3> &);
} // namespace limber
