// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_symmetric_function_h
#define limber_materials_symmetric_function_h

#include <array>
#include <cmath>

namespace limber
{
  /**
   * Isotropic function of a symmetric matrix, f(A) = sum f(lambda_i) n_i n_i^T,
   * with eigenvalues and eigenvectors by Jacobi rotations, which are exact to
   * round-off for equal eigenvalues as well (Golub and Van Loan, Matrix
   * Computations, 8.5). A matrix of plane strain takes one rotation.
   */
  template <class Function>
  inline std::array<std::array<double, 3>, 3>
  symmetric_function(std::array<std::array<double, 3>, 3> a, const Function &f)
  {
    std::array<std::array<double, 3>, 3> n{
      {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
    constexpr int n_sweeps = 8; // quadratic convergence: five are enough
    for (int sweep = 0; sweep < n_sweeps; ++sweep)
      {
        bool diagonal = true;
        for (int p = 0; p < 2; ++p)
          for (int q = p + 1; q < 3; ++q)
            {
              if (std::abs(a[p][q]) <=
                  1e-17 * (std::abs(a[p][p]) + std::abs(a[q][q])))
                continue;
              diagonal = false;
              // the smaller rotation angle that annihilates the entry
              const double cotangent = (a[q][q] - a[p][p]) / (2 * a[p][q]);
              const double t =
                (cotangent < 0 ? -1 : 1) /
                (std::abs(cotangent) + std::sqrt(cotangent * cotangent + 1));
              const double c = 1 / std::sqrt(t * t + 1), s = t * c;
              for (int k = 0; k < 3; ++k)
                {
                  const double kp = a[k][p], kq = a[k][q];
                  a[k][p] = c * kp - s * kq;
                  a[k][q] = s * kp + c * kq;
                }
              for (int k = 0; k < 3; ++k)
                {
                  const double pk = a[p][k], qk = a[q][k];
                  a[p][k]         = c * pk - s * qk;
                  a[q][k]         = s * pk + c * qk;
                  const double np = n[k][p], nq = n[k][q];
                  n[k][p] = c * np - s * nq;
                  n[k][q] = s * np + c * nq;
                }
              a[p][q] = a[q][p] = 0; // but for round-off
            }
        if (diagonal)
          break;
      }

    std::array<std::array<double, 3>, 3> result{};
    for (int i = 0; i < 3; ++i)
      {
        const double value = f(a[i][i]);
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q)
            result[p][q] += value * n[p][i] * n[q][i];
      }
    return result;
  }
} // namespace limber

#endif
