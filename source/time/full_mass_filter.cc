// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/full_mass_filter.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  FullMassFilter<dim>::FullMassFilter(const BackgroundGrid<dim>     &grid,
                                      const BoundaryConditions<dim> &boundaries)
    : communicator(grid.communicator)
    , table(grid.nodes())
    , boundaries(boundaries)
    , on_points(dim)
  {
    reinit();
  }



  template <int dim>
  void
  FullMassFilter<dim>::reinit()
  {
    records.reinit(std::size_t(table.n()) * Layout::stride);
    lumped.reinit(std::size_t(table.n()) * dim);
  }



  template <int dim>
  typename FullMassFilter<dim>::Impulses
  FullMassFilter<dim>::apply(NodalFields<dim>  &nodes,
                             Bodies            &bodies,
                             const unsigned int order,
                             const bool         former_only)
  {
    former = former_only;
    start(nodes);
    for (unsigned int j = 1; j < order; ++j)
      {
        multiply_by_full_mass(nodes, bodies);
        correct(nodes);
      }
    const Impulses result = impulses(nodes);
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const       own = nodes.record(node);
        const double *const v   = record(node) + Layout::velocity;
        if (!(own[Layout::mass] > 0))
          continue;
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          if (held[d] == 0)
            own[Layout::velocity + d] =
              v[d] + (former ? own[Layout::increment + d] : 0);
      }
    nodes.interpolate_hanging();
    return result;
  }



  // Where no side holds anything, the sum of m v stays what it is. What it
  // changes by is shared among the sides in proportion to the mass that they
  // hold. By difference: a fault of the filter would be booked along with it.
  template <int dim>
  typename FullMassFilter<dim>::Impulses
  FullMassFilter<dim>::impulses(const NodalFields<dim> &nodes)
  {
    dealii::Tensor<1, dim> change;
    Impulses               held_mass; // by side and component
    dealii::Tensor<1, dim> all_held;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double *const own = nodes.record(node);
        if (!nodes.owns(node) || !(own[Layout::mass] > 0))
          continue;
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          if (held[d] == 0)
            change[d] +=
              own[Layout::mass] * record(node)[Layout::velocity + d] -
              momentum(own, d);
          else
            for (unsigned int side = 0; side < 2 * dim; ++side)
              if ((table.sides[node] >> side & 1) && (held[d] >> side / 2 & 1))
                {
                  held_mass[side][d] += own[Layout::mass];
                  all_held[d] += own[Layout::mass];
                }
      }
    Impulses result;
    for (int d = 0; d < dim; ++d)
      {
        const double total =
          dealii::Utilities::MPI::sum(all_held[d], communicator);
        const double moved =
          dealii::Utilities::MPI::sum(change[d], communicator);
        for (unsigned int side = 0; side < 2 * dim; ++side)
          if (total > 0)
            result[side][d] = moved * held_mass[side][d] / total;
      }
    return result;
  }



  // v(1)
  template <int dim>
  void
  FullMassFilter<dim>::start(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double *const own = nodes.record(node);
        double *const       v   = record(node) + Layout::velocity;
        std::fill_n(record(node), Layout::stride, 0.);
        std::fill_n(lumped_mass(node), dim, own[Layout::mass]);
        const auto held = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          v[d] = own[Layout::velocity + d] -
                 (former && held[d] == 0 ? own[Layout::increment + d] : 0);
      }
    if (table.inward.empty())
      return;

    // D v(1) = p, plus what held nodes bring along
    const auto add = [&](const std::uint32_t to,
                         const int           d,
                         const double        mass,
                         const double        velocity) {
      double &D = lumped_mass(to)[d], &v = record(to)[Layout::velocity + d];
      v = (D * v + mass * velocity) / (D + mass);
      D += mass;
    };
    for (const std::uint32_t node : nodes.active_boundary_nodes())
      if (const double mass = nodes.record(node)[Layout::mass]; mass > 0)
        {
          const auto held = this->held(nodes, node);
          for (int d = 0; d < dim; ++d)
            if (held[d] != 0)
              add(table.inward.at(node)[held[d]],
                  d,
                  mass,
                  record(node)[Layout::velocity + d]);
        }
  }



  template <int dim>
  void
  FullMassFilter<dim>::correct(const NodalFields<dim> &nodes)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double *const own = nodes.record(node);
        if (!(own[Layout::mass] > 0))
          continue;
        double *const v       = record(node) + Layout::velocity;
        double *const product = record(node) + Layout::remapped;
        const auto    held    = this->held(nodes, node);
        for (int d = 0; d < dim; ++d)
          {
            if (held[d] == 0)
              v[d] += (momentum(own, d) - product[d]) / lumped_mass(node)[d];
            product[d] = 0;
          }
      }
  }



  // The sweep that updates the velocities of points takes and gives: here
  // velocities that are not theirs.
  template <int dim>
  void
  FullMassFilter<dim>::multiply_by_full_mass(NodalFields<dim> &nodes,
                                             Bodies           &bodies)
  {
    constexpr std::size_t room = 1 << dim; // that sweeps want beyond
    table.take_from_masters(records.data(),
                            Layout::stride,
                            Layout::velocity,
                            Layout::stride);
    GridView<dim> grid = nodes.view();
    grid.nodes         = records.data();
    TakeFromGrid take;
    take.flip_share = 0;
    take.remap      = true;
    for (auto &body : bodies)
      {
        PointView<dim> points = body->points.view();
        for (int d = 0; d < dim; ++d)
          {
            on_points[d].assign(points.size + room, 0.);
            points.velocity[d] = on_points[d].data();
          }
        grid_to_points<dim>(points, grid, take, nullptr);
      }
    table.give_to_masters(records.data(),
                          Layout::stride,
                          Layout::remapped,
                          Layout::remapped + dim);
    exchange.start(nodes.node_plan(),
                   records.data(),
                   Layout::remapped,
                   Layout::remapped + dim);
    exchange.finish(records.data());
  }



  template class FullMassFilter<2>;
  template class FullMassFilter<3>;
} // namespace limber
