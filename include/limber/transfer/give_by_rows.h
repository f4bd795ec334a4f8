// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_by_rows_h
#define limber_transfer_give_by_rows_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>

namespace limber
{
  /**
   * The factors of the functions of a cell at the points of a pack, in memory:
   * of each node along x, and of each row of nodes the products of those along
   * the other axes. Where it @p has_others, the value along one axis at a time
   * is exchanged for another factor: the slope, or whatever else there is for
   * each direction.
   */
  template <class Basis, bool has_others>
  struct RowFactors
  {
    static constexpr int dim = Basis::dim, n = Basis::n;
    static constexpr int n_rows = Basis::n_nodes / n;
    using Number                = PointPack<dim>;
    static constexpr int width  = pack_width<Number>;
    using OfDirections          = std::array<std::array<Number, n>, dim>;

    __attribute__((always_inline))
    RowFactors(const OfDirections &values, const OfDirections &others)
    {
#pragma GCC unroll 4
      for (int i = 0; i < n; ++i)
        {
          store(values[0][i], value[i]);
          if constexpr (has_others)
            store(others[0][i], other[i]);
        }
#pragma GCC unroll 16
      for (int row = 0; row < n_rows; ++row)
        {
          const int j = row % n;
          const int k = row / n;
          if constexpr (dim == 2)
            store(values[1][j], row_value[row]);
          else
            store(values[1][j] * values[2][k], row_value[row]);
          if constexpr (has_others && dim == 2)
            store(others[1][j], row_other[0][row]);
          if constexpr (has_others && dim == 3)
            {
              store(others[1][j] * values[2][k], row_other[0][row]);
              store(values[1][j] * others[2][k], row_other[1][row]);
            }
        }
      // A load spreads a factor over the lanes for nothing (SplineWeights).
      __asm__("" : "+m"(*this));
    }

    alignas(64) double value[n][width];
    alignas(64) double row_value[n_rows][width];
    alignas(64) double other[has_others ? n : 1][width];
    alignas(64) double row_other[dim - 1][has_others ? n_rows : 1][width];
  };



  /**
   * Add to the records of the nodes, row by row, what the first @p n_points of
   * a pack give: N_i @p alike, and for each direction d the product of N_i with
   * its factor along d exchanged for the other one, times along[d]. If it
   * @p begins the sums, they need not be zero.
   *
   * Sums of sixteen or 64 nodes do not stay in registers from point to point,
   * as those of quadratic splines do (SplineSums::add); those of a row do.
   */
  template <class Basis, bool has_alike, bool has_along, class Record>
  __attribute__((always_inline)) inline void
  add_by_rows(
    const RowFactors<Basis, has_along>                            &factors,
    const std::array<Record, RowFactors<Basis, has_along>::width> &alike,
    const std::array<std::array<Record, RowFactors<Basis, has_along>::width>,
                     Basis::dim>                                  &along,
    const int                                                      n_points,
    const bool                                                     begins,
    std::array<Record, Basis::n_nodes>                            &sums)
  {
    constexpr int dim = Basis::dim, n = Basis::n;
    for (int row = 0; row < Basis::n_nodes / n; ++row)
      {
        std::array<Record, n> of_row;
        if (begins)
          set_zero(of_row);
        else
          std::copy_n(&sums[row * n], n, of_row.begin());
        for (int p = 0; p < n_points; ++p)
          {
            const double value = factors.row_value[row][p];
            Record       first{};
            if constexpr (has_alike)
              first = value * alike[p];
            if constexpr (has_along)
              {
#pragma GCC unroll 2
                for (int d = 1; d < dim; ++d)
                  first += factors.row_other[d - 1][row][p] * along[d][p];
                const Record second = value * along[0][p];
#pragma GCC unroll 4
                for (int i = 0; i < n; ++i)
                  of_row[i] += factors.other[i][p] * second;
              }
#pragma GCC unroll 4
            for (int i = 0; i < n; ++i)
              of_row[i] += factors.value[i][p] * first;
          }
        std::copy_n(of_row.begin(), n, &sums[row * n]);
      }
  }
} // namespace limber

#endif
