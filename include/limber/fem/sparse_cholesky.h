// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_sparse_cholesky_h
#define limber_fem_sparse_cholesky_h

#include <limber/fem/linear_solver.h>

#include <memory>

namespace limber
{
  /**
   * Cholesky factors of a sparse symmetric matrix that one rank holds (CHOLMOD:
   * Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, ACM Trans. Math. Softw.
   * 35, 2008), in an order that keeps them sparse. The order is found once for
   * all matrices with the same entries.
   */
  class SparseCholesky
  {
  public:
    SparseCholesky();

    ~SparseCholesky();

    /**
     * Factorise a matrix, of which one triangle is read. False where it is not
     * positive definite: there are no factors then.
     */
    bool
    factorise(const dealii::TrilinosWrappers::SparseMatrix &matrix);

    void
    solve(NodalVector &solution, const NodalVector &right_side);

  private:
    struct Factors;
    const std::unique_ptr<Factors> factors;
  };
} // namespace limber

#endif
