// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/linear.h>
#include <limber/transfer/add_to_nodes.h>
#include <limber/transfer/hourglass.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** k = chi c m / h of a cell, summed over the bodies, kg/s. */
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



    /** The sets of directions of the hourglass modes, as bits: pairs first. */
    template <int dim>
    constexpr std::array<int, HourglassModes<dim>::n_modes>
    directions_of_modes()
    {
      if constexpr (dim == 2)
        return {3};
      else
        return {3, 5, 6, 7};
    }
  } // namespace



  template <int dim>
  void
  find_hourglass_modes(const std::vector<std::uint32_t>            &cells,
                       const GridView<dim>                         &grid,
                       const std::vector<HourglassResistance<dim>> &bodies,
                       const double                                 step,
                       std::vector<HourglassModes<dim>>            &modes,
                       double *const                                sums)
  {
    using Kernel          = Linear<dim>;
    using Nodes           = typename Kernel::Nodes;
    using Layout          = NodeLayout<dim>;
    using Modes           = HourglassModes<dim>;
    constexpr int n_nodes = Kernel::n_nodes;
    // A nodal mass is shared by all cells around it
    const double   largest_share = 2. / n_nodes / step;
    constexpr auto directions    = directions_of_modes<dim>();

    modes.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      {
        const std::uint32_t      number  = cells[i];
        const CellGeometry<dim> &cell    = grid.cells[number];
        Modes                   &of_cell = modes[i];

        const auto of_nodes = [&](const unsigned int slot) {
          Nodes values{};
#pragma GCC unroll 8
          for (int a = 0; a < n_nodes; ++a)
            values[a] = grid.nodes[cell.node[a] + slot];
          return values;
        };
        const Nodes mass   = of_nodes(Layout::mass);
        of_cell.resistance = std::min(resistance(cell, number, bodies),
                                      largest_share * minimum(mass));
        // No resistance, or a node without mass, as all points lie on a side.
        if (!(of_cell.resistance > 0))
          continue;
        const Nodes inverse_mass = 1. / mass;
        // Cells of different sizes are similar, so one area serves all pairs.
        const double inverse_area = cell.inverse_edge[0] * cell.inverse_edge[1];
        of_cell.area              = 1 / inverse_area;

        std::array<double, HourglassLayout<dim>::n> given;
        const double weight = of_cell.resistance * of_cell.area * of_cell.area;
        given[HourglassLayout<dim>::weight] = weight;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            // Nodal values to modes, products of their signs (Hadamard
            // transform)
            Nodes velocity = of_nodes(Layout::momentum + d) * inverse_mass;
            for (int e = 0; e < dim; ++e)
              velocity -= Kernel::sign(e) * Kernel::across(velocity, e);
            for (unsigned int k = 0; k < Modes::n_modes; ++k)
              of_cell.amplitude[d][k] = velocity[directions[k]] / n_nodes;
            for (unsigned int k = 0; k < Modes::n_pairs; ++k)
              given[HourglassLayout<dim>::mode + d * Modes::n_pairs + k] =
                weight * inverse_area * of_cell.amplitude[d][k];
          }
        for (int a = 0; a < n_nodes; ++a)
          {
            double *const to = sums + cell.node[a];
            for (unsigned int k = 0; k < HourglassLayout<dim>::n; ++k)
              to[k] += given[k];
          }
      }
  }



  template <int dim>
  void
  add_hourglass_forces(const std::vector<std::uint32_t>       &cells,
                       const GridView<dim>                    &grid,
                       const std::vector<HourglassModes<dim>> &modes,
                       const double *const                     means)
  {
    using Kernel              = Linear<dim>;
    using Nodes               = typename Kernel::Nodes;
    using Layout              = NodeLayout<dim>;
    using Modes               = HourglassModes<dim>;
    constexpr int  n_nodes    = Kernel::n_nodes;
    constexpr auto directions = directions_of_modes<dim>();

    for (std::size_t i = 0; i < cells.size(); ++i)
      {
        const Modes &of_cell = modes[i];
        if (!(of_cell.resistance > 0))
          continue;
        const CellGeometry<dim> &cell = grid.cells[cells[i]];
        const double own = of_cell.resistance * of_cell.area * of_cell.area;

        std::array<double, HourglassLayout<dim>::n> mean{};
        int                                         n_around = 0;
        bool                                        is_alone = true;
        for (int a = 0; a < n_nodes; ++a)
          {
            const double *const of_node = means + cell.node[a];
            if (!(of_node[HourglassLayout<dim>::weight] > 0))
              continue;
            ++n_around;
            is_alone &= !(of_node[HourglassLayout<dim>::weight] > own);
            for (unsigned int k = HourglassLayout<dim>::mode;
                 k < HourglassLayout<dim>::n;
                 ++k)
              mean[k] += of_node[k];
          }
        const double share = is_alone ? 1 : double(n_around) / n_nodes;
        const double area  = is_alone ? 0 : of_cell.area / n_nodes;

        std::array<Nodes, dim> force;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            Nodes resisted{};
            for (unsigned int k = 0; k < Modes::n_pairs; ++k)
              resisted[directions[k]] =
                share * of_cell.amplitude[d][k] -
                area *
                  mean[HourglassLayout<dim>::mode + d * Modes::n_pairs + k];
            for (unsigned int k = Modes::n_pairs; k < Modes::n_modes; ++k)
              resisted[directions[k]] = of_cell.amplitude[d][k];
            // and back to the nodes (transpose)
            for (int e = 0; e < dim; ++e)
              resisted += Kernel::sign(e) * Kernel::across(resisted, e);
            force[d] = -of_cell.resistance * resisted;
          }
        add_to_nodes<dim, Layout::hourglass_force>(cell, force, grid.nodes);
      }
  }



  template void
  find_hourglass_modes(const std::vector<std::uint32_t> &,
                       const GridView<2> &,
                       const std::vector<HourglassResistance<2>> &,
                       double,
                       std::vector<HourglassModes<2>> &,
                       double *);
  template void
  find_hourglass_modes(const std::vector<std::uint32_t> &,
                       const GridView<3> &,
                       const std::vector<HourglassResistance<3>> &,
                       double,
                       std::vector<HourglassModes<3>> &,
                       double *);
  template void
  add_hourglass_forces(const std::vector<std::uint32_t> &,
                       const GridView<2> &,
                       const std::vector<HourglassModes<2>> &,
                       const double *);
  template void
  add_hourglass_forces(const std::vector<std::uint32_t> &,
                       const GridView<3> &,
                       const std::vector<HourglassModes<3>> &,
                       const double *);
} // namespace limber
