// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_add_to_nodes_h
#define limber_transfer_add_to_nodes_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

namespace limber
{
  namespace internal
  {
    /**
     * One stage of a transposition in place: exchange the blocks of size
     * @p half off the diagonal.
     */
    template <int width, int half>
    __attribute__((always_inline)) inline void
    exchange_blocks(std::array<Pack<width>, width> &a)
    {
      typename PackType<width>::mask low, high;
      for (int i = 0; i < width; ++i)
        {
          low[i]  = (i & half) ? width + (i ^ half) : i;
          high[i] = (i & half) ? width + i : (i ^ half);
        }
      for (int i = 0; i < width; ++i)
        if (!(i & half))
          {
            const Pack<width> upper = a[i], lower = a[i | half];
            a[i]        = __builtin_shuffle(upper, lower, low);
            a[i | half] = __builtin_shuffle(upper, lower, high);
          }
    }



    template <int width>
    __attribute__((always_inline)) inline void
    transpose(std::array<Pack<width>, width> &a)
    {
      exchange_blocks<width, 1>(a);
      exchange_blocks<width, 2>(a);
      if constexpr (width == 8)
        exchange_blocks<width, 4>(a);
    }
  } // namespace internal



  /**
   * Add to the records of the nodes of a cell: lane i of values[k] goes to
   * slot first + k of node i. A transposition makes one vector addition per
   * node out of many scalar ones; the lanes beyond the last value add zero.
   * Always inlined: a call would send all values through memory.
   */
  template <int dim, unsigned int first, std::size_t n_values>
  __attribute__((always_inline)) inline void
  add_to_nodes(const CellGeometry<dim>                      &cell,
               const std::array<Pack<(1 << dim)>, n_values> &values,
               double *const                                 nodes)
  {
    constexpr unsigned int width = 1 << dim;
    static_assert(dim == 2 || n_values <= width, "one transposition in 3d");
    using Nodes = Pack<width>;

    // An addition as wide as the node count stays within the record.
    constexpr unsigned int n_first = n_values < width ? n_values : width;
    constexpr unsigned int shift   = first + width <= NodeLayout<dim>::stride ?
                                       0 :
                                       first + width - NodeLayout<dim>::stride;
    static_assert(n_first + shift <= width, "the record is too short");

    std::array<Nodes, width> block{};
    for (unsigned int k = 0; k < n_first; ++k)
      block[k + shift] = values[k];
    internal::transpose<width>(block);
    for (unsigned int i = 0; i < width; ++i)
      {
        double *const record = nodes + cell.node[i] + first - shift;
        store(load<Nodes>(record) + block[i], record);
      }
    for (unsigned int k = n_first; k < n_values; ++k)
      for (unsigned int i = 0; i < width; ++i)
        nodes[cell.node[i] + first + k] += values[k][i];
  }
} // namespace limber

#endif
