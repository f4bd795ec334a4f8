// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_isochoric_strain_h
#define limber_materials_isochoric_strain_h

#include <limber/base/small_matrix.h>
#include <limber/materials/law.h>
#include <limber/materials/symmetric_function.h>

#include <cmath>

/**
 * @file The isochoric elastic left Cauchy-Green tensor be, det(be) = 1, in the
 * history of a point, for solids at finite strain. From entry 1 on the history
 * holds the independent entries: xx, yy, xy in plane strain; in three
 * dimensions yz and zx besides. zz follows from det(be) = 1, so that the
 * constraint cannot drift.
 */
namespace limber
{
  namespace isochoric
  {
    template <class Number>
    using FullMatrix = std::array<std::array<Number, 3>, 3>;

    /** Number of entries of be in the history, from index 1. */
    template <int dim>
    inline constexpr int n_entries = dim == 2 ? 3 : 5;



    /** be as a full matrix. */
    template <int dim, class History>
    inline auto
    strain(const History &h)
    {
      using Number    = typename History::value_type;
      const Number xx = h[1], yy = h[2], xy = h[3];
      Number       yz{}, zx{};
      if constexpr (dim == 3)
        {
          yz = h[4];
          zx = h[5];
        }
      const Number minor = xx * yy - xy * xy;
      const Number zz =
        (1. + xx * yz * yz + yy * zx * zx - 2. * xy * yz * zx) / minor;
      return FullMatrix<Number>{
        {{{xx, xy, zx}}, {{xy, yy, yz}}, {{zx, yz, zz}}}};
    }



    /** Store the independent entries of be(i, j), given by a function. */
    template <int dim, class History, class Entry>
    inline void
    set_entries(History &h, const Entry &be)
    {
      h[1] = be(0, 0);
      h[2] = be(1, 1);
      h[3] = be(0, 1);
      if constexpr (dim == 3)
        {
          h[4] = be(1, 2);
          h[5] = be(2, 0);
        }
    }



    /** be <- (det f)^(-2/3) f be f^T, with the determinant @p J of f. */
    template <int dim, class History, class Number>
    inline void
    deform(History &h, const SmallMatrix<dim, Number> &f, const Number &J)
    {
      const Number                             root  = inverse_cube_root(J);
      const Number                             scale = root * root;
      const auto                               be    = strain<dim>(h);
      std::array<std::array<Number, dim>, dim> fb;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          {
            fb[i][j] = f[i][0] * be[0][j];
            for (int k = 1; k < dim; ++k)
              fb[i][j] += f[i][k] * be[k][j];
          }
      set_entries<dim>(h, [&](const int i, const int j) {
        Number result = fb[i][0] * f[j][0];
        for (int k = 1; k < dim; ++k)
          result += fb[i][k] * f[j][k];
        return scale * result;
      });
    }



    /** be = det(F)^(-2/3) F F^T. */
    template <int dim, class History, class Number>
    inline void
    set_at(History &h, const SmallMatrix<dim, Number> &F)
    {
      const Number root  = inverse_cube_root(determinant<dim>(F));
      const Number scale = root * root;
      set_entries<dim>(h, [&](const int i, const int j) {
        Number result = F[i][0] * F[j][0];
        for (int k = 1; k < dim; ++k)
          result += F[i][k] * F[j][k];
        return scale * result;
      });
    }



    template <class Number>
    inline Number
    trace(const FullMatrix<Number> &be)
    {
      return be[0][0] + be[1][1] + be[2][2];
    }



    /** dev(be) */
    template <int dim, class Number>
    inline Deviator<dim, Number>
    deviator(const FullMatrix<Number> &be)
    {
      const Number third = trace(be) * (1. / 3.);
      if constexpr (dim == 2)
        return {{be[0][0] - third, be[1][1] - third, be[0][1]}};
      else
        return {
          {be[0][0] - third, be[1][1] - third, be[0][1], be[1][2], be[2][0]}};
    }



    /** Determinant of a deviator. */
    template <int dim, class Number>
    inline Number
    determinant_of(const Deviator<dim, Number> &e)
    {
      const Number zz     = -(e[0] + e[1]);
      Number       result = zz * (e[0] * e[1] - e[2] * e[2]);
      if constexpr (dim == 3)
        result += e[3] * (2. * e[2] * e[4] - e[0] * e[3]) - e[1] * e[4] * e[4];
      return result;
    }



    /**
     * be from its deviator e: its mean I is the largest root of det(e + I 1) =
     * 1, by Newton's method, which converges monotonically from above.
     */
    template <int dim, class History>
    inline void
    set_deviator(History &h, const Deviator<dim, double> &e)
    {
      const double half = 0.5 * squared_norm<dim, double>(e);
      const double rest = determinant_of<dim>(e) - 1;
      double       I = 1 + std::sqrt(2 * half), step = I;
      for (int iteration = 0; iteration < 100 && step > 1e-15 * I; ++iteration)
        {
          step = (I * (I * I - half) + rest) / (3 * I * I - half);
          I -= step;
        }
      set_entries<dim>(h, [&](const int i, const int j) {
        return i == j ? e[i] + I : e[i + j == 1 ? 2 : i + j == 3 ? 3 : 4];
      });
    }



    /**
     * An upper bound (Gershgorin) of the largest eigenvalue of be; one at rest.
     */
    template <class Number>
    inline Number
    largest_eigenvalue(const FullMatrix<Number> &be)
    {
      Number bound = be[2][2];
      for (int i = 0; i < 3; ++i)
        bound = larger(bound,
                       magnitude(be[i][0]) + magnitude(be[i][1]) +
                         magnitude(be[i][2]));
      return bound;
    }



    /** ln(be) / 2; be has the determinant one, so the trace is zero. */
    template <int dim, class History>
    inline Deviator<dim, double>
    logarithmic(const History &h)
    {
      const auto e = symmetric_function(strain<dim>(h), [](const double x) {
        return 0.5 * std::log(x);
      });
      if constexpr (dim == 2)
        return {{e[0][0], e[1][1], e[0][1]}};
      else
        return {{e[0][0], e[1][1], e[0][1], e[1][2], e[2][0]}};
    }



    /** The inverse: be = exp(2 e). */
    template <int dim, class History>
    inline void
    set_logarithmic(History &h, const Deviator<dim, double> &e)
    {
      const auto be =
        symmetric_function(full_matrix<dim>(e),
                           [](const double x) { return std::exp(2 * x); });
      set_entries<dim>(h, [&](const int i, const int j) { return be[i][j]; });
    }
  } // namespace isochoric
} // namespace limber

#endif
