// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_node_places_h
#define limber_grid_node_places_h

#include <limber/grid/background_grid.h>

namespace limber
{
  /**
   * The place of each node of the grid's kernel, by local number, in a lattice
   * twice as fine as the finest cells, x fastest: a name of the node that
   * ranks and meshes have in common. A rank of several may not know all nodes
   * that it meets with splines: those have `no_place`.
   */
  template <int dim>
  std::vector<std::uint64_t>
  places_of_nodes(const BackgroundGrid<dim> &grid);

  inline constexpr std::uint64_t no_place = ~std::uint64_t(0);
} // namespace limber

#endif
