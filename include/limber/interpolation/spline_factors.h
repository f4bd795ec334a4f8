// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_spline_factors_h
#define limber_interpolation_spline_factors_h

#include <array>

namespace limber
{
  /**
   * The B-splines of degree p along one direction of a cell, whose faces are
   * knots: p + 1 functions of the natural coordinate xi, eta = 1 - xi. The
   * first is l eta^p and the last u xi^p; l and u are 1/p!, except in cells at
   * a side of the grid (SplineCell). There the function of a node beyond the
   * side is eliminated by the nodal value 2 v_side - v_inside, so that the node
   * in the side alone has a function that does not vanish in it, and linear
   * fields are reproduced with nodes at the places().
   *
   * Functions of polynomials a_0 + a_1 xi + ... + a_p xi^p accept any callable
   * a(k).
   */
  template <int degree>
  struct SplineFactors;



  /**
   * Quadratic splines, centred in cells: with l = u = 1/2
   *
   *   N_0 = eta^2 / 2,  N_1 = 1/2 + xi eta,  N_2 = xi^2 / 2,
   *
   * and l = 1 at a side of the grid: open knots, with a node in the side itself
   * instead of one beyond, half a cell from the next.
   */
  template <>
  struct SplineFactors<2>
  {
    static constexpr int n = 3;

    template <class Number>
    struct Weights
    {
      std::array<Number, n> value, slope;
    };

    template <class Number>
    __attribute__((always_inline)) static Weights<Number>
    weights(const double l, const double u, const Number &xi)
    {
      const Number eta = 1. - xi;
      return {{{l * (eta * eta),
                (l + u) * (xi * eta) + (1 - l) * eta + (1 - u) * xi,
                u * (xi * xi)}},
              {{-2 * l * eta, (l + u) * (eta - xi) + (l - u), 2 * u * xi}}};
    }

    /** Positions of the nodes, in natural coordinates. */
    static std::array<double, n>
    places(const double l, const double u)
    {
      return {{l - 1, 0.5, 2 - u}};
    }

    /** From nodal values, @p stride apart, to coefficients, in place. */
    template <class Number>
    __attribute__((always_inline)) static void
    to_monomials(const double  l,
                 const double  u,
                 Number *const a,
                 const int     stride)
    {
      Number      &a0 = a[0], &a1 = a[stride], &a2 = a[2 * stride];
      const Number lower = l * (a0 - a1);
      const Number upper = u * (a2 - a1);
      a0                 = a1 + lower;
      a1                 = -2. * lower;
      a2                 = lower + upper;
    }

    /** The transpose. */
    template <class Number>
    __attribute__((always_inline)) static void
    to_nodes(const double l, const double u, Number *const a, const int stride)
    {
      Number      &a0 = a[0], &a1 = a[stride], &a2 = a[2 * stride];
      const Number all   = a0;
      const Number lower = l * (a0 - 2. * a1 + a2);
      const Number upper = u * a2;
      a0                 = lower;
      a1                 = all - lower - upper;
      a2                 = upper;
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static Number
    value(const Coefficients &a, const Number &xi)
    {
      return a(0) + xi * (a(1) + xi * a(2));
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static Number
    slope(const Coefficients &a, const Number &xi)
    {
      return a(1) + (2. * xi) * a(2);
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static std::array<Number, 2>
    value_and_slope(const Coefficients &a, const Number &xi)
    {
      const Number top = xi * a(2);
      return {{a(0) + xi * (a(1) + top), a(1) + 2. * top}};
    }
  };



  /**
   * Cubic splines, centred at corners of cells: linear functions plus l eta^3
   * and u xi^3 times the second difference of the nodal values at either end,
   *
   *   N_0 = l eta^3,                     N_1 = eta - 2 l eta^3 + u xi^3,
   *   N_2 = xi + l eta^3 - 2 u xi^3,     N_3 = u xi^3,
   *
   * l = u = 1/6. At a side of the grid l = 0: there is no node beyond, and the
   * second derivative vanishes in the side, as for the velocity normal to a
   * mirror plane.
   */
  template <>
  struct SplineFactors<3>
  {
    static constexpr int n = 4;

    template <class Number>
    struct Weights
    {
      std::array<Number, n> value, slope;
    };

    template <class Number>
    __attribute__((always_inline)) static Weights<Number>
    weights(const double l, const double u, const Number &xi)
    {
      const Number eta         = 1. - xi;
      const Number lower_slope = l * (eta * eta), upper_slope = u * (xi * xi);
      const Number lower = lower_slope * eta, upper = upper_slope * xi;
      return {
        {{lower, eta - 2. * lower + upper, xi + lower - 2. * upper, upper}},
        {{-3. * lower_slope,
          6. * lower_slope + 3. * upper_slope - 1.,
          1. - 3. * lower_slope - 6. * upper_slope,
          3. * upper_slope}}};
    }

    static std::array<double, n>
    places(double, double)
    {
      return {{-1, 0, 1, 2}};
    }

    template <class Number>
    __attribute__((always_inline)) static void
    to_monomials(const double  l,
                 const double  u,
                 Number *const a,
                 const int     stride)
    {
      Number &a0 = a[0], &a1 = a[stride], &a2 = a[2 * stride],
             &a3         = a[3 * stride];
      const Number step  = a2 - a1;
      const Number lower = l * (a0 - a1 + step);
      const Number upper = u * (a3 - a2 - step);
      a0                 = a1 + lower;
      a1                 = step - 3. * lower;
      a2                 = 3. * lower;
      a3                 = upper - lower;
    }

    template <class Number>
    __attribute__((always_inline)) static void
    to_nodes(const double l, const double u, Number *const a, const int stride)
    {
      Number &a0 = a[0], &a1 = a[stride], &a2 = a[2 * stride],
             &a3         = a[3 * stride];
      const Number lower = l * (a0 + 3. * (a2 - a1) - a3);
      const Number upper = u * a3;
      const Number step  = a1;
      a1                 = a0 - step - 2. * lower + upper;
      a2                 = step + lower - 2. * upper;
      a0                 = lower;
      a3                 = upper;
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static Number
    value(const Coefficients &a, const Number &xi)
    {
      return a(0) + xi * (a(1) + xi * (a(2) + xi * a(3)));
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static Number
    slope(const Coefficients &a, const Number &xi)
    {
      return a(1) + xi * (2. * a(2) + xi * (3. * a(3)));
    }

    template <class Number, class Coefficients>
    __attribute__((always_inline)) static std::array<Number, 2>
    value_and_slope(const Coefficients &a, const Number &xi)
    {
      const Number inner = a(2) + xi * a(3), outer = a(1) + xi * inner;
      return {{a(0) + xi * outer, outer + xi * (inner + xi * a(3))}};
    }
  };
} // namespace limber

#endif
