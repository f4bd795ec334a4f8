// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/half_space.h>
#include <limber/problem/read_parts.h>
#include <limber/problem/side_contact.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /**
     * The body that flows without end among those in the nodal field of a body,
     * itself included; null: none.
     */
    template <int dim>
    const Body<dim> *
    who_flows(const Body<dim> &body, const Problem<dim> &problem)
    {
      if (!body.keeps_surface)
        return &body;
      for (const Body<dim> &other : problem.bodies)
        if (other.nodal_field == body.nodal_field && !other.keeps_surface)
          return &other;
      return nullptr;
    }
  } // namespace



  template <int dim>
  std::string
  why_at_nodes(const Body<dim> &body, const Problem<dim> &problem)
  {
    if (problem.method.integration != TimeIntegration::explicit_steps)
      return "steps are not explicit";
    const Body<dim> *const flowing = who_flows(body, problem);
    if (flowing == &body)
      return "its material flows without end";
    if (flowing != nullptr)
      return "it shares nodes with body " + in_quotes(flowing->name) +
             ", which flows without end";
    return "";
  }



  // A body that lies at a slip side from the start is held there in both
  // directions, as by a plane of symmetry.
  template <int dim>
  bool
  may_be_hit(const unsigned int  side,
             const bool          face_loads,
             const Problem<dim> &problem)
  {
    const Side<dim> &wall = problem.sides[side];
    if (wall.one_sided)
      return true;
    if (wall.held != HeldComponents::normal || !wall.velocity.empty())
      return false;
    const auto &bodies = problem.bodies;
    return std::none_of(bodies.begin(),
                        bodies.end(),
                        [&](const Body<dim> &body) {
                          return has_face_in(side, body, problem.grid) ||
                                 is_held(body, problem);
                        }) &&
           !std::all_of(bodies.begin(),
                        bodies.end(),
                        [&](const Body<dim> &body) {
                          return stays_clear(face_loads, body, problem);
                        });
  }



  // A condition at nodes stops a body up to one cell before the side: if its
  // speed is small against its wave speeds, a block then rebounds by a quarter
  // too fast, and rolling bodies are braked
  // (doc/theory/boundaries_and_loads.md).
  template <int dim>
  void
  choose_side_contact(Problem<dim> &problem)
  {
    std::vector<std::string> hit, one_sided; // names
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        Side<dim> &wall = problem.sides[side];
        wall.may_be_hit =
          may_be_hit(side, !problem.loads.faces.empty(), problem);
        if (wall.may_be_hit)
          hit.push_back(in_quotes(side_names(dim)[side]));
        if (wall.one_sided)
          one_sided.push_back(hit.back());
      }
    bool any = false;
    for (Body<dim> &body : problem.bodies)
      {
        const std::string reason = why_at_nodes(body, problem);
        body.meets_sides         = reason.empty();
        any                      = any || body.meets_sides;
        // In a tank the slip sides are meant for the liquid.
        const auto &names = who_flows(body, problem) ? one_sided : hit;
        if (!body.is_liquid && !reason.empty() && !names.empty())
          problem.notes.push_back(
            "Body " + in_quotes(body.name) + " feels " + join(names, ", ") +
            " at nodes, as " + reason +
            ": it may end up to a cell before the side, rebounds up to a "
            "quarter too fast, and is braked by a quarter if it rolls (8 cells "
            "over its radius).");
        if (body.meets_sides && !hit.empty())
          problem.notes.push_back("Body " + in_quotes(body.name) + " feels " +
                                  join(hit, ", ") +
                                  " where its material ends.");
      }
    for (Side<dim> &side : problem.sides)
      side.meets_surfaces = side.may_be_hit && any;
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



  template bool
  may_be_hit(unsigned int, bool, const Problem<2> &);
  template std::string
  why_at_nodes(const Body<2> &, const Problem<2> &);
  template void
  choose_side_contact(Problem<2> &);
  template bool
  may_be_hit(unsigned int, bool, const Problem<3> &);
  template std::string
  why_at_nodes(const Body<3> &, const Problem<3> &);
  template void
                    choose_side_contact(Problem<3> &);
  template Sides<2> sides_at_nodes(Sides<2>);
  template Sides<3> sides_at_nodes(Sides<3>);
  template Obstacle<2>
  half_space_beyond(unsigned int, const Problem<2> &);
  template Obstacle<3>
  half_space_beyond(unsigned int, const Problem<3> &);
} // namespace limber
