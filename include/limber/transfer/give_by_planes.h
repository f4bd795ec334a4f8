// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_by_planes_h
#define limber_transfer_give_by_planes_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>

namespace limber
{
  /**
   * The factors of the functions of a cell at the points of a pack, in memory,
   * for each direction and each node along it. Where it @p has_others, the
   * value along one axis at a time is exchanged for another factor: the slope,
   * or whatever else there is for each direction.
   */
  template <class Basis, bool has_others>
  struct AxisFactors
  {
    static constexpr int dim = Basis::dim, n = Basis::n;
    using Number               = PointPack<dim>;
    static constexpr int width = pack_width<Number>;
    using OfDirections         = std::array<std::array<Number, n>, dim>;

    __attribute__((always_inline))
    AxisFactors(const OfDirections &values, const OfDirections &others)
    {
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 4
        for (int i = 0; i < n; ++i)
          {
            store(values[d][i], value[d][i]);
            if constexpr (has_others)
              store(others[d][i], other[d][i]);
          }
      // A load spreads a factor over the lanes for nothing (SplineWeights).
      __asm__("" : "+m"(*this));
    }

    alignas(64) double value[dim][n][width];
    alignas(64) double other[has_others ? dim : 1][n][width];
  };



  /**
   * Add to the records of the nodes what the first @p n_points of a pack give:
   * N_i @p alike, and for each direction d the product of N_i with its factor
   * along d exchanged for the other one, times along[d]. If it @p begins the
   * sums, they need not be zero.
   *
   * The sums of a plane of nodes stay in registers from point to point; what
   * goes to it, to a row of it and to a node is formed one after the other.
   */
  template <class Basis,
            bool has_alike,
            bool has_along,
            class Record,
            class Along>
  __attribute__((always_inline)) inline void
  add_by_planes(
    const AxisFactors<Basis, has_along>                            &factors,
    const std::array<Record, AxisFactors<Basis, has_along>::width> &alike,
    const std::array<std::array<Along, AxisFactors<Basis, has_along>::width>,
                     Basis::dim>                                   &along,
    const int                                                       n_points,
    const bool                                                      begins,
    std::array<Record, Basis::n_nodes>                             &sums)
  {
    constexpr int dim = Basis::dim, n = Basis::n;
    for (int plane = 0; plane < Basis::n_nodes / (n * n); ++plane)
      {
        std::array<Record, n * n> of_plane;
        if (begins)
          set_zero(of_plane);
        else
#pragma GCC unroll 16
          for (int i = 0; i < n * n; ++i)
            of_plane[i] = sums[plane * n * n + i];
        for (int p = 0; p < n_points; ++p)
          {
            Record to_plane{};
            Along  along_x, along_y;
            if constexpr (has_alike)
              to_plane = alike[p];
            if constexpr (has_along)
              {
                along_x = along[0][p];
                along_y = along[1][p];
              }
            if constexpr (dim == 3)
              {
                const double value = factors.value[2][plane][p];
                if constexpr (has_alike)
                  to_plane *= value;
                if constexpr (has_along)
                  {
                    to_plane += factors.other[2][plane][p] * along[2][p];
                    along_x *= value;
                    along_y *= value;
                  }
              }
#pragma GCC unroll 4
            for (int j = 0; j < n; ++j)
              {
                const double value  = factors.value[1][j][p];
                Record       to_row = value * to_plane;
                Along        slope{};
                if constexpr (has_along)
                  {
                    to_row += factors.other[1][j][p] * along_y;
                    slope = value * along_x;
                  }
#pragma GCC unroll 4
                for (int i = 0; i < n; ++i)
                  {
                    Record &sum = of_plane[j * n + i];
                    sum += factors.value[0][i][p] * to_row;
                    if constexpr (has_along)
                      sum += factors.other[0][i][p] * slope;
                  }
              }
          }
#pragma GCC unroll 16
        for (int i = 0; i < n * n; ++i)
          sums[plane * n * n + i] = of_plane[i];
      }
  }
} // namespace limber

#endif
