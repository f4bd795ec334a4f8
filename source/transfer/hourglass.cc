// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/linear.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/hourglass.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** chi c m / h of a cell, summed over the bodies, kg/s. */
    template <int dim>
    double
    resistance(const CellGeometry<dim>                     &cell,
               const std::uint32_t                          number,
               const std::vector<HourglassResistance<dim>> &bodies)
    {
      const double inverse_edge =
        *std::max_element(cell.inverse_edge.begin(), cell.inverse_edge.end());
      double result = 0;
      for (const auto &body : bodies)
        result += body.speed * inverse_edge * body.sums.present_mass(number);
      return result;
    }
  } // namespace



  template <int dim>
  void
  resist_hourglass(const std::vector<std::uint32_t>            &cells,
                   const GridView<dim>                         &grid,
                   const std::vector<HourglassResistance<dim>> &bodies,
                   const double                                 step)
  {
    using Kernel          = Linear<dim>;
    using Nodes           = typename Kernel::Nodes;
    using Layout          = NodeLayout<dim>;
    constexpr int n_nodes = Kernel::n_nodes;
    // shared by all cells around a node
    const double largest_share = 2. / n_nodes / step;

    for (const std::uint32_t number : cells)
      {
        const CellGeometry<dim> &cell = grid.cells[number];

        const auto of_nodes = [&](const unsigned int slot) {
          Nodes values{};
#pragma GCC unroll 8
          for (int a = 0; a < n_nodes; ++a)
            values[a] = grid.nodes[cell.node[a] + slot];
          return values;
        };
        const Nodes  mass = of_nodes(Layout::mass);
        const double k    = std::min(resistance(cell, number, bodies),
                                  largest_share * minimum(mass));
        // Nothing to resist, or all points on a side: a node has no velocity.
        if (!(k > 0))
          continue;
        const Nodes inverse_mass = 1. / mass;

        std::array<Nodes, dim> force;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            // From the nodes to the modes, products of the signs of the nodes
            // in some directions, and back from those of two or more.
            Nodes velocity = of_nodes(Layout::momentum + d) * inverse_mass;
            for (int e = 0; e < dim; ++e)
              velocity -= Kernel::sign(e) * Kernel::across(velocity, e);
            velocity *= Kernel::bilinear();
            for (int e = 0; e < dim; ++e)
              velocity += Kernel::sign(e) * Kernel::across(velocity, e);
            force[d] = -k / n_nodes * velocity;
          }
        add_to_nodes<dim, Layout::hourglass_force>(cell, force, grid.nodes);
      }
  }



  template void
  resist_hourglass(const std::vector<std::uint32_t> &,
                   const GridView<2> &,
                   const std::vector<HourglassResistance<2>> &,
                   double);
  template void
  resist_hourglass(const std::vector<std::uint32_t> &,
                   const GridView<3> &,
                   const std::vector<HourglassResistance<3>> &,
                   double);
} // namespace limber
