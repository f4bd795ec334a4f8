// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/pressure_system.h>

#include <algorithm>

/**
 * @file The equations of the implicit pressure on adaptive meshes: hanging
 * nodes are constrained to their masters by the interpolation Z, so the mean
 * divergence is B Z, and its transpose gives nodal forces to the masters.
 */

namespace limber
{
  // Cells, ascending, that share an unconstrained node with a cell, directly or
  // by hanging nodes: its row has entries for these.
  template <int dim>
  std::vector<std::uint32_t>
  PressureSystem<dim>::coupled_to(const std::uint32_t cell) const
  {
    std::vector<std::uint32_t> result;
    for (unsigned int a = 0; a < n_nodes; ++a)
      cells.corners.for_each_master(
        cells.node_of(cell, a), [&](const auto &master) {
          cells.corners.for_each(master.node, [&](const auto &corner) {
            result.push_back(corner.cell);
          });
        });
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }



  template <int dim>
  void
  PressureSystem<dim>::find_columns_over_levels()
  {
    const auto                             &media = cells.media;
    std::vector<std::vector<std::uint32_t>> near(equations.n);
    in_body = 0;
    for_each_row([&](const std::uint32_t row, const std::uint32_t cell) {
      near[row] = coupled_to(cell);
      in_body   = std::max<unsigned int>(in_body, near[row].size());
    });
    in_body  = dealii::Utilities::MPI::max(in_body, parts.grid.communicator);
    of_cells = in_body * media.size();
    equations.width        = of_cells + most_surfaces_near();
    const std::size_t size = std::size_t(equations.n) * equations.width;
    equations.columns.assign(size, PressureEquations::no_column);
    mates.assign(size, invalid_cell);
    for (std::uint32_t row = 0; row < equations.n; ++row)
      {
        const std::size_t begin = std::size_t(row) * equations.width;
        for (std::size_t l = 0; l < media.size(); ++l)
          {
            std::size_t at = begin + l * in_body;
            for (const std::uint32_t cell : near[row])
              if (const double number = media[l].record(cell)[Record::number];
                  number > 0)
                {
                  equations.columns[at] = number - 1;
                  mates[at++]           = cell;
                }
          }
        if (!cells.surfaces.any())
          continue;
        std::size_t at = begin + of_cells;
        for (const std::uint32_t cell : near[row])
          cells.surfaces.for_each_in(cell, [&](const std::uint32_t k) {
            equations.columns[at] = cells.surfaces.pieces[k].row;
            mates[at++]           = k;
          });
      }
  }



  // Index of the entry of a cell of a medium in a row, on adaptive meshes.
  template <int dim>
  std::size_t
  PressureSystem<dim>::entry_of(const std::uint32_t row,
                                const std::size_t   medium,
                                const std::uint32_t cell) const
  {
    const auto begin =
      mates.begin() + std::size_t(row) * equations.width + medium * in_body;
    return std::find(begin, begin + in_body, cell) - mates.begin();
  }



  // Whether the medium is in all cells around a node and these have one size:
  // only there the checkerboard control acts.
  template <int dim>
  bool
  PressureSystem<dim>::is_inside(const Medium       &medium,
                                 const std::uint32_t node) const
  {
    if (!medium.is_inside(node))
      return false;
    const auto size_of = [&](const unsigned int k) {
      return parts.grid.geometry[medium.cells_around(node)[k] - 1]
        .inverse_edge[0];
    };
    for (unsigned int k = 1; k < n_nodes && !cells.corners.empty(); ++k)
      if (size_of(k) != size_of(0))
        return false;
    return true;
  }



  // As couple_on_lattice(), with the masters of hanging corners.
  template <int dim>
  void
  PressureSystem<dim>::couple_over_levels(const double *const own,
                                          const std::uint32_t cell,
                                          const std::uint32_t row,
                                          const double        step)
  {
    const auto &media = cells.media;
    for (unsigned int a = 0; a < n_nodes; ++a)
      cells.corners.for_each_master(
        cells.node_of(cell, a), [&](const auto &master) {
          double scaled[dim];
          for (int d = 0; d < dim; ++d)
            {
              const std::size_t at    = std::size_t(master.node) * dim + d;
              const double      entry = step * master.share * own[a * dim + d];
              equations.right_side[row] -= entry * velocity[at];
              scaled[d] = step * entry * mobility[at];
            }
          if (to_hold != nullptr && held_as[master.node] > 0)
            move(master.node, scaled);
          cells.corners.for_each(master.node, [&](const auto &corner) {
            const auto add = [&](double &value, const double *const entries) {
              for (int d = 0; d < dim; ++d)
                value +=
                  scaled[d] * corner.share * entries[corner.corner * dim + d];
            };
            for (std::size_t l = 0; l < media.size(); ++l)
              if (const double *const mate = media[l].record(corner.cell);
                  mate[Record::number] > 0 && mate[Record::volume] > 0)
                add(equations.values[entry_of(row, l, corner.cell)],
                    mate + Record::rows);
            if (cells.surfaces.any())
              cells.surfaces.for_each_in(
                corner.cell, [&](const std::uint32_t k) {
                  if (const Piece &piece = cells.surfaces.pieces[k];
                      piece.is_wet)
                    add(equations.values[surface_entry(row, k)],
                        piece.entries.data());
                });
          });
        });
  }



  // The sum of the shares of the cells around.
  template <int dim>
  double
  PressureSystem<dim>::nodal_volume_over_levels(const std::uint32_t node) const
  {
    double result = 0;
    cells.corners.for_each(node, [&](const auto &part) {
      result += part.nodal_volume;
    });
    return result;
  }



  template void
  PressureSystem<2>::find_columns_over_levels();
  template std::vector<std::uint32_t>
    PressureSystem<2>::coupled_to(std::uint32_t) const;
  template void
                       PressureSystem<2>::couple_over_levels(const double *,
                                        std::uint32_t,
                                        std::uint32_t,
                                        double);
  template std::size_t PressureSystem<2>::entry_of(std::uint32_t,
                                                   std::size_t,
                                                   std::uint32_t) const;
  template double
    PressureSystem<2>::nodal_volume_over_levels(std::uint32_t) const;
  template bool
  PressureSystem<2>::is_inside(const Medium &, std::uint32_t) const;
  template void
  PressureSystem<3>::find_columns_over_levels();
  template std::vector<std::uint32_t>
    PressureSystem<3>::coupled_to(std::uint32_t) const;
  template void
                       PressureSystem<3>::couple_over_levels(const double *,
                                        std::uint32_t,
                                        std::uint32_t,
                                        double);
  template std::size_t PressureSystem<3>::entry_of(std::uint32_t,
                                                   std::size_t,
                                                   std::uint32_t) const;
  template double
    PressureSystem<3>::nodal_volume_over_levels(std::uint32_t) const;
  template bool
  PressureSystem<3>::is_inside(const Medium &, std::uint32_t) const;
} // namespace limber
