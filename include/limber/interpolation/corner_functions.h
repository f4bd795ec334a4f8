// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_corner_functions_h
#define limber_interpolation_corner_functions_h

#include <limber/interpolation/block_nodes.h>
#include <limber/interpolation/domain_shape.h>

namespace limber
{
  /**
   * The functions of the nodes of blocks on domains that see them at their
   * corners (CPDI, CPDI2; convected.h), points as lanes.
   */
  template <int dim>
  class CornerFunctions
  {
  public:
    using Block                    = BlockNodes<dim>;
    using Number                   = typename Block::Number;
    using Vector                   = typename Block::Vector;
    static constexpr int n_points  = Block::n_points;
    static constexpr int n_nodes   = Block::n_nodes;
    static constexpr int n_corners = 1 << dim;

    /** On parallelepipeds around @p at with the half @p edges; in the block, in
     * cells. */
    __attribute__((always_inline)) void
    set(const Vector &at, const SmallMatrix<dim, Number> &edges)
    {
      for_functions(
        [&](const int c, const int d) __attribute__((always_inline)) {
          Number x = at[d];
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            x += DomainShape<dim>::sign(c, k) * edges[d][k];
          return x;
        },
        1. / n_corners,
        [&](const int i, Number(&values)[n_corners])
          __attribute__((always_inline)) { set_function(i, values); });
      read_functions_from_memory();
    }

    /** On hexahedra with the centroids @p at; in the block, in cells. */
    __attribute__((always_inline)) void
    set(const Vector &at, const Hexahedron<dim, Number> &shape)
    {
      for (int c = 0; c < n_corners; ++c)
        for (int d = 0; d < dim; ++d)
          store(at[d] + shape.offsets[c][d], corners[c][d]);
      for_functions(
        [&](const int c, const int d) __attribute__((always_inline)) {
          return at[d] + shape.offsets[c][d];
        },
        1.,
        [&](const int i, const Number(&values)[n_corners])
          __attribute__((always_inline)) {
            Number sum = shape.shares[0] * values[0];
#pragma GCC unroll 8
            for (int c = 1; c < n_corners; ++c)
              sum += shape.shares[c] * values[c];
            store(sum, mean[i]);
#pragma GCC unroll 3
            for (int k = 0; k < dim; ++k)
              {
                sum = shape.along[k][0] * values[0];
#pragma GCC unroll 8
                for (int c = 1; c < n_corners; ++c)
                  sum += shape.along[k][c] * values[c];
                store(sum, along[k][i]);
              }
          });
      read_functions_from_memory();
    }

    /** Where in the block corner c of hexahedra is along d, in cells. */
    Number
    corner(const int c, const int d) const
    {
      return load<Number>(corners[c][d]);
    }

    /** u of fields in the slots of the window at point p, and their u,k. */
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
      block.for_nodes(
        p,
        [&](const int i, const std::uint32_t record)
          __attribute__((always_inline)) {
            const auto value = load<Record>(nodes + record + Window::start);
            u += mean[i][p] * value;
#pragma GCC unroll 3
            for (int k = 0; k < dim; ++k)
              change[k] += along[k][i][p] * value;
          });
    }

    /** The transpose: add @p alike and, with changes, @p differing to the
     * nodes. */
    template <class Window, bool has_alike, bool has_along>
    __attribute__((always_inline)) void
    give(const Block                                   &block,
         double *const                                  nodes,
         const int                                      p,
         const typename Window::Lanes                  &alike,
         const std::array<typename Window::Lanes, dim> &differing) const
    {
      using Record = typename Window::Lanes;
      block.for_nodes(
        p,
        [&](const int i, const std::uint32_t record)
          __attribute__((always_inline)) {
            double *const slots = nodes + record + Window::start;
            Record        sum   = load<Record>(slots);
            if constexpr (has_alike)
              sum += mean[i][p] * alike;
            if constexpr (has_along)
#pragma GCC unroll 3
              for (int k = 0; k < dim; ++k)
                sum += along[k][i][p] * differing[k];
            store(sum, slots);
          });
    }

