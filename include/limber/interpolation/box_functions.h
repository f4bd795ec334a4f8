// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_box_functions_h
#define limber_interpolation_box_functions_h

#include <limber/interpolation/block_nodes.h>

namespace limber
{
  /**
   * The functions of the nodes of blocks on boxes along the axes (GIMP;
   * convected.h), points as lanes: for each direction the means over the box of
   * 1 - x, 1 - |x - 1| and x - 1, or zero, and half their change from one end
   * to the other. A function is a product of means, and its change along an
   * axis has the change along that one in place of a mean. Beyond a side of the
   * grid the first and the last go on.
   */
  template <int dim>
  class BoxFunctions
  {
  public:
    using Block  = BlockNodes<dim>;
    using Number = typename Block::Number;
    using Vector = typename Block::Vector;

    /** On boxes around @p at with the edges 2 @p half; in the block, in cells.
     */
    __attribute__((always_inline)) void
    set(const Vector &at, const Vector &half)
    {
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          const Number lower = at[d] - half[d], upper = at[d] + half[d];
          const Number share = 0.5 / half[d];
          const Number below = larger(1. - lower, Number{}),
                       rest  = larger(1. - upper, Number{}),
                       above = larger(upper - 1., Number{}),
                       start = larger(lower - 1., Number{});
          const Number first = 0.5 * (rest - below),
                       last  = 0.5 * (above - start);
          const Number least = (below + rest) * (share * -first),
                       most  = (above + start) * (share * last);
          store(first, changes[d][0]);
          store(-(first + last), changes[d][1]);
          store(last, changes[d][2]);
          store(least, means[d][0]);
          store(larger(1. - least - most, Number{}), means[d][1]);
          store(most, means[d][2]);
        }
      // Else GCC takes every factor out of a register by shuffles, where a
      // load spreads it over the lanes for nothing.
      __asm__("" : "+m"(*this));
    }

    /**
     * u of fields in the slots of the window at point p, and their changes
     * along the edges: sums over rows, planes and the block.
     */
    template <class Window>
    __attribute__((always_inline)) void
    take(const Block                             &block,
         const double *const                      nodes,
         const int                                p,
         typename Window::Lanes                  &u,
         std::array<typename Window::Lanes, dim> &change) const
    {
      using Record = typename Window::Lanes;
      u            = Record{};
      set_zero(change);
#pragma GCC unroll 3
      for (int k = 0; k < Block::n_nodes / 9; ++k)
        {
          if (dim == 3 && block.ends_before(p, dim - 1, k))
            continue;
          Record value{}, along_x{}, along_y{};
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j)
            {
              if (block.ends_before(p, 1, j))
                continue;
              Record row{}, slope{};
#pragma GCC unroll 3
              for (int i = 0; i < 3; ++i)
                {
                  const auto field = load<Record>(
                    nodes + block.record(p, 9 * k + 3 * j + i) + Window::start);
                  row += means[0][i][p] * field;
                  slope += changes[0][i][p] * field;
                }
              value += means[1][j][p] * row;
              along_x += means[1][j][p] * slope;
              along_y += changes[1][j][p] * row;
            }
          if constexpr (dim == 2)
            {
              u         = value;
              change[0] = along_x;
              change[1] = along_y;
            }
          else
            {
              const double share = means[2][k][p];
              u += share * value;
              change[0] += share * along_x;
              change[1] += share * along_y;
              change[2] += changes[2][k][p] * value;
            }
        }
    }

    /** The transpose: add @p alike and, with changes, @p along to the nodes. */
    template <class Window, bool has_alike, bool has_along>
    __attribute__((always_inline)) void
    give(const Block                                   &block,
         double *const                                  nodes,
         const int                                      p,
         const typename Window::Lanes                  &alike,
         const std::array<typename Window::Lanes, dim> &along) const
    {
      using Record = typename Window::Lanes;
#pragma GCC unroll 3
      for (int k = 0; k < Block::n_nodes / 9; ++k)
        {
          if (dim == 3 && block.ends_before(p, dim - 1, k))
            continue;
          Record value{}, along_x{}, along_y{};
          if constexpr (has_alike)
            value = alike;
          if constexpr (has_along)
            {
              along_x = along[0];
              along_y = along[1];
            }
          if constexpr (dim == 3)
            {
              const double share = means[2][k][p];
              if constexpr (has_alike)
                value *= share;
              if constexpr (has_along)
                {
                  value += changes[2][k][p] * along[2];
                  along_x *= share;
                  along_y *= share;
                }
            }
#pragma GCC unroll 3
          for (int j = 0; j < 3; ++j)
            {
              if (block.ends_before(p, 1, j))
                continue;
              Record row = means[1][j][p] * value, slope{};
              if constexpr (has_along)
                {
                  row += changes[1][j][p] * along_y;
                  slope = means[1][j][p] * along_x;
                }
#pragma GCC unroll 3
              for (int i = 0; i < 3; ++i)
                {
                  double *const slots =
                    nodes + block.record(p, 9 * k + 3 * j + i) + Window::start;
                  Record sum = load<Record>(slots);
                  sum += means[0][i][p] * row;
                  if constexpr (has_along)
                    sum += changes[0][i][p] * slope;
                  store(sum, slots);
                }
            }
        }
    }

  private:
    alignas(64) double means[dim][3][Block::n_points];
    alignas(64) double changes[dim][3][Block::n_points];
  };
} // namespace limber

#endif
