// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_node_places_h
#define limber_grid_node_places_h

#include <limber/grid/background_grid.h>

namespace limber
{
  /**
   * A global key of each node of the kernel, by local number, independent of
   * ranks and mesh: its index in a lattice twice as fine as the finest cells, x
   * fastest. With splines and several ranks some ghost nodes may be unknown:
   * these have `no_place`.
   */
  template <int dim>
  std::vector<std::uint64_t>
  places_of_nodes(const BackgroundGrid<dim> &grid);

  inline constexpr std::uint64_t no_place = ~std::uint64_t(0);
} // namespace limber

#endif
