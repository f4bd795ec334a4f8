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



  // An impulse does work with the velocity that the side leaves. Where the
  // stress bears against the side, it does no work; what it takes from what the
  // points bring is lost. With points that it keeps, the stress works with the
  // mean velocity of the step, and so does the side; where it accelerates, its
  // points do so from a velocity of their own.
  template <int dim>
  typename BoundaryConditions<dim>::Action
  BoundaryConditions<dim>::action(const Velocity &change,
                                  const Velocity &former_change,
                                  const Velocity &velocity,
                                  const Velocity &increment,
                                  const double    mass,
                                  const double    flip_share)
  {
    Action result;
    result.impulse = mass * (change - flip_share * former_change);
    for (int d = 0; d < dim; ++d)
      {
        if (former_change[d] != 0)
          result.work += mass * ((change[d] - former_change[d]) *
                                   (velocity[d] - 0.5 * increment[d]) -
                                 former_change[d] * increment[d]);
        else if (change[d] != 0)
          result.work += mass * (change[d] * velocity[d] -
                                 0.5 * increment[d] * increment[d]);
        result.transfer_work +=
          mass * (1 - flip_share) * former_change[d] * velocity[d];
      }
    return result;
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
      for (const Constraint &constraint : constraints.at(nodes, step.begin))
        former_values.push_back(constraint.value);
    const Constraint *const list = constraints.at(nodes, step.end).data();

    for_each_node(
      nodes,
      step.end,
      [&](const std::uint32_t node, const auto first, const auto last) {
        double *const  record        = nodes.record(node);
        const double   mass          = record[Layout::mass];
        const Velocity free_velocity = read<dim>(record + Layout::velocity);
        const Velocity brought =
          free_velocity - read<dim>(record + Layout::increment);
        Velocity                      velocity = free_velocity;
        Velocity                      former   = brought;
        std::array<Velocity, 2 * dim> change, former_change;
        for (auto c = first; c != last; ++c)
          {
            const Velocity before = velocity;
            act(*c, velocity, nullptr);
            change[c->side] += velocity - before;
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
          if (nodes.owns(node) &&
              (change[side] != Velocity() || former_change[side] != Velocity()))
            account(side,
                    action(change[side],
                           former_change[side],
                           velocity,
                           increment,
                           mass,
                           step.flip_share));
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
            const double outward = c->side % 2 == 1 ? 1. : -1.;
            const double velocity =
              nodes.record(node)[NodeLayout<dim>::velocity + c->component];
            if (!c->one_sided || outward * velocity >= 0)
              hold(node, c->component, c->value);
          }
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
