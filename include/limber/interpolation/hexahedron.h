// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_hexahedron_h
#define limber_interpolation_hexahedron_h

#include <limber/base/small_matrix.h>
#include <limber/points/point_view.h>

#include <limits>

namespace limber
{
  /**
   * A quadrilateral or hexahedron, the image of the square or cube [-1, 1]^d
   * under a map that is linear in each direction,
   *
   *   x = x_0 + sum_k r_k xi_k + sum_t h_t prod_{k in t} xi_k,
   *
   * with the half edges r_k and the twists h_t for the products of different
   * natural coordinates: xi eta in two dimensions; eta zeta, zeta xi, xi eta
   * and xi eta zeta in three. In m; numbers are doubles or packs of them.
   *
   * CPDI2 (Sadeghirad, Brannon and Guilkey, IJNME 95 (2013) 928-952) takes the
   * means over it of what the M_c, linear in each direction, interpolate
   * between its corners:
   *
   *   share_c = (1/V) int M_c dV,   slope_c = (1/V) int grad M_c dV.
   *
   * Both integrands are of third degree at most along each direction, so that
   * two Gauss points along each are exact: in two dimensions these are the
   * closed formulas of the paper, in three slope_c V is the B of Flanagan and
   * Belytschko (IJNME 17 (1981) 679-706). As share_c is a sum of M_c J
   * there, none is negative where the map is not inside out at these points.
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
    Number smallest; // determinant of the map at the Gauss points, m^d
    Number volume;   // m^d

    /** Whether twist t has the coordinate k. */
    static constexpr bool
    has_factor(const int t, const int k)
    {
      return dim == 2 || t == 3 || t != k;
    }

    /** +1 or -1: at which end of edge k the corner is. */
    static constexpr double
    sign(const int corner, const int k)
    {
      return corner >> k & 1 ? 1. : -1.;
    }

    /** The product of twist t at a corner. */
    static constexpr double
    twist_sign(const int corner, const int t)
    {
      double result = 1;
      for (int k = 0; k < dim; ++k)
        if (has_factor(t, k))
          result *= sign(corner, k);
      return result;
    }

    /** From corners, counted from anywhere, m. Returns x_0. */
    std::array<Number, dim>
    set_corners(const std::array<std::array<Number, dim>, n_corners> &corners)
    {
      constexpr double        one = 1. / n_corners;
      std::array<Number, dim> middle;
      for (int d = 0; d < dim; ++d)
        {
          const auto sum = [&](const auto &weight) {
            Number result{};
            for (int c = 0; c < n_corners; ++c)
              result += (one * weight(c)) * corners[c][d];
            return result;
          };
          middle[d] = sum([](int) { return 1.; });
          for (int k = 0; k < dim; ++k)
            edges[d][k] = sum([k](const int c) { return sign(c, k); });
          for (int t = 0; t < n_twists; ++t)
            twists[t][d] = sum([t](const int c) { return twist_sign(c, t); });
        }
      return middle;
    }

    /**
     * From edges and twists all the rest; offsets are from the centroid.
     * Returns where this is from x_0, m.
     */
    std::array<Number, dim>
    integrate()
    {
      std::array<std::array<Number, dim>, n_corners> slopes;
      volume   = Number{};
      smallest = Number{} + std::numeric_limits<double>::max();
      for (int c = 0; c < n_corners; ++c)
        {
          shares[c] = Number{};
          for (int d = 0; d < dim; ++d)
            slopes[c][d] = Number{};
        }
      for (int q = 0; q < n_corners; ++q)
        {
          const auto   map = gradient_at(q);
          const auto   cof = cofactor<dim>(map);
          const Number J   = determinant<dim>(map);
          volume += J;
          smallest = J < smallest ? J : smallest;
          for (int c = 0; c < n_corners; ++c)
            {
              shares[c] += interpolation(c, q, -1) * J;
              for (int k = 0; k < dim; ++k)
                {
                  const double change = interpolation(c, q, k);
                  for (int d = 0; d < dim; ++d)
                    slopes[c][d] += change * cof[d][k];
                }
            }
        }
      const Number            one = 1. / volume;
      std::array<Number, dim> centroid;
      for (int d = 0; d < dim; ++d)
        centroid[d] = Number{};
      for (int c = 0; c < n_corners; ++c)
        {
          shares[c] *= one;
          for (int k = 0; k < dim; ++k)
            {
              along[k][c] = Number{};
              for (int d = 0; d < dim; ++d)
                along[k][c] += one * slopes[c][d] * edges[d][k];
            }
          for (int d = 0; d < dim; ++d)
            {
              Number x{};
              for (int k = 0; k < dim; ++k)
                x += sign(c, k) * edges[d][k];
              for (int t = 0; t < n_twists; ++t)
                x += twist_sign(c, t) * twists[t][d];
              offsets[c][d] = x;
              centroid[d] += shares[c] * x;
            }
        }
      for (int c = 0; c < n_corners; ++c)
        for (int d = 0; d < dim; ++d)
          offsets[c][d] -= centroid[d];
      return centroid;
    }

  private:
    static constexpr double gauss = 0.57735026918962576451; // 1 / sqrt(3)

    /** M_c at Gauss point q, or its derivative along xi_k. */
    static constexpr double
    interpolation(const int c, const int q, const int k)
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result *= d == k ? 0.5 * sign(c, d) :
                           0.5 * (1 + sign(c, d) * sign(q, d) * gauss);
      return result;
    }

    /** Derivatives of the map at Gauss point q, columns. */
    SmallMatrix<dim, Number>
    gradient_at(const int q) const
    {
      SmallMatrix<dim, Number> result = edges;
      for (int t = 0; t < n_twists; ++t)
        for (int k = 0; k < dim; ++k)
          if (has_factor(t, k))
            {
              double others = 1;
              for (int l = 0; l < dim; ++l)
                if (l != k && has_factor(t, l))
                  others *= sign(q, l) * gauss;
              for (int d = 0; d < dim; ++d)
                result[d][k] += others * twists[t][d];
            }
      return result;
    }
  };
} // namespace limber

#endif
