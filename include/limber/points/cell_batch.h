// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_points_cell_batch_h
#define limber_points_cell_batch_h

#include <limber/points/point_view.h>

namespace limber
{
  /**
   * The unit of work of every sweep: consecutive points of one body in one
   * cell.
   */
  struct CellBatch
  {
    std::uint32_t cell;
    std::size_t   begin, end; // points [begin, end)
  };



  /**
   * The loop over batches: call @p work for every batch, in storage order.
   * Points that have changed their cell since the last sort form batches of
   * their own, so a cell may occur more than once. Returns the number of
   * batches, a measure of how far the order has decayed.
   */
  template <int dim, class Work>
  __attribute__((always_inline)) inline std::size_t
  for_each_batch(const PointView<dim> &points, const Work &work)
  {
    std::size_t       n_batches = 0;
    const std::size_t n         = points.size;
    for (std::size_t p = 0; p < n; ++n_batches)
      {
        const std::uint32_t cell  = points.cell[p];
        const std::size_t   begin = p;
        do
          ++p;
        while (p < n && points.cell[p] == cell);
        work(CellBatch{cell, begin, p});
      }
    return n_batches;
  }



  /**
   * Call @p work for all points in blocks, regardless of cells: blocks are
   * short enough for plain sums over them to be accurate.
   */
  template <class Work>
  __attribute__((always_inline)) inline void
  for_each_block(const std::size_t n_points, const Work &work)
  {
    constexpr std::size_t block = 512;
    for (std::size_t p = 0; p < n_points; p += block)
      work(CellBatch{0, p, p + block < n_points ? p + block : n_points});
  }
} // namespace limber

#endif
