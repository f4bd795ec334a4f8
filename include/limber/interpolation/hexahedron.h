// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_hexahedron_h
#define limber_interpolation_hexahedron_h

#include <limber/base/small_matrix.h>
#include <limber/points/point_view.h>

namespace limber
{
  /**
   * A quadrilateral or hexahedron (Q1), the image of the square or cube
   * [-1, 1]^d under the bilinear or trilinear map
   *
   *   x = x_0 + sum_k r_k xi_k + sum_t h_t prod_{k in t} xi_k,
   *
   * with the half edges r_k and the twists h_t for the products of different
   * natural coordinates: xi eta in two dimensions; eta zeta, zeta xi, xi eta
   * and xi eta zeta in three. In m; numbers are doubles or packs of them.
   *
   * CPDI2 (Sadeghirad, Brannon and Guilkey, IJNME 95 (2013) 928-952) needs the
   * means over it of the Q1 functions M_c of its corners and their gradients:
   *
   *   share_c = (1/V) int M_c dV,   slope_c = (1/V) int grad M_c dV.
   *
   * Both integrands are of third degree at most along each direction, so that
   * two Gauss points along each are exact: in two dimensions these are the
   * closed formulas of the paper, in three slope_c V is the B of Flanagan and
   * Belytschko (IJNME 17 (1981) 679-706). As share_c is a sum of M_c J over
   * these points, none is negative if J is positive at all of them.
   */
  template <int dim, class Number>
  struct Hexahedron
  {
    static constexpr int n_corners = 1 << dim;
    static constexpr int n_twists  = limber::n_twists(dim);

    SmallMatrix<dim, Number>                       edges;   // columns r_k
    std::array<std::array<Number, dim>, n_twists>  twists;  // rows h_t
    std::array<std::array<Number, dim>, n_corners> offsets; // of corners
    std::array<Number, n_corners>                  shares;
    std::array<std::array<Number, n_corners>, dim> along; // slope_c . r_k
    Number smallest; // smallest determinant at Gauss points, m^d
    Number volume;   // m^d

    /** +1 or -1: at which end of edge k the corner is. */
    static constexpr double
    sign(const int corner, const int k)
    {
      return corner >> k & 1 ? 1. : -1.;
    }

    /** From corner positions, relative to any origin, m. Returns x_0. */
    std::array<Number, dim>
    set_corners(const std::array<std::array<Number, dim>, n_corners> &corners)
    {
      std::array<Number, dim> middle;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          AtCorners x;
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            x[c] = (1. / n_corners) * corners[c][d];
          for_pairs(
            [](Number & lower, Number & upper) __attribute__((always_inline)) {
              const Number sum = lower + upper;
              upper            = upper - lower;
              lower            = sum;
            },
            x);
          middle[d] = x[0];
          for (int k = 0; k < dim; ++k)
            edges[d][k] = x[1 << k];
          for (int t = 0; t < n_twists; ++t)
            twists[t][d] = x[factors_of_twist(t)];
        }
      return middle;
    }

