// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_surface_fit_h
#define limber_transfer_surface_fit_h

#include <limber/base/pack.h>

namespace limber
{
  /**
   * Least-squares fit of the plane of a body's surface near a node: z = c +
   * beta . s, with z the height along a guess of the normal and s the place
   * across it, through the places where the material of the points ends. Rows
   * of points oblique to the grid end in a flight of stairs, but each point
   * there knows how far from the surface it is: of a plane the fit is exact.
   *
   * Points count by the function of the node, and the less the lower they are,
   * by exp(z / edge): these belong to other faces of the body.
   */
  template <int dim>
  class SurfaceFit
  {
  public:
    using Vector = std::array<double, dim>;

    static constexpr int across = dim - 1;

    /** Number of weighted sums: of 1, z, s, s z and s s^T. */
    static constexpr int n = 2 + 2 * across + across * dim / 2;

    /** Over the points, with their weights. */
    std::array<double, n> sums{};

    /**
     * @param guess along the normal out of the body, of any length; if it is 0,
     *              so is the normal
     * @param edge  of what a point stands for, m
     */
    SurfaceFit(const Vector &guess, const double edge)
      : edge(edge)
      , inverse_edge(1 / edge)
      , upwards(unit(guess))
    {
      if constexpr (dim == 2)
        axes[0] = {{-upwards[1], upwards[0]}};
      else
        {
          int least = 0;
          for (int d = 1; d < dim; ++d)
            if (std::abs(upwards[d]) < std::abs(upwards[least]))
              least = d;
          Vector first{};
          first[least] = 1;
          for (int d = 0; d < dim; ++d)
            first[d] -= upwards[least] * upwards[d];
          axes[0] = unit(first);
          for (int d = 0; d < dim; ++d)
            {
              const int e = (d + 1) % dim, f = (d + 2) % dim;
              axes[1][d] = upwards[e] * axes[0][f] - upwards[f] * axes[0][e];
            }
        }
    }

    /** The guess, of length 1. */
    const Vector &
    guess() const
    {
      return upwards;
    }

    /**
     * Add a point, or a pack of points.
     * @param place  from the node, or any place that is the same for all, m
     * @param reach  from there to where its material ends, m
     * @param weight the function of the node at the point
     */
    template <class Number>
    __attribute__((always_inline)) void
    add(const std::array<Number, dim> &place,
        const Number                  &reach,
        const Number                  &weight)
    {
      const Number          z = along(upwards, place) + reach;
      const Number          w = weight * exponential<Number>(z * inverse_edge);
      std::array<Number, n> all;
      all[0] = w;
      all[1] = w * z;
      std::array<Number, across> s;
      for (int i = 0, k = 2; i < across; ++i)
        {
          s[i]             = along(axes[i], place);
          const Number w_s = w * s[i];
          all[k++]         = w_s;
          all[k++]         = w_s * z;
          for (int j = 0; j <= i; ++j)
            all[k++] = w_s * s[j];
        }
      if constexpr (pack_width<Number> == 1)
        for (int k = 0; k < n; ++k)
          sums[k] += all[k];
      else
        {
          const auto of_pack = all_sums(all);
          for (int k = 0; k < n; ++k)
            sums[k] += of_pack[k];
        }
    }

    /** Normal of the plane, of length 1; the guess if the points are too few
     * for one: in some direction they cover less than about an edge. */
    Vector
    normal() const
    {
      if (!(sums[0] > 0))
        return upwards;
      // means, covariances and variances
      const double               inverse = 1 / sums[0], z = inverse * sums[1];
      std::array<double, across> s, with_z;
      std::array<std::array<double, across>, across> spread;
      for (int i = 0, k = 2; i < across; ++i)
        {
          s[i]      = inverse * sums[k++];
          with_z[i] = inverse * sums[k++] - s[i] * z;
          for (int j = 0; j <= i; ++j)
            spread[i][j] = spread[j][i] = inverse * sums[k++] - s[i] * s[j];
        }
      std::array<double, across> beta;
      const double               least_variance = 0.05 * edge * edge;
      if constexpr (dim == 2)
        {
          if (!(spread[0][0] > least_variance))
            return upwards;
          beta[0] = with_z[0] / spread[0][0];
        }
      else
        {
          const double mean = (spread[0][0] + spread[1][1]) / 2,
                       half = (spread[0][0] - spread[1][1]) / 2,
                       root =
                         std::sqrt(half * half + spread[0][1] * spread[0][1]);
          if (!(mean - root > least_variance))
            return upwards;
          const double determinant = (mean - root) * (mean + root);
          for (int i = 0; i < 2; ++i)
            beta[i] = (spread[1 - i][1 - i] * with_z[i] -
                       spread[0][1] * with_z[1 - i]) /
                      determinant;
        }
      Vector result = upwards;
      for (int i = 0; i < across; ++i)
        for (int d = 0; d < dim; ++d)
          result[d] -= beta[i] * axes[i][d];
      return unit(result);
    }

  private:
    template <class Number>
    __attribute__((always_inline)) static Number
    along(const Vector &direction, const std::array<Number, dim> &place)
    {
      Number result = direction[0] * place[0];
      for (int d = 1; d < dim; ++d)
        result += direction[d] * place[d];
      return result;
    }

    /** Of length 1; zero remains zero. */
    static Vector
    unit(Vector vector)
    {
      const double square  = along(vector, vector);
      const double inverse = square > 0 ? 1 / std::sqrt(square) : 0;
      for (double &component : vector)
        component *= inverse;
      return vector;
    }

    double                     edge, inverse_edge;
    Vector                     upwards;
    std::array<Vector, across> axes{}; // across, normal to each other
  };
} // namespace limber

#endif
