// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/full_mass_filter.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>

namespace limber
{
  template <int dim>
  FullMassFilter<dim>::FullMassFilter(const BackgroundGrid<dim>     &grid,
                                      const BoundaryConditions<dim> &boundaries)
    : table(grid.nodes())
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
  }



  template <int dim>
  void
  FullMassFilter<dim>::apply(
    NodalFields<dim>                                &nodes,
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
    const unsigned int                               order,
    const bool                                       former_only)
  {
    for (const std::uint32_t node : nodes.active_nodes())
      {
        const double *const own  = nodes.record(node);
        double *const       term = record(node);
        std::fill_n(term, Layout::stride, 0.);
        for (int d = 0; d < dim; ++d)
          {
            term[Layout::velocity + d] = own[Layout::velocity + d];
            if (former_only)
              term[Layout::velocity + d] -= own[Layout::increment + d];
          }
      }
    for (unsigned int j = 1; j < order; ++j)
      {
        bring_to_points_and_back(nodes, bodies);
        for (const std::uint32_t node : nodes.active_nodes())
          {
            double *const own  = nodes.record(node);
            double *const term = record(node);
            if (!(own[Layout::mass] > 0))
              continue;
            for (int d = 0; d < dim; ++d)
              {
                term[Layout::velocity + d] -=
                  term[Layout::remapped + d] / own[Layout::mass];
                term[Layout::remapped + d] = 0;
              }
            if (table.sides[node])
              boundaries.hold(nodes, node, term + Layout::velocity);
            for (int d = 0; d < dim; ++d)
              own[Layout::velocity + d] += term[Layout::velocity + d];
          }
      }
    nodes.interpolate_hanging();
  }



  // The sweep that updates the velocities of points, on velocities that are
  // not theirs.
  template <int dim>
  void
  FullMassFilter<dim>::bring_to_points_and_back(
    NodalFields<dim>                                &nodes,
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies)
  {
    constexpr std::size_t room = 1 << dim; // that sweeps want beyond
    table.take_from_masters(
      records.data(), Layout::stride, Layout::velocity, Layout::stride);
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
