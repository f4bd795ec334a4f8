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
    constexpr std::array<int, CellTwist<dim>::n_modes>
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
  find_twists(const std::vector<std::uint32_t>            &cells,
              const GridView<dim>                         &grid,
              const std::vector<HourglassResistance<dim>> &bodies,
              const double                                 step,
              std::vector<CellTwist<dim>>                 &twists,
              double *const                                sums)
  {
    using Kernel          = Linear<dim>;
    using Nodes           = typename Kernel::Nodes;
    using Layout          = NodeLayout<dim>;
    using Twist           = CellTwist<dim>;
    constexpr int n_nodes = Kernel::n_nodes;
    // A nodal mass is shared by all cells around it
    const double   largest_share = 2. / n_nodes / step;
    constexpr auto directions    = directions_of_modes<dim>();

    twists.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      {
        const std::uint32_t      number = cells[i];
        const CellGeometry<dim> &cell   = grid.cells[number];
        Twist                   &twist  = twists[i];

        const auto of_nodes = [&](const unsigned int slot) {
          Nodes values{};
#pragma GCC unroll 8
          for (int a = 0; a < n_nodes; ++a)
            values[a] = grid.nodes[cell.node[a] + slot];
          return values;
        };
        const Nodes mass = of_nodes(Layout::mass);
        twist.resistance = std::min(resistance(cell, number, bodies),
                                    largest_share * minimum(mass));
        // No resistance, or a node without mass, as all points lie on a side.
        if (!(twist.resistance > 0))
          continue;
        const Nodes inverse_mass = 1. / mass;
        // Cells of different sizes are similar, so one area serves all pairs.
        const double inverse_area = cell.inverse_edge[0] * cell.inverse_edge[1];
        twist.area                = 1 / inverse_area;

        std::array<double, TwistLayout<dim>::n> given;
        const double weight = twist.resistance * twist.area * twist.area;
        given[TwistLayout<dim>::weight] = weight;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            // Nodal values to modes, products of their signs (Hadamard
            // transform)
            Nodes velocity = of_nodes(Layout::momentum + d) * inverse_mass;
            for (int e = 0; e < dim; ++e)
              velocity -= Kernel::sign(e) * Kernel::across(velocity, e);
            for (unsigned int k = 0; k < Twist::n_modes; ++k)
              twist.amplitude[d][k] = velocity[directions[k]] / n_nodes;
            for (unsigned int k = 0; k < Twist::n_pairs; ++k)
              given[TwistLayout<dim>::twist + d * Twist::n_pairs + k] =
                weight * inverse_area * twist.amplitude[d][k];
          }
        for (int a = 0; a < n_nodes; ++a)
          {
            double *const to = sums + cell.node[a];
            for (unsigned int k = 0; k < TwistLayout<dim>::n; ++k)
              to[k] += given[k];
          }
      }
  }



  template <int dim>
  void
  resist_twists(const std::vector<std::uint32_t>  &cells,
                const GridView<dim>               &grid,
                const std::vector<CellTwist<dim>> &twists,
                const double *const                means)
  {
    using Kernel              = Linear<dim>;
    using Nodes               = typename Kernel::Nodes;
    using Layout              = NodeLayout<dim>;
    using Twist               = CellTwist<dim>;
    constexpr int  n_nodes    = Kernel::n_nodes;
    constexpr auto directions = directions_of_modes<dim>();

    for (std::size_t i = 0; i < cells.size(); ++i)
      {
        const Twist &twist = twists[i];
        if (!(twist.resistance > 0))
          continue;
        const CellGeometry<dim> &cell = grid.cells[cells[i]];
        const double own = twist.resistance * twist.area * twist.area;

        std::array<double, TwistLayout<dim>::n> mean{};
        int                                     n_around = 0;
        bool                                    is_alone = true;
        for (int a = 0; a < n_nodes; ++a)
          {
            const double *const of_node = means + cell.node[a];
            if (!(of_node[TwistLayout<dim>::weight] > 0))
              continue;
            ++n_around;
            is_alone &= !(of_node[TwistLayout<dim>::weight] > own);
            for (unsigned int k = TwistLayout<dim>::twist;
                 k < TwistLayout<dim>::n;
                 ++k)
              mean[k] += of_node[k];
          }
        const double share = is_alone ? 1 : double(n_around) / n_nodes;
        const double area  = is_alone ? 0 : twist.area / n_nodes;

        std::array<Nodes, dim> force;
#pragma GCC unroll 8
        for (int d = 0; d < dim; ++d)
          {
            Nodes modes{};
            for (unsigned int k = 0; k < Twist::n_pairs; ++k)
              modes[directions[k]] =
                share * twist.amplitude[d][k] -
                area * mean[TwistLayout<dim>::twist + d * Twist::n_pairs + k];
            for (unsigned int k = Twist::n_pairs; k < Twist::n_modes; ++k)
              modes[directions[k]] = twist.amplitude[d][k];
            // and back to the nodes (transpose)
            for (int e = 0; e < dim; ++e)
              modes += Kernel::sign(e) * Kernel::across(modes, e);
            force[d] = -twist.resistance * modes;
          }
        add_to_nodes<dim, Layout::hourglass_force>(cell, force, grid.nodes);
      }
  }



  template void
  find_twists(const std::vector<std::uint32_t> &,
              const GridView<2> &,
              const std::vector<HourglassResistance<2>> &,
              double,
              std::vector<CellTwist<2>> &,
              double *);
  template void
  find_twists(const std::vector<std::uint32_t> &,
              const GridView<3> &,
              const std::vector<HourglassResistance<3>> &,
              double,
              std::vector<CellTwist<3>> &,
              double *);
  template void
  resist_twists(const std::vector<std::uint32_t> &,
                const GridView<2> &,
                const std::vector<CellTwist<2>> &,
                const double *);
  template void
  resist_twists(const std::vector<std::uint32_t> &,
                const GridView<3> &,
                const std::vector<CellTwist<3>> &,
                const double *);
} // namespace limber
