// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_spline_nodes_h
#define limber_grid_spline_nodes_h

#include <limber/grid/background_grid.h>

namespace limber
{
  /** Stands for a node of a ghost cell of which this rank knows nothing. */
  inline constexpr std::uint32_t unknown_node = 0xffffffffu;

  /**
   * The nodes of quadratic splines (interpolation/quadratic.h) over equal
   * cells: one for each cell, and those in the sides of the grid, which belong
   * to the cells next to them.
   */
  template <int dim>
  struct SplineNodes
  {
    NodeTable<dim> nodes;
    // By cell. The nodes of owned cells are all known.
    std::vector<SplineCell<dim>> cells;
  };

  /** Needs the cells of the grid, and their bins. */
  template <int dim>
  SplineNodes<dim>
  number_spline_nodes(const BackgroundGrid<dim> &grid);
} // namespace limber

#endif
