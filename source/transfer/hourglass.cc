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
        double                   k    = resistance(cell, number, bodies);
        if (!(k > 0))
          continue;

        std::array<std::array<double, n_nodes>, dim> velocity;
        double                                       smallest = 1e300;
        for (int a = 0; a < n_nodes; ++a)
          {
            const double *const record = grid.nodes + cell.node[a];
            const double        mass   = record[Layout::mass];
            smallest                   = std::min(smallest, mass);
            for (int d = 0; d < dim; ++d)
              velocity[d][a] = record[Layout::momentum + d] / mass;
          }
        k = std::min(k, largest_share * smallest);

        std::array<Nodes, dim> force{};
        for (int mode = 3; mode < n_nodes; ++mode)
          {
            // one mode for every product of two or more coordinates
            if ((mode & (mode - 1)) == 0)
              continue;
            Nodes signs = broadcast<Nodes>(1.);
            for (int d = 0; d < dim; ++d)
              if (mode >> d & 1)
                signs *= Kernel::sign(d);
            for (int d = 0; d < dim; ++d)
              force[d] -=
                (k / n_nodes * sum(signs * load<Nodes>(velocity[d].data()))) *
                signs;
          }
        add_to_nodes<dim, Layout::remapped>(cell, force, grid.nodes);
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
