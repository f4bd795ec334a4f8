// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_small_matrix_h
#define limber_base_small_matrix_h

#include <array>
#include <cmath>

namespace limber
{
  /**
   * A matrix of two or three rows, as a deformation gradient is one; numbers
   * are doubles or packs of them.
   */
  template <int dim, class Number>
  using SmallMatrix = std::array<std::array<Number, dim>, dim>;



  template <int dim, class Number>
  inline Number
  determinant(const SmallMatrix<dim, Number> &a)
  {
    Number result = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    if constexpr (dim == 3)
      result = a[2][2] * result +
               a[2][1] * (a[0][2] * a[1][0] - a[0][0] * a[1][2]) +
               a[2][0] * (a[0][1] * a[1][2] - a[0][2] * a[1][1]);
    return result;
  }



  /** det(a) a^-T, of what is singular as well. */
  template <int dim, class Number>
  inline SmallMatrix<dim, Number>
  cofactor(const SmallMatrix<dim, Number> &a)
  {
    if constexpr (dim == 2)
      return {{{{a[1][1], -a[1][0]}}, {{-a[0][1], a[0][0]}}}};
    else
      {
        SmallMatrix<dim, Number> result;
#pragma GCC unroll 8
        for (int i = 0; i < dim; ++i)
#pragma GCC unroll 8
          for (int j = 0; j < dim; ++j)
            {
              const int k = (i + 1) % 3, l = (i + 2) % 3;
              const int m = (j + 1) % 3, n = (j + 2) % 3;
              result[i][j] = a[k][m] * a[l][n] - a[k][n] * a[l][m];
            }
        return result;
      }
  }



  /** a^T b */
  template <int dim, class A, class B>
  inline auto
  transpose_times(const SmallMatrix<dim, A> &a, const SmallMatrix<dim, B> &b)
  {
    SmallMatrix<dim, decltype(a[0][0] * b[0][0])> result;
#pragma GCC unroll 8
    for (int i = 0; i < dim; ++i)
#pragma GCC unroll 8
      for (int j = 0; j < dim; ++j)
        {
          result[i][j] = a[0][i] * b[0][j];
#pragma GCC unroll 8
          for (int k = 1; k < dim; ++k)
            result[i][j] += a[k][i] * b[k][j];
        }
    return result;
  }



  /** a b */
  template <int dim, class A, class B>
  inline auto
  times(const SmallMatrix<dim, A> &a, const SmallMatrix<dim, B> &b)
  {
    SmallMatrix<dim, decltype(a[0][0] * b[0][0])> result;
#pragma GCC unroll 8
    for (int i = 0; i < dim; ++i)
#pragma GCC unroll 8
      for (int j = 0; j < dim; ++j)
        {
          result[i][j] = a[i][0] * b[0][j];
#pragma GCC unroll 8
          for (int k = 1; k < dim; ++k)
            result[i][j] += a[i][k] * b[k][j];
        }
    return result;
  }



  /** a b^-1 */
  template <int dim, class Number>
  inline SmallMatrix<dim, Number>
  times_inverse(const SmallMatrix<dim, Number> &a,
                const SmallMatrix<dim, Number> &b)
  {
    const auto               cof   = cofactor<dim>(b);
    const Number             scale = 1. / determinant<dim>(b);
    SmallMatrix<dim, Number> result;
#pragma GCC unroll 8
    for (int i = 0; i < dim; ++i)
#pragma GCC unroll 8
      for (int j = 0; j < dim; ++j)
        {
          result[i][j] = a[i][0] * cof[j][0];
#pragma GCC unroll 8
          for (int k = 1; k < dim; ++k)
            result[i][j] += a[i][k] * cof[j][k];
          result[i][j] *= scale;
        }
    return result;
  }



  /**
   * The rotation R of the polar decomposition a = R U; det(a) > 0. In three
   * dimensions by Higham's iteration R <- (R + R^-T) / 2, which converges
   * quadratically (Higham, SIAM J. Sci. Stat. Comput. 7, 1986).
   */
  template <int dim>
  inline SmallMatrix<dim, double>
  rotation_of(const SmallMatrix<dim, double> &a)
  {
    if constexpr (dim == 2)
      {
        const double c = a[0][0] + a[1][1], s = a[1][0] - a[0][1];
        const double length = std::sqrt(c * c + s * s);
        return {{{{c / length, -s / length}}, {{s / length, c / length}}}};
      }
    else
      {
        constexpr unsigned int most_steps = 30;
        auto                   R          = a;
        for (unsigned int step = 0; step < most_steps; ++step)
          {
            const auto   cof    = cofactor<dim>(R);
            const double half   = 0.5 / determinant<dim>(R);
            double       change = 0;
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j)
                {
                  const double next = 0.5 * R[i][j] + half * cof[i][j];
                  change += std::abs(next - R[i][j]);
                  R[i][j] = next;
                }
            // what is left is of the order of its square
            if (!(change > 1e-8))
              break;
          }
        return R;
      }
  }
} // namespace limber

#endif
