// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_mixed_solver_h
#define limber_fem_mixed_solver_h

#include <deal.II/lac/sparse_matrix.h>

#include <limber/fem/linear_solver.h>

namespace limber
{
  /**
   * Solves (A + B^T C^-1 B) u = f, the equations of a solid whose rows b of B
   * tell the growth of the volume of a cell, as
   *
   *   A u + B^T p = f,     B u - C p = g,      C diagonal,
   *
   * which does not mind how little the volume gives in (C to zero). Generalised
   * minimal residuals (GMRES; Saad and Schultz, SIAM J. Sci. Stat. Comput. 7,
   * 1986) with a block triangular preconditioner (Bramble and Pasciak, Math.
   * Comp. 50, 1988): one V-cycle of multigrid for A; then, with B u - g of the
   * displacements that this gave, a polynomial of Chebyshev in a sparse matrix
   * for the pressures. For one rank.
   *
   * A may keep the part B^T D B of the stiffness of the volumes, D diagonal.
   * With A0 what is in it besides, the pressures then have, in terms of
   * Q = (C^-1 + D)^-1 + B A0^-1 B^T and a = D / (C^-1 + D), the exact inverse
   *
   *   (C + B A^-1 B^T)^-1 = (1 - a) (Q^-1 (1 - a) + D)
   *
   * (Woodbury's formula), where a is diagonal; the preconditioner is this with
   * the caller's approximation of Q.
   */
  class MixedSolver
  {
  public:
    struct Equations
    {
      const dealii::TrilinosWrappers::SparseMatrix *stiffness   = nullptr; // A
      const dealii::SparseMatrix<double>           *rows        = nullptr; // B
      const std::vector<double>                    *compliance  = nullptr; // C
      const std::vector<double>                    *kept        = nullptr; // D
      const dealii::SparseMatrix<double>           *of_pressure = nullptr; // Q
      // A diagonal matrix M: all eigenvalues of M^-1 Q are between the least
      // share and 1.
      const std::vector<double> *bound       = nullptr;
      double                     least_share = 1;
    };

    /** @p rigid_motions: see make_multigrid(). */
    MixedSolver(unsigned int               dim,
                const std::vector<double> &rigid_motions,
                const Equations           &equations);

    ~MixedSolver();

    /**
     * The displacements u for the right sides f and g. Returns the iterations
     * it took; throws IterationsFailed where they do not converge.
     */
    unsigned int
    solve(NodalVector               &solution,
          const NodalVector         &right_side,
          const std::vector<double> &of_volumes) const;

  private:
    struct Methods;

    const Equations          equations;
    std::unique_ptr<Methods> methods;
  };
} // namespace limber

#endif
