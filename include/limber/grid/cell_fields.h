// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_cell_fields_h
#define limber_grid_cell_fields_h

#include <limber/base/lazy_array.h>
#include <limber/grid/background_grid.h>

namespace limber
{
  /**
   * The sums of one body in each cell (CellSums), owned or ghost: those of the
   * present places of the points, complete where points of this rank are and
   * on the owner, and those of the next places, which sweeps gather.
   */
  template <int dim>
  class CellFields
  {
  public:
    /** With so many sums in a cell; see CellSums. */
    explicit CellFields(const BackgroundGrid<dim> &grid,
                        unsigned int               stride = 1 << dim);

    void
    reinit();

    CellSums<dim>
    view();

    /** The mass in a cell, before next sums are gathered, kg. */
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

    /** The sums of the present places. */
    const double *
    record(const std::uint32_t cell) const
    {
      return now.data() + std::size_t(cell) * stride;
    }

    /** The same, for bodies that take what they have in common. */
    double *
    record(const std::uint32_t cell)
    {
      return now.data() + std::size_t(cell) * stride;
    }

    /**
     * Complete the sums gathered since the last time with those of other
     * ranks and make them the present ones; what was gathered before is
     * forgotten. Between start and finish nothing must be gathered.
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
