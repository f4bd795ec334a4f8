// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_by_planes_h
#define limber_transfer_give_by_planes_h

#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>

namespace limber
{
  /**
   * The one-dimensional factors of the spline functions of a cell at the points
   * of a pack, in memory, by direction and node along it. If it @p has_others,
   * also a second factor that replaces the value along one axis at a time: the
   * derivative, or another one per direction.
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
      // Broadcast loads from memory are free (see SplineWeights).
      __asm__("" : "+m"(*this));
    }

    alignas(64) double value[dim][n][width];
    alignas(64) double other[has_others ? dim : 1][n][width];
  };



  /**
   * P2G by sum factorisation: add to the records of the nodes, for the first @p
   * n_points of a pack, N_i @p alike and, for each direction d, along[d] times
   * N_i with its factor along d replaced by the other one. If it @p begins the
   * sums, these need not be zero.
   *
   * Contributions to a plane of nodes, to a row of it and to a node are formed
   * in turn. The sums of a plane stay in registers from point to point; if the
   * machine has too few, those of a row.
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
    struct PlaneShare
    {
      Record alike;
      Along  along_x, along_y;
    };
    const auto share_of = [&](const int plane, const int p)
      __attribute__((always_inline))
    {
      PlaneShare share{};
      if constexpr (has_alike)
        share.alike = alike[p];
      if constexpr (has_along)
        {
          share.along_x = along[0][p];
          share.along_y = along[1][p];
        }
      if constexpr (dim == 3)
        {
          const double value = factors.value[2][plane][p];
          if constexpr (has_alike)
            share.alike *= value;
          if constexpr (has_along)
            {
              share.alike += factors.other[2][plane][p] * along[2][p];
              share.along_x *= value;
              share.along_y *= value;
            }
        }
      return share;
    };
    const auto add_row = [&](const PlaneShare &share,
                             const int         j,
                             const int         p,
                             Record *const row) __attribute__((always_inline))
    {
      const double value  = factors.value[1][j][p];
      Record       to_row = value * share.alike;
      Along        slope{};
      if constexpr (has_along)
        {
          to_row += factors.other[1][j][p] * share.along_y;
          slope = value * share.along_x;
        }
#pragma GCC unroll 4
      for (int i = 0; i < n; ++i)
        {
          row[i] += factors.value[0][i][p] * to_row;
          if constexpr (has_along)
            row[i] += factors.other[0][i][p] * slope;
        }
    };
    // Keep the sums of some nodes from the first on in registers during
    // add(kept)
    const auto keep_sums = [&](const auto count, const int first, auto &&add)
      __attribute__((always_inline))
    {
      constexpr int              n_sums = std::decay_t<decltype(count)>::value;
      std::array<Record, n_sums> kept;
      if (begins)
        set_zero(kept);
      else
#pragma GCC unroll 16
        for (int i = 0; i < n_sums; ++i)
          kept[i] = sums[first + i];
      add(kept.data());
#pragma GCC unroll 16
      for (int i = 0; i < n_sums; ++i)
        sums[first + i] = kept[i];
    };

    constexpr int  per_record = (pack_width<Record> + 3) / 4; // registers
    constexpr bool plane_fits = n * n * per_record + 5 <= n_registers;
    for (int plane = 0; plane < Basis::n_nodes / (n * n); ++plane)
      if constexpr (plane_fits)
        keep_sums(
          std::integral_constant<int, n * n>(),
          plane * n * n,
          [&](Record *const kept) __attribute__((always_inline)) {
            for (int p = 0; p < n_points; ++p)
              {
                const PlaneShare share = share_of(plane, p);
#pragma GCC unroll 4
                for (int j = 0; j < n; ++j)
                  add_row(share, j, p, kept + j * n);
              }
          });
      else
        {
          std::array<PlaneShare, AxisFactors<Basis, has_along>::width> shares;
          for (int p = 0; p < n_points; ++p)
            shares[p] = share_of(plane, p);
#pragma GCC unroll 4
          for (int j = 0; j < n; ++j)
            keep_sums(
              std::integral_constant<int, n>(),
              (plane * n + j) * n,
              [&](Record *const kept) __attribute__((always_inline)) {
                for (int p = 0; p < n_points; ++p)
                  add_row(shares[p], j, p, kept);
              });
        }
  }
} // namespace limber

#endif
