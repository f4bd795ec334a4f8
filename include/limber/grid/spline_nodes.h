// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_spline_nodes_h
#define limber_grid_spline_nodes_h

#include <limber/grid/background_grid.h>

namespace limber
{
  /** Stands for a node of a ghost cell of which this rank knows nothing. */
  inline constexpr std::uint32_t unknown_node = 0xffffffffu;

  /**
   * The nodes of quadratic splines (interpolation/spline_factors.h) over equal
   * cells: one for each cell, and those in the sides of the grid, which belong
   * to the cells next to them.
   */
  template <int dim>
  struct QuadraticNodes
  {
    NodeTable<dim> nodes;
    // By cell. The nodes of owned cells are all known.
    std::vector<SplineCell<dim, 2>> cells;
  };

  /** Needs the cells of the grid, and their bins. */
  template <int dim>
  QuadraticNodes<dim>
  number_quadratic_nodes(const BackgroundGrid<dim> &grid);

  /**
   * The same for cubic splines, whose nodes are the vertices of the cells;
   * those of owned cells are all known.
   */
  template <int dim>
  std::vector<SplineCell<dim, 3>>
  find_cubic_cells(const BackgroundGrid<dim> &grid);

  /** Complete the table of the vertices for cubic splines: who is inward. */
  template <int dim>
  void
  set_inward_vertices(const BackgroundGrid<dim> &grid,
                      NodeTable<dim>            &vertices);
} // namespace limber

#endif
