// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_cell_fields_h
#define limber_grid_cell_fields_h

#include <limber/base/lazy_array.h>
#include <limber/grid/background_grid.h>

namespace limber
{
  /**
   * Storage of the cell sums of one body (CellSums), owned and ghost: those at
   * the present positions of the points, complete on the owner and where this
   * rank has points, and the next ones, which sweeps gather.
   */
  template <int dim>
  class CellFields
  {
  public:
    /** With @p stride sums per cell; see CellSums. */
    explicit CellFields(const BackgroundGrid<dim> &grid,
                        unsigned int               stride = 1 << dim);

    void
    reinit();

    CellSums<dim>
    view();

    /** The present mass in a cell, kg; only before next sums are gathered. */
    double
    present_mass(const std::uint32_t cell) const
    {
      return turn_of[cell] + 1 == turn ? record(cell)[CellSums<dim>::mass] : 0;
    }

    /** The sum of m times the volumetric variable, likewise, kg. */
    double
    present_volumetric(const std::uint32_t cell) const
    {
      return record(cell)[stride - 1];
    }

    /** The sums at the present positions. */
    const double *
    record(const std::uint32_t cell) const
    {
      return now.data() + std::size_t(cell) * stride;
    }

    /** The same, writable, for bodies that share sums. */
    double *
    record(const std::uint32_t cell)
    {
      return now.data() + std::size_t(cell) * stride;
    }

    /**
     * Complete the gathered sums over the ranks, and make them the present
     * ones; the former present ones are discarded. No gathering between start
     * and finish.
     */
    void
    start_completion(const ExchangePlan &plan);
    void
    finish_completion();

    const unsigned int stride;

  private:
    const BackgroundGrid<dim> &grid;
    LazyArray<double>          now, next;
    LazyArray<std::uint32_t>   turn_of;
    std::uint32_t              turn = 1;
    RecordExchange             exchange{stride};
  };
} // namespace limber

#endif
