// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_add_to_nodes_h
#define limber_transfer_add_to_nodes_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

namespace limber
{
  /**
   * Add to the records of the nodes of a cell: lane i of values[k] goes to slot
   * first + k of node i. A transposition turns many scalar additions into one
   * vector addition per node; unused lanes add zero. Always inlined: a call
   * would pass all values through memory.
   */
  template <int dim, unsigned int first, std::size_t n_values>
  __attribute__((always_inline)) inline void
  add_to_nodes(const CellGeometry<dim>                      &cell,
               const std::array<Pack<(1 << dim)>, n_values> &values,
               double *const                                 nodes)
  {
    // Two values are added alone: the next batch reads velocities next to
    // re-mapped momenta in the same records, and an overlapping wider store
    // would stall its loads (no store forwarding). In three dimensions nothing
    // stalls.
    constexpr unsigned int n_nodes = 1 << dim;
    constexpr unsigned int width   = n_values == 2 ? 2 : n_nodes;
    static_assert(dim == 2 || n_values <= width, "one transposition in 3d");
    using Lanes = Pack<width>;

    // Shifted such that it stays within the record
    constexpr unsigned int n_first = n_values < width ? n_values : width;
    constexpr unsigned int shift   = first + width <= NodeLayout<dim>::stride ?
                                       0 :
                                       first + width - NodeLayout<dim>::stride;
    static_assert(n_first + shift <= width, "the record is too short");

    for (unsigned int begin = 0; begin < n_nodes; begin += width)
      {
        std::array<Lanes, width> block{};
        for (unsigned int k = 0; k < n_first; ++k)
          block[k + shift] = some_lanes<Lanes>(values[k], begin);
        transpose<width>(block);
        for (unsigned int i = 0; i < width; ++i)
          {
            double *const record = nodes + cell.node[begin + i] + first - shift;
            store(load<Lanes>(record) + block[i], record);
          }
      }
    for (unsigned int k = n_first; k < n_values; ++k)
      for (unsigned int i = 0; i < n_nodes; ++i)
        nodes[cell.node[i] + first + k] += values[k][i];
  }
} // namespace limber

#endif
