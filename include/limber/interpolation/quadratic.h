// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_quadratic_h
#define limber_interpolation_quadratic_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

#include <array>

namespace limber
{
  /**
   * Quadratic B-splines, products of one for each direction. Their knots are
   * the faces of the cells, so that a cell has one function of its own, around
   * its centre, and sees those of its neighbours: three in each direction. All
   * points of a cell see the same ones. With xi the natural coordinate and
   * eta = 1 - xi they are
   *
   *   N_0 = eta^2 / 2,  N_1 = 1/2 + xi eta,  N_2 = xi^2 / 2.
   *
   * Where the grid ends the knots are open: the function beyond is one of a
   * node in the side itself, which alone does not vanish there,
   *
   *   N_0 = eta^2,  N_1 = xi/2 + 3/2 xi eta,  N_2 = xi^2 / 2,
   *
   * so that conditions at a side remain conditions on nodes. Nodes lie at the
   * centres of the cells, or in the side (Greville's places), and with these
   * the functions have any linear field exactly. They are positive and their
   * gradient is continuous.
   *
   * (Steffen, Kirby and Berzins 2008; Piegl and Tiller, The NURBS Book, 2.2)
   */
  template <int dimension>
  struct Quadratic
  {
    static constexpr int dim     = dimension;
    static constexpr int n_nodes = dim == 2 ? 9 : 27;

    /** Of the nodes and monomials of a cell: neighbours in direction d. */
    static constexpr int
    stride(const int d)
    {
      return d == 0 ? 1 : (d == 1 ? 3 : 9);
    }

    /** The place of node i, or the power of monomial i, along d: 0, 1, 2. */
    static constexpr int
    power(const int i, const int d)
    {
      return i / stride(d) % 3;
    }

    template <class Grid>
    static const SplineCell<dim> &
    nodes_of(const Grid &grid, const std::uint32_t cell)
    {
      return grid.splines[cell];
    }

    /** Values of the three functions along a direction, and derivatives. */
    template <class Number>
    struct Weights
    {
      std::array<Number, 3> value, slope;
    };

    template <class Number>
    __attribute__((always_inline)) static Weights<Number>
    weights(const SplineCell<dim> &cell, const int d, const Number &xi)
    {
      const double l = cell.lower[d], u = cell.upper[d];
      const Number eta = 1. - xi;
      return {{{l * (eta * eta),
                (l + u) * (xi * eta) + (1 - l) * eta + (1 - u) * xi,
                u * (xi * xi)}},
              {{-2 * l * eta, (l + u) * (eta - xi) + (l - u), 2 * u * xi}}};
    }

    /** Where the three nodes are, in natural coordinates. */
    static std::array<double, 3>
    places(const SplineCell<dim> &cell, const int d)
    {
      return {{cell.lower[d] - 1, 0.5, 2 - cell.upper[d]}};
    }

    /**
     * Turn nodal values into coefficients of the monomials xi^a eta^b zeta^c,
     * in place. Lanes are components.
     */
    template <class Number>
    __attribute__((always_inline)) static void
    to_monomials(std::array<Number, n_nodes> &a, const SplineCell<dim> &cell)
    {
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 27
        for (int i = 0; i < n_nodes; ++i)
          if (power(i, d) == 0)
            {
              Number &a0 = a[i], &a1 = a[i + stride(d)],
                     &a2         = a[i + 2 * stride(d)];
              const Number lower = cell.lower[d] * (a0 - a1);
              const Number upper = cell.upper[d] * (a2 - a1);
              a0                 = a1 + lower;
              a1                 = -2. * lower;
              a2                 = lower + upper;
            }
    }

    /** The transpose: from what acts on coefficients to what acts on nodes. */
    template <class Number>
    __attribute__((always_inline)) static void
    to_nodes(std::array<Number, n_nodes> &a, const SplineCell<dim> &cell)
    {
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 27
        for (int i = 0; i < n_nodes; ++i)
          if (power(i, d) == 0)
            {
              Number &a0 = a[i], &a1 = a[i + stride(d)],
                     &a2         = a[i + 2 * stride(d)];
              const Number all   = a0;
              const Number lower = cell.lower[d] * (a0 - 2. * a1 + a2);
              const Number upper = cell.upper[d] * a2;
              a0                 = lower;
              a1                 = all - lower - upper;
              a2                 = upper;
            }
    }

    /** Value at natural coordinates xi; c(k) is the k-th coefficient. */
    template <class Number, class Coefficient>
    __attribute__((always_inline)) static Number
    value(const Coefficient &c, const std::array<Number, dim> &xi)
    {
      const auto row = [&](const int k) __attribute__((always_inline))
      {
        return c(k) + xi[0] * (c(k + 1) + xi[0] * c(k + 2));
      };
      const auto plane = [&](const int k) __attribute__((always_inline))
      {
        return row(k) + xi[1] * (row(k + 3) + xi[1] * row(k + 6));
      };
      if constexpr (dim == 2)
        return plane(0);
      else
        return plane(0) + xi[2] * (plane(9) + xi[2] * plane(18));
    }

    /** Derivatives with respect to the natural coordinates. */
    template <class Number, class Coefficient>
    __attribute__((always_inline)) static std::array<Number, dim>
    gradient(const Coefficient &c, const std::array<Number, dim> &xi)
    {
      if constexpr (dim == 2)
        return plane_with_slopes(c, xi, 0).slope;
      else
        {
          const auto              a = plane_with_slopes(c, xi, 0);
          const auto              b = plane_with_slopes(c, xi, 9);
          const auto              e = plane_with_slopes(c, xi, 18);
          std::array<Number, dim> result;
          for (int d = 0; d < 2; ++d)
            result[d] = a.slope[d] + xi[2] * (b.slope[d] + xi[2] * e.slope[d]);
          result[2] = b.value + (2. * xi[2]) * e.value;
          return result;
        }
    }

  private:
    template <class Number>
    struct Plane
    {
      Number                value;
      std::array<Number, 2> slope;
    };

    template <class Coefficient, class Number>
    __attribute__((always_inline)) static Plane<Number>
    plane_with_slopes(const Coefficient             &c,
                      const std::array<Number, dim> &xi,
                      const int                      first)
    {
      std::array<Number, 3> row, slope;
#pragma GCC unroll 3
      for (int b = 0; b < 3; ++b)
        {
          const int    k   = first + 3 * b;
          const Number top = xi[0] * c(k + 2);
          row[b]           = c(k) + xi[0] * (c(k + 1) + top);
          slope[b]         = c(k + 1) + 2. * top;
        }
      Plane<Number> result;
      const Number  top = xi[1] * row[2];
      result.value      = row[0] + xi[1] * (row[1] + top);
      result.slope[0]   = slope[0] + xi[1] * (slope[1] + xi[1] * slope[2]);
      result.slope[1]   = row[1] + 2. * top;
      return result;
    }
  };
} // namespace limber

#endif
