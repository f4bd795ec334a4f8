// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/stabilization.h>
#include <limber/transfer/checkerboard.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber
{
  // Wave speed of the hourglass viscosity. Waves in a liquid with an implicit
  // pressure may cross many cells in a step, but no more than the motion that
  // is there can be taken away.
  template <int dim>
  double
  Stabilization<dim>::speed_of_resistance(const MaterialBody<dim> &body,
                                          const double             step) const
  {
    constexpr double most_cells = 5; // in a step
    const auto       response   = body.stress->volumetric_response(1);
    return std::min(std::sqrt(response.stiffness / body.stress->density()),
                    most_cells * parts.grid.smallest_edge / step);
  }



  template <int dim>
  Stabilization<dim>::Stabilization(const RunParts<dim> &parts)
    : parts(parts)
  {}



  template <int dim>
  void
  Stabilization<dim>::control_checkerboards(const double step,
                                            const double wave_speed)
  {
    NodalFields<dim> &vertices = parts.nodes.vertices();
    for (auto &body : parts.bodies)
      {
        const double strength = body->description.checkerboard_control;
        if (!(strength > 0) || body->implicit)
          continue;
        if (vertices.n_fields() > 1)
          vertices.select(body->description.nodal_field);
        gather_checkerboards<dim>(vertices.owned_occupied_cells(),
                                  vertices.view(),
                                  body->cell_sums->view());
        // A hanging node does not have all cells around it.
        for (const HangingNode &hanging : parts.grid.vertices.hanging)
          std::fill_n(vertices.record(hanging.node),
                      NodeLayout<dim>::stride,
                      0.);
        vertices.start_sum(0, n_checkerboard_slots<dim>);
        vertices.finish_sum();
        // Masters at a change of size have cells of several sizes around: no
        // control there either.
        for (const std::uint32_t master : parts.grid.vertices.masters)
          std::fill_n(vertices.record(master), NodeLayout<dim>::stride, 0.);
        for (const auto *const cells : {&vertices.owned_occupied_cells(),
                                        &vertices.ghost_occupied_cells()})
          find_checkerboard_shifts<dim>(*cells,
                                        vertices.view(),
                                        body->cell_sums->view(),
                                        strength * wave_speed * step,
                                        body->cell_shift.data());
        // Clear the records again, also those of nodes that the field has
        // reached since its nodes were noted
        for (const std::uint32_t node : vertices.active_nodes())
          std::fill_n(vertices.record(node), NodeLayout<dim>::stride, 0.);
      }
  }



  template <int dim>
  void
  Stabilization<dim>::resist_hourglass(const double step,
                                       const double wave_speed)
  {
    parts.nodes.for_each_field([&]() {
      resisting.clear();
      for (auto &body : parts.bodies)
        if (body->description.hourglass_control > 0 &&
            body->description.nodal_field == parts.nodes.selected_field())
          resisting.push_back(
            {body->cell_sums->view(),
             body->description.hourglass_control *
               (body->implicit ? speed_of_resistance(*body, step) :
                                 wave_speed)});
      if (!resisting.empty())
        resist_hourglass_of_field(step);
    });
  }



  // Bodies in contact, which have nodal fields of their own, do not resist each
  // other's motion.
  template <int dim>
  void
  Stabilization<dim>::resist_hourglass_of_field(const double step)
  {
    using Layout            = NodeLayout<dim>;
    NodalFields<dim> &nodes = parts.nodes;

    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(nodes.record(node) + Layout::hourglass_force, dim, 0.);
    lend_to_hanging_nodes();
    find_hourglass_modes(step);
    add_hourglass_forces<dim>(nodes.owned_occupied_cells(),
                              nodes.view(),
                              hourglass_modes,
                              hourglass_sums.data());
    for (const HangingNode &hanging : nodes.table.hanging)
      {
        nodes.record(hanging.node)[Layout::mass] = 0;
        std::fill_n(nodes.record(hanging.node) + Layout::momentum, dim, 0.);
      }
    nodes.start_sum(Layout::hourglass_force, Layout::hourglass_force + dim);
    nodes.finish_sum();
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const record = nodes.record(node);
        const double  mass   = record[Layout::mass];
        if (!(mass > 0))
          continue;
        for (int d = 0; d < dim; ++d)
          {
            const double force =
              std::exchange(record[Layout::hourglass_force + d], 0);
            // heat, with the velocity at the start of the step
            if (nodes.owns(node))
              parts.ledger.viscous -=
                step * force * record[Layout::momentum + d] / mass;
            record[Layout::force + d] += force;
          }
      }
  }



  // Hourglass amplitudes of the cells and their means around nodes. A
  // hanging node has none: motion there is not smooth, as it follows its
  // masters along straight lines.
  template <int dim>
  void
  Stabilization<dim>::find_hourglass_modes(const double step)
  {
    NodalFields<dim> &nodes = parts.nodes;
    const std::size_t size =
      std::size_t(nodes.table.n()) * NodeLayout<dim>::stride;
    if (hourglass_sums.size() != size)
      hourglass_sums.reinit(size);
    const auto of_node = [&](const std::uint32_t node) {
      return hourglass_sums.data() +
             std::size_t(node) * NodeLayout<dim>::stride;
    };
    constexpr unsigned int n = HourglassLayout<dim>::n;

    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(of_node(node), n, 0.);
    limber::find_hourglass_modes<dim>(nodes.owned_occupied_cells(),
                                      nodes.view(),
                                      resisting,
                                      step,
                                      hourglass_modes,
                                      hourglass_sums.data());
    for (const HangingNode &hanging : nodes.table.hanging)
      std::fill_n(of_node(hanging.node), n, 0.);
    hourglass_exchange.start(nodes.node_plan(), hourglass_sums.data(), 0, n);
    hourglass_exchange.finish(hourglass_sums.data());
    for (const std::uint32_t node : nodes.active_nodes())
      if (double *const sums = of_node(node);
          sums[HourglassLayout<dim>::weight] > 0)
        {
          const double inverse = 1 / sums[HourglassLayout<dim>::weight];
          for (unsigned int k = HourglassLayout<dim>::mode; k < n; ++k)
            sums[k] *= inverse;
        }
  }



  // Give hanging nodes velocity and mass of their masters. The mass only limits
  // the resistance; around a master the cells of a change of size have more
  // corners that hang on it than those of a lattice have in it, up to five
  // quarters in 2d and 20 instead of 8 in 3d, most of them by hanging nodes.
  template <int dim>
  void
  Stabilization<dim>::lend_to_hanging_nodes()
  {
    using Layout           = NodeLayout<dim>;
    constexpr double share = 1. / (1 << (dim - 1));
    for (const HangingNode &hanging : parts.nodes.table.hanging)
      {
        double                 mass = 1e300;
        dealii::Tensor<1, dim> velocity;
        for (const auto &[master, weight] : hanging.masters)
          {
            const double *const from = parts.nodes.record(master);
            mass = std::min(mass, share * from[Layout::mass]);
            for (int d = 0; d < dim; ++d)
              velocity[d] += weight * from[Layout::momentum + d] /
                             std::max(from[Layout::mass], 1e-300);
          }
        // Whether it is active or not, its masters have given to it.
        double *const to = parts.nodes.record(hanging.node);
        std::fill_n(to + Layout::hourglass_force, dim, 0.);
        to[Layout::mass] = mass;
        for (int d = 0; d < dim; ++d)
          to[Layout::momentum + d] = mass * velocity[d];
      }
  }



  template class Stabilization<2>;
  template class Stabilization<3>;
} // namespace limber
