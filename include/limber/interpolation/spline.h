// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_spline_h
#define limber_interpolation_spline_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>
#include <limber/interpolation/spline_factors.h>

namespace limber
{
  /**
   * Tensor product B-splines (spline_factors.h). Their knots are the faces of
   * the cells, so that a cell sees functions of neighbouring nodes: degree + 1
   * in each direction, the same for all points of a cell. They are positive,
   * reproduce linear fields and are C^(degree - 1). Dirichlet conditions at a
   * side remain conditions on the nodes in it, which alone have functions that
   * do not vanish there.
   *
   * (Steffen, Kirby and Berzins 2008; Piegl and Tiller, The NURBS Book, 2.2)
   */
  template <int dimension, int polynomial_degree>
  struct Spline
  {
    static constexpr int dim     = dimension;
    static constexpr int degree  = polynomial_degree;
    using Factors                = SplineFactors<degree>;
    using Cell                   = SplineCell<dim, degree>;
    static constexpr int n       = degree + 1; // along a direction
    static constexpr int n_nodes = dim == 2 ? n * n : n * n * n;

    /** Index distance of neighbours (nodes or monomials) in direction d. */
    static constexpr int
    stride(const int d)
    {
      return d == 0 ? 1 : (d == 1 ? n : n * n);
    }

    /**
     * The position of node i, or the power of monomial i, along d: 0 ...
     * degree.
     */
    static constexpr int
    power(const int i, const int d)
    {
      return i / stride(d) % n;
    }

    template <class Grid>
    static const Cell &
    nodes_of(const Grid &grid, const std::uint32_t cell)
    {
      if constexpr (degree == 2)
        return grid.quadratics[cell];
      else
        return grid.cubics[cell];
    }

    /** Values and derivatives of the functions along a direction. */
    template <class Number>
    __attribute__((always_inline)) static
      typename Factors::template Weights<Number>
      weights(const Cell &cell, const int d, const Number &xi)
    {
      return Factors::weights(cell.lower[d], cell.upper[d], xi);
    }

    /** Positions of the nodes along a direction, in natural coordinates. */
    static std::array<double, n>
    places(const Cell &cell, const int d)
    {
      return Factors::places(cell.lower[d], cell.upper[d]);
    }

    /**
     * Turn nodal values into coefficients of the monomials xi^a eta^b zeta^c,
     * in place. Lanes are components.
     */
    template <class Number>
    __attribute__((always_inline)) static void
    to_monomials(std::array<Number, n_nodes> &a, const Cell &cell)
    {
      along_lines([&](const int i, const int d) __attribute__((always_inline)) {
        Factors::to_monomials(cell.lower[d], cell.upper[d], &a[i], stride(d));
      });
    }

    /**
     * The same plane by plane, then across the planes, for what does not fit
     * into registers. @p read(i) gives nodal values; @p write(k, value) stores
     * intermediate values that @p read_back(k) returns.
     */
    template <class Number, class Read, class ReadBack, class Write>
    __attribute__((always_inline)) static void
    to_monomials_by_planes(const Cell     &cell,
                           const Read     &read,
                           const ReadBack &read_back,
                           const Write    &write)
    {
      static_assert(dim == 3);
      for (int k = 0; k < n; ++k)
        {
          std::array<Number, n * n> plane;
#pragma GCC unroll 16
          for (int i = 0; i < n * n; ++i)
            plane[i] = read(k * n * n + i);
#pragma GCC unroll 4
          for (int j = 0; j < n; ++j)
            Factors::to_monomials(cell.lower[0],
                                  cell.upper[0],
                                  &plane[j * n],
                                  1);
#pragma GCC unroll 4
          for (int i = 0; i < n; ++i)
            Factors::to_monomials(cell.lower[1], cell.upper[1], &plane[i], n);
#pragma GCC unroll 16
          for (int i = 0; i < n * n; ++i)
            write(k * n * n + i, plane[i]);
        }
      for (int i = 0; i < n * n; ++i)
        {
          std::array<Number, n> line;
#pragma GCC unroll 4
          for (int k = 0; k < n; ++k)
            line[k] = read_back(k * n * n + i);
          Factors::to_monomials(cell.lower[2], cell.upper[2], line.data(), 1);
#pragma GCC unroll 4
          for (int k = 0; k < n; ++k)
            write(k * n * n + i, line[k]);
        }
    }

    /** The transpose: from forces on coefficients to forces on nodes. */
    template <class Number>
    __attribute__((always_inline)) static void
    to_nodes(std::array<Number, n_nodes> &a, const Cell &cell)
    {
      along_lines([&](const int i, const int d) __attribute__((always_inline)) {
        Factors::to_nodes(cell.lower[d], cell.upper[d], &a[i], stride(d));
      });
    }

    /** Value at natural coordinates xi; c(k) is the k-th coefficient. */
    template <class Number, class Coefficient>
    __attribute__((always_inline)) static Number
    value(const Coefficient &c, const std::array<Number, dim> &xi)
    {
      const auto plane = [&](const int k) __attribute__((always_inline))
      {
        return Factors::value(
          [&](const int j) __attribute__((always_inline)) {
            return Factors::value(
              [&](const int i)
                __attribute__((always_inline)) { return c(k + n * j + i); },
              xi[0]);
          },
          xi[1]);
      };
      if constexpr (dim == 2)
        return plane(0);
      else
        return Factors::value(
          [&](const int j)
            __attribute__((always_inline)) { return plane(n * n * j); },
          xi[2]);
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
          std::array<Plane<Number>, n> planes;
#pragma GCC unroll 4
          for (int j = 0; j < n; ++j)
            planes[j] = plane_with_slopes(c, xi, n * n * j);
          std::array<Number, dim> result;
#pragma GCC unroll 2
          for (int d = 0; d < 2; ++d)
            result[d] = Factors::value(
              [&](const int j)
                __attribute__((always_inline)) { return planes[j].slope[d]; },
              xi[2]);
          result[2] = Factors::slope(
            [&](const int j)
              __attribute__((always_inline)) { return planes[j].value; },
            xi[2]);
          return result;
        }
    }

  private:
    /** Call work(i, d) for the first node i of each line along each d. */
    template <class Work>
    __attribute__((always_inline)) static void
    along_lines(const Work &work)
    {
#pragma GCC unroll 3
      for (int d = 0; d < dim; ++d)
#pragma GCC unroll 9
        for (int line = 0; line < n_nodes / n; ++line)
          work(line / stride(d) * (n * stride(d)) + line % stride(d), d);
    }

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
      std::array<std::array<Number, 2>, n> rows; // value and slope
#pragma GCC unroll 4
      for (int j = 0; j < n; ++j)
        rows[j] = Factors::value_and_slope(
          [&](const int i)
            __attribute__((always_inline)) { return c(first + n * j + i); },
          xi[0]);
      Plane<Number> result;
      const auto    along = Factors::value_and_slope(
        [&](const int j) __attribute__((always_inline)) { return rows[j][0]; },
        xi[1]);
      result.value    = along[0];
      result.slope[0] = Factors::value(
        [&](const int j) __attribute__((always_inline)) { return rows[j][1]; },
        xi[1]);
      result.slope[1] = along[1];
      return result;
    }
  };

  template <int dim>
  using Quadratic = Spline<dim, 2>;

  template <int dim>
  using Cubic = Spline<dim, 3>;
} // namespace limber

#endif
