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
  BoundaryConditions<dim>::BoundaryConditions(
    const std::array<Side<dim>, 2 * dim> &sides)
    : sides(sides)
  {}



  template <int dim>
  bool
  BoundaryConditions<dim>::act(
    const unsigned int                  side,
    const NodeTable<dim>               &nodes,
    const std::uint32_t                 node,
    const double                        time,
    dealii::Tensor<1, dim>             &velocity,
    const dealii::Tensor<1, dim> *const new_velocity) const
  {
    const unsigned int normal  = side / 2;
    const double       outward = side % 2 == 1 ? 1. : -1.;

    switch (sides[side].condition)
      {
        case SideCondition::free:
          return false;
        case SideCondition::slip:
          velocity[normal] = 0;
          return true;
        case SideCondition::no_slip:
          velocity = 0;
          return true;
        case SideCondition::velocity:
          velocity = sides[side].velocity.vector(nodes.places.at(node), time);
          return true;
        case SideCondition::friction:
          {
            const double pressing = outward * velocity[normal];
            if (pressing <= 0)
              return false;
            velocity[normal]        = 0;
            const double tangential = velocity.norm();
            double       stopped    = sides[side].friction * pressing;
            if (new_velocity != nullptr)
              {
                auto sliding    = *new_velocity;
                sliding[normal] = 0;
                stopped         = sliding.norm_square() == 0 ? tangential : 0;
              }
            if (tangential > 0)
              velocity *= 1 - std::min(1., stopped / tangential);
            return true;
          }
      }
    return false;
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply(NodalFields<dim> &nodes,
                                 const double      time,
                                 const Account    &account) const
  {
    using Layout = NodeLayout<dim>;
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      {
        double *const record = nodes.record(node);
        const double  mass   = record[Layout::mass];
        if (!(mass > 0))
          continue;

        const auto free_velocity = read<dim>(record + Layout::velocity);
        const auto old_velocity =
          free_velocity - read<dim>(record + Layout::increment);
        auto                                        velocity = free_velocity;
        std::array<dealii::Tensor<1, dim>, 2 * dim> change;
        for (unsigned int side = 0; side < 2 * dim; ++side)
          {
            const auto before = velocity;
            if (nodes.table.sides[node] >> side & 1)
              act(side, nodes.table, node, time, velocity, nullptr);
            change[side] = velocity - before;
          }

        // An impulse does work with the velocity that the side leaves. Where
        // the stress bears against the side, it does no work; what the points
        // bring to the node against the side is lost, as in an impact.
        const auto step_change = velocity - old_velocity;
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (nodes.owns(node) && change[side] != dealii::Tensor<1, dim>())
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
      }
  }



  template <int dim>
  void
  BoundaryConditions<dim>::apply_trial(NodalFields<dim>  &nodes,
                                       const unsigned int first,
                                       const double       time) const
  {
    using Layout = NodeLayout<dim>;
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      {
        double *const record = nodes.record(node);
        if (!(record[Layout::mass] > 0))
          continue;
        const auto new_velocity = read<dim>(record + Layout::velocity);
        auto       velocity     = read<dim>(record + first);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (nodes.table.sides[node] >> side & 1)
            act(side, nodes.table, node, time, velocity, &new_velocity);
        for (int d = 0; d < dim; ++d)
          record[first + d] = velocity[d];
      }
  }



  template <int dim>
  std::array<unsigned int, dim>
  BoundaryConditions<dim>::held(const NodalFields<dim> &nodes,
                                const std::uint32_t     node) const
  {
    const auto velocity =
      read<dim>(nodes.record(node) + NodeLayout<dim>::velocity);
    std::array<unsigned int, dim> result{};
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        if (!(nodes.table.sides[node] >> side & 1))
          continue;
        const unsigned int  normal    = side / 2;
        const SideCondition condition = sides[side].condition;
        const bool          rubs =
          condition == SideCondition::friction && velocity[normal] == 0;
        const bool holds_all = condition == SideCondition::no_slip ||
                               condition == SideCondition::velocity ||
                               (rubs && velocity.norm_square() == 0);
        if (holds_all || rubs || condition == SideCondition::slip)
          result[normal] |= 1 << normal;
        if (holds_all)
          for (unsigned int &component : result)
            component |= 1 << normal;
      }
    return result;
  }



  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace limber