    /**
     * The values at the corners of hexahedra of the vector field in the slots
     * from @p slot on of the first @p n points; zero in the other lanes.
     */
    std::array<Vector, n_corners>
    at_corners(const Block        &block,
               const double *const nodes,
               const int           n,
               const unsigned int  slot) const
    {
      alignas(64) double of_nodes[n_nodes][dim][n_points] = {};
      for (int p = 0; p < n; ++p)
        block.for_nodes(
          p,
          [&](const int i, const std::uint32_t record)
            __attribute__((always_inline)) {
              for (int d = 0; d < dim; ++d)
                of_nodes[i][d][p] = nodes[record + slot + d];
            });
      std::array<Vector, n_corners> result;
      for (auto &values : result)
        set_zero(values);
      for_functions(
        [&](const int c, const int d)
          __attribute__((always_inline)) { return corner(c, d); },
        1.,
        [&](const int i, const Number(&values)[n_corners])
          __attribute__((always_inline)) {
            for (int d = 0; d < dim; ++d)
              {
                const Number value = load<Number>(of_nodes[i][d]);
#pragma GCC unroll 8
                for (int c = 0; c < n_corners; ++c)
                  result[c][d] += values[c] * value;
              }
          });
      return result;
    }

  private:
    /**
     * The functions of the nodes of a block at a corner are products of
     * 1 - x, 1 - |x - 1| and x - 1, or zero, for each direction; a corner
     * beyond a side counts in it. Corner c is at @p place(c, d) along d, and
     * @p work(i, values) takes the functions of node i at all corners, times
     * @p share.
     */
    template <class Place, class Work>
    __attribute__((always_inline)) static void
    for_functions(const Place &place, const double share, const Work &work)
    {
      Number factors[n_corners][dim][3];
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            const Number x     = place(c, d);
            const Number lower = clamped(1. - x), upper = clamped(x - 1.);
            const double whole = d == 0 ? share : 1.;
            factors[c][d][0]   = whole * lower;
            factors[c][d][1]   = whole * (1. - lower - upper);
            factors[c][d][2]   = whole * upper;
          }
#pragma GCC unroll 9
      for (int row = 0; row < n_nodes / 3; ++row)
        {
          Number others[n_corners];
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            {
              others[c] = factors[c][1][row % 3];
              if constexpr (dim == 3)
                others[c] *= factors[c][2][row / 3];
            }
#pragma GCC unroll 3
          for (int i = 0; i < 3; ++i)
            {
              Number values[n_corners];
#pragma GCC unroll 8
              for (int c = 0; c < n_corners; ++c)
                values[c] = factors[c][0][i] * others[c];
              work(3 * row + i, values);
            }
        }
    }

    static Number
    clamped(const Number &x)
    {
      const Number positive = x > 0. ? x : Number{};
      return positive < 1. ? positive : broadcast<Number>(1.);
    }

    /** Sums over the corners, with signs along one edge after the other. */
    __attribute__((always_inline)) void
    set_function(const int i, Number (&values)[n_corners])
    {
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
        {
          const int n_pairs = n_corners >> (k + 1);
          Number    change{};
#pragma GCC unroll 4
          for (int c = 0; c < n_pairs; ++c)
            {
              const Number first = values[2 * c], second = values[2 * c + 1];
              change    = c == 0 ? second - first : change + (second - first);
              values[c] = first + second;
            }
          store(change, along[k][i]);
        }
      store(values[0], mean[i]);
    }

    /**
     * Else GCC takes every weight out of a register by shuffles, where a load
     * spreads it over the lanes for nothing.
     */
    __attribute__((always_inline)) void
    read_functions_from_memory()
    {
      __asm__("" : "+m"(mean), "+m"(along));
    }

    // sum_c share_c N_i(x_c) and sum_c (slope_c . r_k) N_i(x_c), of
    // parallelepipeds 2^-d sum_c N_i(x_c) and 2^-d sum_c s_ck N_i(x_c)
    alignas(64) double mean[n_nodes][n_points];
    alignas(64) double along[dim][n_nodes][n_points];
    alignas(64) double corners[n_corners][dim][n_points]; // of hexahedra only
  };
} // namespace limber

#endif
