// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/boundary_conditions.h>
#include <limber/grid/node_vector.h>
#include <limber/problem/side_contact.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** Sign of the outward normal of the side. */
    double
    outward(const unsigned int side)
    {
      return side % 2 == 1 ? 1. : -1.;
    }



    template <int dim>
    bool
    any_one_sided(const Sides<dim> &sides)
    {
      return std::any_of(sides.begin(), sides.end(), [](const auto &side) {
        return side.one_sided;
      });
    }
  } // namespace



  template <int dim>
  BoundaryConditions<dim>::BoundaryConditions(
    const Sides<dim>        &sides,
    const std::vector<bool> &by_surface,
    const CoveredSides<dim> *covered)
    : sides(sides)
    , others(sides_at_nodes<dim>(sides))
    , by_surface(by_surface)
    , constraints{{SideConstraints<dim>(this->sides, covered),
                   SideConstraints<dim>(this->others, covered)}}
    , one_sided(limber::any_one_sided<dim>(others) ||
                (limber::any_one_sided<dim>(sides) &&
                 (by_surface.empty() ||
                  std::find(by_surface.begin(), by_surface.end(), false) !=
                    by_surface.end())))
  {}



  // Calls work(node, first, last) for the constraints of each node with mass.
  template <int dim>
  template <class Work>
  void
  BoundaryConditions<dim>::for_each_node(const NodalFields<dim> &nodes,
                                         const double            time,
                                         const Work             &work)
  {
    const std::vector<Constraint> &all =
      constraints[of_field(nodes)].at(nodes, time);
    for (auto first = all.begin(), last = first; first != all.end();
         first = last)
      {
        while (last != all.end() && last->node == first->node)
          ++last;
        if (nodes.record(first->node)[NodeLayout<dim>::mass] > 0)
          work(first->node, first, last);
      }
  }



  // A one-sided constraint stops outward motion; Coulomb friction reduces the
  // tangential velocity by at most friction times the normal impulse.
  template <int dim>
  void
  BoundaryConditions<dim>::act(const Constraint &constraint,
                               Velocity         &velocity) const
  {
    const unsigned int normal = constraint.component;
    if (!constraint.one_sided)
      {
        velocity[normal] = constraint.value;
        return;
      }
    const double pressing = outward(constraint.side) * velocity[normal];
    if (pressing <= 0)
      return;
    velocity[normal]        = 0;
    const double tangential = velocity.norm();
    const double stopped    = sides[constraint.side].friction * pressing;
    if (tangential > 0)
      velocity *= 1 - std::min(1., stopped / tangential);
  }



  // A node stopped by the side has zero new normal velocity; a sticking one has
  // zero velocity.
  template <int dim>
  void
  BoundaryConditions<dim>::act_trial(const Constraint &constraint,
                                     const Trial       kind,
                                     const Velocity   &new_velocity,
                                     Velocity         &velocity) const
  {
    const unsigned int normal = constraint.component;
    if (!constraint.one_sided)
      velocity[normal] = constraint.value;
    else if (new_velocity[normal] == 0)
      {
        velocity[normal] = 0;
        if (new_velocity.norm_square() == 0)
          velocity = 0;
      }
    else if (kind == Trial::motion &&
             outward(constraint.side) * velocity[normal] > 0)
      velocity[normal] = 0;
  }



  // Energy balance. An impulse does work with the velocity of the side (none at
  // rest). The velocity of points against it is lost, as in an impact. For
  // points that are kept (keeps_points), the stress works with the mean
  // velocity of the step, and so does the side; if it accelerates, its points
  // start from a velocity of their own. Friction dissipates with the mean
  // velocity if the node slides; if it sticks, its motion is lost, as in an
  // impact. If several sides hold a component, the loss is attributed to the
  // last one.
  template <int dim>
  typename BoundaryConditions<dim>::Action
  BoundaryConditions<dim>::action(const unsigned int side,
                                  const Velocity    &change,
                                  const Velocity    &former_change,
                                  const Velocity    &velocity,
                                  const Velocity    &increment,
                                  const LastSides   &last_sides,
                                  const double       mass,
                                  const double       flip_share) const
  {
    Action result;
    result.impulse = mass * (change - flip_share * former_change);
    for (int d = 0; d < dim; ++d)
      {
        const bool is_friction =
          sides[side].one_sided && d != static_cast<int>(side / 2);
        if (former_change[d] != 0)
          result.work += mass * ((change[d] - former_change[d]) *
                                   (velocity[d] - 0.5 * increment[d]) -
                                 former_change[d] * increment[d]);
        else if (is_friction && velocity[d] != 0)
          result.friction -=
            mass * change[d] * (velocity[d] - 0.5 * increment[d]);
        else if (change[d] != 0)
          {
            result.work += mass * change[d] * velocity[d];
            if (last_sides[d] == side)
              result.loss += 0.5 * mass * increment[d] * increment[d];
          }
        result.transfer_work +=
          mass * (1 - flip_share) * former_change[d] * velocity[d];
      }
    return result;
  }



  // Record the tangential impulse in components that still slide.
  template <int dim>
  void
  BoundaryConditions<dim>::note_rubbing(const unsigned int  side,
                                        const std::uint32_t node,
                                        const double *const record,
                                        Velocity            impulse,
                                        const Velocity     &velocity)
  {
    impulse[side / 2] = 0;
    for (int d = 0; d < dim; ++d)
      if (velocity[d] == 0)
        impulse[d] = 0;
    if (impulse != Velocity())
      rubbing.push_back({node, record, impulse});
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply(NodalFields<dim> &nodes,
                                 const Step       &step,
                                 const Account    &account)
  {
    using Layout = NodeLayout<dim>;
    std::vector<double> former_values;
    if (step.keeps_points)
      for (const Constraint &constraint :
           constraints[of_field(nodes)].at(nodes, step.begin))
        former_values.push_back(constraint.value);
    const Constraint *const list =
      constraints[of_field(nodes)].at(nodes, step.end).data();
    rubbing.erase(std::remove_if(rubbing.begin(),
                                 rubbing.end(),
                                 [&](const Rubbing &entry) {
                                   return entry.record ==
                                          nodes.record(entry.node);
                                 }),
                  rubbing.end());

    for_each_node(
      nodes,
      step.end,
      [&](const std::uint32_t node, const auto first, const auto last) {
        double *const  record = nodes.record(node);
        const double   mass   = record[Layout::mass];
        const Velocity free_velocity =
          vector_in<dim>(record + Layout::velocity);
        const Velocity brought =
          free_velocity - vector_in<dim>(record + Layout::increment);
        Velocity                      velocity = free_velocity;
        Velocity                      former   = brought;
        std::array<Velocity, 2 * dim> change, former_change;
        LastSides                     last_sides{};
        for (auto c = first; c != last; ++c)
          {
            const Velocity before = velocity;
            act(*c, velocity);
            change[c->side] += velocity - before;
            for (int d = 0; d < dim; ++d)
              if (velocity[d] != before[d])
                last_sides[d] = c->side;
            if (step.keeps_points && !c->one_sided)
              {
                const double value = former_values[&*c - list];
                former_change[c->side][c->component] +=
                  value - former[c->component];
                former[c->component] = value;
              }
          }

        const Velocity increment = velocity - former;
        for (unsigned int side = 0; side < 2 * dim; ++side)
          {
            if (!nodes.owns(node) || (change[side] == Velocity() &&
                                      former_change[side] == Velocity()))
              continue;
            account(side,
                    action(side,
                           change[side],
                           former_change[side],
                           velocity,
                           increment,
                           last_sides,
                           mass,
                           step.flip_share));
            if (sides[side].friction > 0)
              note_rubbing(side, node, record, mass * change[side], velocity);
          }
        for (int d = 0; d < dim; ++d)
          {
            record[Layout::increment + d] = increment[d];
            record[Layout::velocity + d]  = velocity[d];
          }
      });
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply_trial(NodalFields<dim>  &nodes,
                                       const unsigned int slot,
                                       const double       time,
                                       const Trial        kind,
                                       const double       step)
  {
    using Layout = NodeLayout<dim>;
    for_each_node(
      nodes,
      time,
      [&](const std::uint32_t node, const auto first, const auto last) {
        double *const record       = nodes.record(node);
        Velocity      new_velocity = vector_in<dim>(record + Layout::velocity);
        if (kind == Trial::strain_before)
          {
            new_velocity = (vector_in<dim>(record + Layout::momentum) +
                            step * vector_in<dim>(record + Layout::force)) /
                           record[Layout::mass];
            for (auto c = first; c != last; ++c)
              act(*c, new_velocity);
          }
        Velocity velocity = vector_in<dim>(record + slot);
        for (auto c = first; c != last; ++c)
          act_trial(*c, kind, new_velocity, velocity);
        for (int d = 0; d < dim; ++d)
          record[slot + d] = velocity[d];
      });
  }



  // FLIP points gain (J + dt f) (v- + v*) / 2 at a node that got v- from them
  // and maps v* back; strained with the velocity w of the side they lose dt f
  // w. With J + dt f = m dv and v- = w - dv the side has done J w - m dv^2 / 2,
  // which is accounted for, and m dv (v* - w) / 2, which is added here. For
  // sliding nodes v* replaces the new velocity, which may be that of a node of
  // tiny mass that no point takes over.
  template <int dim>
  typename BoundaryConditions<dim>::Action
  BoundaryConditions<dim>::action_on_remapped(const NodalFields<dim> &nodes,
                                              const unsigned int slot) const
  {
    using Layout = NodeLayout<dim>;
    Action result;
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      {
        const double *const record = nodes.record(node);
        if (!nodes.owns(node) || !(record[Layout::mass] > 0))
          continue;
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          if (held[d] != 0)
            result.loss -= 0.5 * record[Layout::mass] *
                           record[Layout::increment + d] *
                           (record[slot + d] - record[Layout::velocity + d]);
      }
    for (const Rubbing &entry : rubbing)
      if (entry.record == nodes.record(entry.node))
        result.friction -= 0.5 * entry.impulse *
                           (vector_in<dim>(entry.record + slot) -
                            vector_in<dim>(entry.record + Layout::velocity));
    return result;
  }



  template <int dim>
  void
  BoundaryConditions<dim>::for_each_held(const NodalFields<dim> &nodes,
                                         const double            time,
                                         const Hold             &hold)
  {
    for_each_node(
      nodes,
      time,
      [&](const std::uint32_t node, const auto first, const auto last) {
        for (auto c = first; c != last; ++c)
          {
            const double velocity =
              nodes.record(node)[NodeLayout<dim>::velocity + c->component];
            if (!c->one_sided || outward(c->side) * velocity >= 0)
              hold(node, c->component, c->value);
          }
      });
  }



  template <int dim>
  void
  BoundaryConditions<dim>::for_each_constrained(const NodalFields<dim> &nodes,
                                                const double            time,
                                                const Visit            &visit)
  {
    for_each_node(nodes,
                  time,
                  [&](const std::uint32_t node,
                      const auto          first,
                      const auto          last) {
                    visit(node, &*first, &*first + (last - first));
                  });
  }



  template <int dim>
  dealii::Tensor<1, dim>
  BoundaryConditions<dim>::constrained(const Constraint *const first,
                                       const Constraint *const last,
                                       dealii::Tensor<1, dim>  velocity) const
  {
    for (const Constraint *c = first; c != last; ++c)
      act(*c, velocity);
    return velocity;
  }



  template <int dim>
  std::array<unsigned int, dim>
  BoundaryConditions<dim>::held(const NodalFields<dim> &nodes,
                                const std::uint32_t     node) const
  {
    const Velocity velocity =
      vector_in<dim>(nodes.record(node) + NodeLayout<dim>::velocity);
    std::array<unsigned int, dim> result{};
    for (const HeldComponent &entry :
         constraints[of_field(nodes)].of_node(nodes, node))
      {
        const unsigned int direction = 1 << entry.side / 2;
        if (!entry.one_sided || velocity[entry.component] == 0)
          result[entry.component] |= direction;
        if (entry.one_sided && velocity.norm_square() == 0)
          for (unsigned int &component : result)
            component |= direction;
      }
    return result;
  }



  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace limber
