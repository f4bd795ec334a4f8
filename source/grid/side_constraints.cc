// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/side_constraints.h>

namespace limber
{
  template <int dim>
  SideConstraints<dim>::SideConstraints(const Sides<dim>        &sides,
                                        const CoveredSides<dim> *covered)
    : sides(sides)
    , covered(covered)
  {
    for (unsigned int set = 0; set < held.size(); ++set)
      held[set] = held_components(sides, set);
  }



  template <int dim>
  const std::vector<Constraint> &
  SideConstraints<dim>::at(const NodalFields<dim> &nodes, const double time)
  {
    if (version != nodes.version_of_active() ||
        (covered != nullptr && version_of_covered != covered->version()))
      rebuild(nodes);
    if (!has_values || time != time_of_values)
      evaluate(nodes, time);
    return list;
  }



  template <int dim>
  void
  SideConstraints<dim>::rebuild(const NodalFields<dim> &nodes)
  {
    list.clear();
    moving.clear();
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      for (const HeldComponent &entry : of_node(nodes, node))
        {
          if (!sides[entry.side].velocity.empty())
            moving.push_back(list.size());
          list.push_back({node,
                          static_cast<std::uint8_t>(entry.component),
                          static_cast<std::uint8_t>(entry.side),
                          entry.one_sided,
                          0});
        }
    version            = nodes.version_of_active();
    version_of_covered = covered != nullptr ? covered->version() : 0;
    has_values         = false;
  }



  template <int dim>
  const std::vector<HeldComponent> &
  SideConstraints<dim>::of_node(const NodalFields<dim> &nodes,
                                const std::uint32_t     node) const
  {
    const std::uint8_t set = nodes.table.sides[node];
    return of_sides(covered != nullptr && set != 0 ?
                      covered->uncovered(set, nodes.table.places.at(node)) :
                      set);
  }



  template <int dim>
  void
  SideConstraints<dim>::evaluate(const NodalFields<dim> &nodes,
                                 const double            time)
  {
    for (const std::size_t number : moving)
      {
        Constraint &constraint = list[number];
        constraint.value       = sides[constraint.side].prescribed_velocity(
          nodes.table.places.at(constraint.node), time, constraint.component);
      }
    time_of_values = time;
    has_values     = true;
  }



  template class SideConstraints<2>;
  template class SideConstraints<3>;
} // namespace limber
