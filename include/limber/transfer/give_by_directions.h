// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_give_by_directions_h
#define limber_transfer_give_by_directions_h

#include <limber/transfer/give_by_planes.h>

namespace limber
{
  namespace internal
  {
    /**
     * For point @p p: values in the outer lanes, derivatives in the inner ones.
     */
    __attribute__((always_inline)) inline Pack<4>
    with_slopes(const Pack<4> &values, const Pack<4> &slopes, const int p)
    {
      const PackType<4>::mask lanes{p, 4 + p, 4 + p, p};
      return __builtin_shuffle(values, slopes, lanes);
    }
  } // namespace internal



  /**
   * P2G for a pack of points in a cell of quadratic splines in 2d: m N_i,
   * m N_i v and the force - V t grad N_i. Contributions with the derivative N'
   * along one direction are in the inner lanes of a pack of their own:
   *
   *   lower = (m, f_0x, f_1x, m v_0), times (N, N', N', N)(x) and N(y),
   *   upper = (m v_1, f_0y, f_1y, 0), times N(x) and (N, N', N', N)(y).
   *
   * So each node takes two products of four lanes, instead of three of a whole
   * record.
   */
  template <class Sums, class Lanes>
  __attribute__((always_inline)) inline void
  give_by_directions(const PointView<2>                 &points,
                     const CellGeometry<2>              &cell,
                     const typename Quadratic<2>::Cell  &nodes,
                     const Lanes                        &lanes,
                     const std::array<PointPack<2>, 2>  &xi,
                     const SmallMatrix<2, PointPack<2>> &Vt,
                     const bool begins, // the sums of the batch
                     Sums      &of_batch)
  {
    using Basis     = Quadratic<2>;
    using Number    = PointPack<2>;
    using Layout    = NodeLayout<2>;
    using Mask      = internal::PackType<4>::mask;
    constexpr int n = Basis::n;
    static_assert(Sums::start == 0 && Layout::mass == 0 && Layout::force == 1 &&
                  Layout::momentum == 3);

    const Number          mass = lanes.load(points.mass);
    std::array<Number, 4> lower{
      {mass, -Vt[0][0], -Vt[1][0], mass * lanes.load(points.velocity[0])}},
      upper{{mass * lanes.load(points.velocity[1]),
             -Vt[0][1],
             -Vt[1][1],
             Number{}}};
    transpose<4>(lower);
    transpose<4>(upper);

    auto x = Basis::weights(nodes, 0, xi[0]);
    auto y = Basis::weights(nodes, 1, xi[1]);
#pragma GCC unroll 3
    for (int i = 0; i < n; ++i)
      {
        x.slope[i] *= cell.inverse_edge[0];
        y.slope[i] *= cell.inverse_edge[1];
      }
    const AxisFactors<Basis, false> factors({{x.value, y.value}}, {});

    std::array<Number, n * n> of_lower, of_upper;
    set_zero(of_lower);
    set_zero(of_upper);
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p)
      if (p < lanes.n)
        {
          std::array<Number, n> along_x;
#pragma GCC unroll 3
          for (int i = 0; i < n; ++i)
            along_x[i] = internal::with_slopes(x.value[i], x.slope[i], p);
#pragma GCC unroll 3
          for (int j = 0; j < n; ++j)
            {
              const Number row = factors.value[1][j][p] * lower[p];
#pragma GCC unroll 3
              for (int i = 0; i < n; ++i)
                of_lower[j * n + i] += along_x[i] * row;
            }
        }
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p)
      if (p < lanes.n)
#pragma GCC unroll 3
        for (int j = 0; j < n; ++j)
          {
            const Number row =
              internal::with_slopes(y.value[j], y.slope[j], p) * upper[p];
#pragma GCC unroll 3
            for (int i = 0; i < n; ++i)
              of_upper[j * n + i] += factors.value[0][i][p] * row;
          }

    const Number zero{};
    const Mask   forces{0, 5, 6, 3}, others{4, 1, 2, 3};
#pragma GCC unroll 9
    for (int i = 0; i < n * n; ++i)
      {
        const SplitPack record{of_lower[i] +
                                 __builtin_shuffle(zero, of_upper[i], forces),
                               __builtin_shuffle(zero, of_upper[i], others)};
        if (begins)
          of_batch.sums[i] = record;
        else
          of_batch.sums[i] += record;
      }
  }
} // namespace limber

#endif
