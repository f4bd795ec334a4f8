// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/boundary_conditions.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    template <int dim>
    dealii::Tensor<1, dim>
    read(const double *const values)
    {
      dealii::Tensor<1, dim> result;
      for (int d = 0; d < dim; ++d)
        result[d] = values[d];
      return result;
    }
  } // namespace



  template <int dim>
  BoundaryConditions<dim>::BoundaryConditions(const Sides<dim> &sides)
    : sides(sides)
    , constraints(sides)
  {}



  // work(node, first, last) on the constraints of each node that has mass.
  template <int dim>
  template <class Work>
  void
  BoundaryConditions<dim>::for_each_node(const NodalFields<dim> &nodes,
                                         const double            time,
                                         const Work             &work)
  {
    const std::vector<Constraint> &all = constraints.at(nodes, time);
    for (auto first = all.begin(), last = first; first != all.end();
         first = last)
      {
        while (last != all.end() && last->node == first->node)
          ++last;
        if (nodes.record(first->node)[NodeLayout<dim>::mass] > 0)
          work(first->node, first, last);
      }
  }



  template <int dim>
  void
  BoundaryConditions<dim>::act(const Constraint     &constraint,
                               Velocity             &velocity,
                               const Velocity *const new_velocity) const
  {
    if (constraint.one_sided)
      act_one_sided(constraint, velocity, new_velocity);
    else
      velocity[constraint.component] = constraint.value;
  }



  template <int dim>
  void
  BoundaryConditions<dim>::act_one_sided(
    const Constraint     &constraint,
    Velocity             &velocity,
    const Velocity *const new_velocity) const
  {
    const unsigned int normal   = constraint.component;
    const double       outward  = constraint.side % 2 == 1 ? 1. : -1.;
    const double       pressing = outward * velocity[normal];
    if (pressing <= 0)
      return;
    velocity[normal]        = 0;
    const double tangential = velocity.norm();
    double       stopped    = sides[constraint.side].friction * pressing;
    if (new_velocity != nullptr)
      {
        auto sliding    = *new_velocity;
        sliding[normal] = 0;
        stopped         = sliding.norm_square() == 0 ? tangential : 0;
      }
    if (tangential > 0)
      velocity *= 1 - std::min(1., stopped / tangential);
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply(NodalFields<dim> &nodes,
                                 const double      time,
                                 const Account    &account)
  {
    using Layout = NodeLayout<dim>;
    for_each_node(
      nodes,
      time,
      [&](const std::uint32_t node, const auto first, const auto last) {
        double *const  record        = nodes.record(node);
        const double   mass          = record[Layout::mass];
        const Velocity free_velocity = read<dim>(record + Layout::velocity);
        const Velocity old_velocity =
          free_velocity - read<dim>(record + Layout::increment);
        Velocity                      velocity = free_velocity;
        std::array<Velocity, 2 * dim> change;
        for (auto c = first; c != last; ++c)
          {
            const Velocity before = velocity;
            act(*c, velocity, nullptr);
            change[c->side] += velocity - before;
          }

        // An impulse does work with the velocity that the side leaves. Where
        // the stress bears against the side, it does no work; what the points
        // bring to the node against the side is lost, as in an impact.
        const Velocity step_change = velocity - old_velocity;
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (nodes.owns(node) && change[side] != Velocity())
            {
              double work = change[side] * velocity;
              for (int d = 0; d < dim; ++d)
                if (change[side][d] != 0)
                  work -= 0.5 * step_change[d] * step_change[d];
              account(side, mass * change[side], mass * work);
            }
        for (int d = 0; d < dim; ++d)
          {
            record[Layout::increment + d] += velocity[d] - free_velocity[d];
            record[Layout::velocity + d] = velocity[d];
          }
      });
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply_trial(NodalFields<dim>  &nodes,
                                       const unsigned int slot,
                                       const double       time)
  {
    for_each_node(nodes,
                  time,
                  [&](const std::uint32_t node,
                      const auto          first,
                      const auto          last) {
                    double *const  record = nodes.record(node);
                    const Velocity new_velocity =
                      read<dim>(record + NodeLayout<dim>::velocity);
                    Velocity velocity = read<dim>(record + slot);
                    for (auto c = first; c != last; ++c)
                      act(*c, velocity, &new_velocity);
                    for (int d = 0; d < dim; ++d)
                      record[slot + d] = velocity[d];
                  });
  }



  template <int dim>
  std::array<unsigned int, dim>
  BoundaryConditions<dim>::held(const NodalFields<dim> &nodes,
                                const std::uint32_t     node) const
  {
    const Velocity velocity =
      read<dim>(nodes.record(node) + NodeLayout<dim>::velocity);
    std::array<unsigned int, dim> result{};
    for (const HeldComponent &entry :
         constraints.of_sides(nodes.table.sides[node]))
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
