// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_cell_averages_h
#define limber_state_cell_averages_h

#include <limber/base/lazy_array.h>
#include <limber/grid/grid_view.h>

#include <vector>

namespace limber
{
  /**
   * Mass-weighted means over the points of each cell of a quantity of one body:
   * records (NodalMeanLayout) by cell number, to which sweeps add and from
   * which they read the means (interpolation/domain_means.h). For bodies whose
   * points are all on the rank that owns their cell.
   */
  class CellAverages
  {
  public:
    explicit CellAverages(const std::size_t n_cells)
      : records(n_cells * Layout::stride)
    {}

    /** The records, for sweeps. */
    double *
    data()
    {
      return records.data();
    }

    /** Set the sums of these cells to zero. */
    void
    clear(const std::vector<std::uint32_t> &cells)
    {
      for (const std::uint32_t cell : cells)
        records[index(cell) + Layout::mass] =
          records[index(cell) + Layout::value] = 0;
    }

    /** Divide the sums by the masses. */
    void
    finish(const std::vector<std::uint32_t> &cells)
    {
      for (const std::uint32_t cell : cells)
        if (const double mass = records[index(cell) + Layout::mass]; mass > 0)
          records[index(cell) + Layout::value] /= mass;
    }

  private:
    using Layout = NodalMeanLayout;

    static std::size_t
    index(const std::uint32_t cell)
    {
      return std::size_t(cell) * Layout::stride;
    }

    LazyArray<double> records;
  };
} // namespace limber

#endif