    /**
     * Compute everything else from edges and twists; offsets are from the
     * centroid. Returns the centroid relative to x_0, m.
     */
    __attribute__((always_inline)) std::array<Number, dim>
    integrate()
    {
      const GaussPoints at(*this);
      AtCorners         slopes[dim]; // along each edge and d, summed over edges
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        slopes[d].fill(Number{});
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 3
        for (int d = 0; d < dim; ++d)
          {
            AtCorners flux;
#pragma GCC unroll 8
            for (int q = 0; q < n_corners; ++q)
              flux[q] = at.normal(q, k, d);
            to_corners(flux, k);
#pragma GCC unroll 8
            for (int c = 0; c < n_corners; ++c)
              slopes[d][c] += (0.5 * sign(c, k)) * flux[c];
          }
      shares = at.determinant;
      to_corners(shares, -1);
      volume   = at.volume();
      smallest = at.smallest();

      const Number            one = 1. / volume;
      std::array<Number, dim> centroid;
#pragma GCC unroll 8
      for (int c = 0; c < n_corners; ++c)
        {
          shares[c] *= one;
#pragma GCC unroll 3
          for (int k = 0; k < dim; ++k)
            {
              Number sum = slopes[0][c] * edges[0][k];
#pragma GCC unroll 3
              for (int d = 1; d < dim; ++d)
                sum += slopes[d][c] * edges[d][k];
              along[k][c] = one * sum;
            }
        }
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          const AtCorners x = places(d, 1.);
          centroid[d]       = Number{};
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            centroid[d] += shares[c] * x[c];
#pragma GCC unroll 8
          for (int c = 0; c < n_corners; ++c)
            offsets[c][d] = x[c] - centroid[d];
        }
      return centroid;
    }

    /**
     * The centroid relative to x_0, volume and smallest determinant, from edges
     * and twists.
     */
    std::array<Number, dim>
    find_centroid()
    {
      const GaussPoints at(*this);
      volume           = at.volume();
      smallest         = at.smallest();
      const Number one = 1. / volume;

      std::array<Number, dim> result;
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
        {
          const AtCorners x = places(d, gauss);
          result[d]         = Number{};
#pragma GCC unroll 8
          for (int q = 0; q < n_corners; ++q)
            result[d] += at.determinant[q] * x[q];
          result[d] *= one;
        }
      return result;
    }

  private:
    // By corner, or by Gauss point (each next to a corner), or by product of
    // natural coordinates, with a bit for each factor
    using AtCorners = std::array<Number, n_corners>;

    static constexpr double gauss = 0.57735026918962576451; // 1 / sqrt(3)

    /** The natural coordinates in the product of twist t, as bits. */
    static constexpr int
    factors_of_twist(const int t)
    {
      constexpr int all = n_corners - 1;
      return dim == 2 || t == 3 ? all : all ^ 1 << t;
    }

    /**
     * Call work(lower, upper) for the ends of all edges, direction by direction
     * (butterfly).
     */
    template <class Work>
    __attribute__((always_inline)) static void
    for_pairs(const Work &work, AtCorners &values)
    {
#pragma GCC unroll 3
      for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
        for (int c = 0; c < n_corners; ++c)
          if (!(c >> k & 1))
            work(values[c], values[c | 1 << k]);
    }

    /**
     * Component d of x - x_0 at the points with all natural coordinates + or -
     * @p reach.
     */
    __attribute__((always_inline)) AtCorners
    places(const int d, const double reach) const
    {
      AtCorners x;
      x[0] = Number{};
      for (int k = 0; k < dim; ++k)
        x[1 << k] = reach * edges[d][k];
      for (int t = 0; t < n_twists; ++t)
        x[factors_of_twist(t)] =
          (t == 3 ? reach * reach * reach : reach * reach) * twists[t][d];
      for_pairs(
        [](Number & lower, Number & upper) __attribute__((always_inline)) {
          const Number mean = lower, change = upper;
          lower = mean - change;
          upper = mean + change;
        },
        x);
      return x;
    }

    /**
     * sum_q M_c(q) f_q from f at the Gauss points, in place; if @p k is a
     * direction, without the factor of M_c along it.
     */
    __attribute__((always_inline)) static void
    to_corners(AtCorners &f, const int k)
    {
      constexpr double near = 0.5 * (1 + gauss), far = 0.5 * (1 - gauss);
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 8
        for (int c = 0; c < n_corners; ++c)
          if (!(c >> d & 1))
            {
              Number &lower = f[c], &upper = f[c | 1 << d];
              if (d == k)
                upper = lower = lower + upper;
              else
                {
                  const Number first = lower;
                  lower              = near * first + far * upper;
                  upper              = far * first + near * upper;
                }
            }
    }

    /** The Jacobian of the map at the Gauss points. */
    struct GaussPoints
    {
      __attribute__((always_inline)) GaussPoints(const Hexahedron &shape)
      {
#pragma GCC unroll 3
        for (int k = 0; k < dim; ++k)
#pragma GCC unroll 8
          for (int q = 0; q < n_corners; ++q)
            if (!(q >> k & 1))
#pragma GCC unroll 3
              for (int d = 0; d < dim; ++d)
                column[k][q][d] = shape.slope(q, k, d);
#pragma GCC unroll 8
        for (int q = 0; q < n_corners; ++q)
          {
            determinant[q] = derivative(q, 0, 0) * normal(q, 0, 0);
#pragma GCC unroll 3
            for (int d = 1; d < dim; ++d)
              determinant[q] += derivative(q, 0, d) * normal(q, 0, d);
          }
      }

      /** dx_d / dxi_k, which does not depend on xi_k. */
      const Number &
      derivative(const int q, const int k, const int d) const
      {
        return column[k][q & ~(1 << k)][d];
      }

      /** Entry (d, k) of the cofactor matrix of the Jacobian. */
      __attribute__((always_inline)) Number
      normal(const int q, const int k, const int d) const
      {
        if constexpr (dim == 2)
          {
            const Number &other = derivative(q, 1 - k, 1 - d);
            return k == d ? other : -other;
          }
        else
          {
            const int l = (k + 1) % 3, m = (k + 2) % 3, e = (d + 1) % 3,
                      f = (d + 2) % 3;
            return derivative(q, l, e) * derivative(q, m, f) -
                   derivative(q, l, f) * derivative(q, m, e);
          }
      }

      Number
      volume() const
      {
        Number result = determinant[0];
        for (int q = 1; q < n_corners; ++q)
          result += determinant[q];
        return result;
      }

      Number
      smallest() const
      {
        Number result = determinant[0];
        for (int q = 1; q < n_corners; ++q)
          result = determinant[q] < result ? determinant[q] : result;
        return result;
      }

      AtCorners determinant; // m^d

    private:
      std::array<std::array<Number, dim>, n_corners> column[dim];
    };

    /** dx_d / dxi_k at Gauss point q. */
    __attribute__((always_inline)) Number
    slope(const int q, const int k, const int d) const
    {
      Number result = edges[d][k];
#pragma GCC unroll 4
      for (int t = 0; t < n_twists; ++t)
        if (factors_of_twist(t) >> k & 1)
          {
            double others = 1;
#pragma GCC unroll 3
            for (int l = 0; l < dim; ++l)
              if (l != k && factors_of_twist(t) >> l & 1)
                others *= sign(q, l) * gauss;
            result += others * twists[t][d];
          }
      return result;
    }
  };
} // namespace limber

#endif
