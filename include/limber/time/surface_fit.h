// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_surface_fit_h
#define limber_time_surface_fit_h

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>

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
    using Vector = dealii::Tensor<1, dim>;

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
    {
      const double length = guess.norm();
      if (!(length > 0))
        return;
      upwards = guess / length;
      if constexpr (dim == 2)
        {
          axes[0][0] = -upwards[1];
          axes[0][1] = upwards[0];
        }
      else
        {
          int least = 0;
          for (int d = 1; d < dim; ++d)
            if (std::abs(upwards[d]) < std::abs(upwards[least]))
              least = d;
          axes[0][least] = 1;
          axes[0] -= upwards[least] * upwards;
          axes[0] /= axes[0].norm();
          axes[1] = dealii::cross_product_3d(upwards, axes[0]);
        }
    }

    /** The guess, of length 1. */
    const Vector &
    guess() const
    {
      return upwards;
    }

    /**
     * Add a point.
     * @param place  from the node, or any place that is the same for all, m
     * @param reach  from there to where its material ends, m
     * @param weight the function of the node at the point
     */
    void
    add(const Vector &place, const double reach, const double weight)
    {
      const double z = place * upwards + reach;
      // No node sees points a hundred edges away.
      const double w = weight * std::exp(std::clamp(z / edge, -100., 100.));
      sums[0] += w;
      sums[1] += w * z;
      for (int i = 0, k = 2; i < across; ++i)
        {
          const double s = place * axes[i];
          sums[k++] += w * s;
          sums[k++] += w * s * z;
          for (int j = 0; j <= i; ++j)
            sums[k++] += w * s * (place * axes[j]);
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
      const double                                   z = sums[1] / sums[0];
      std::array<double, across>                     s, with_z;
      std::array<std::array<double, across>, across> spread;
      for (int i = 0, k = 2; i < across; ++i)
        {
          s[i]      = sums[k++] / sums[0];
          with_z[i] = sums[k++] / sums[0] - s[i] * z;
          for (int j = 0; j <= i; ++j)
            spread[i][j] = spread[j][i] = sums[k++] / sums[0] - s[i] * s[j];
        }
      Vector       result         = upwards;
      const double least_variance = 0.05 * edge * edge;
      if constexpr (dim == 2)
        {
          if (!(spread[0][0] > least_variance))
            return upwards;
          result -= with_z[0] / spread[0][0] * axes[0];
        }
      else
        {
          const double mean = (spread[0][0] + spread[1][1]) / 2,
                       half = (spread[0][0] - spread[1][1]) / 2,
                       root = std::hypot(half, spread[0][1]);
          if (!(mean - root > least_variance))
            return upwards;
          const double determinant = (mean - root) * (mean + root);
          for (int i = 0; i < 2; ++i)
            result -= (spread[1 - i][1 - i] * with_z[i] -
                       spread[0][1] * with_z[1 - i]) /
                      determinant * axes[i];
        }
      return result / result.norm();
    }

  private:
    double                     edge;
    Vector                     upwards;
    std::array<Vector, across> axes{}; // across, normal to each other
  };
} // namespace limber

#endif
