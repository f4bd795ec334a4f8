// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_spline_nodes_h
#define limber_grid_spline_nodes_h

#include <limber/grid/background_grid.h>

namespace limber
{
  /** A node of a ghost cell that this rank does not know. */
  inline constexpr std::uint32_t unknown_node = 0xffffffffu;

  /**
   * The nodes of quadratic splines (interpolation/spline_factors.h) on equal
   * cells: one per cell, and those in the sides of the grid, which belong to
   * the adjacent cells.
   */
  template <int dim>
  struct QuadraticNodes
  {
    NodeTable<dim> nodes;
    // By cell. The nodes of owned cells are all known.
    std::vector<SplineCell<dim, 2>> cells;
  };

  /** Needs the cell tables and bins of the grid. */
  template <int dim>
  QuadraticNodes<dim>
  number_quadratic_nodes(const BackgroundGrid<dim> &grid);

  /**
   * The cells of cubic splines, whose nodes are the vertices; all nodes of
   * owned cells are known.
   */
  template <int dim>
  std::vector<SplineCell<dim, 3>>
  find_cubic_cells(const BackgroundGrid<dim> &grid);

  /**
   * Complete the table of the vertices for cubic splines: inward neighbours.
   */
  template <int dim>
  void
  set_inward_vertices(const BackgroundGrid<dim> &grid,
                      NodeTable<dim>            &vertices);
} // namespace limber

#endif
