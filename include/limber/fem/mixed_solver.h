// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_mixed_solver_h
#define limber_fem_mixed_solver_h

#include <deal.II/lac/sparse_matrix.h>

#include <limber/fem/linear_solver.h>

namespace limber
{
  /**
   * Solves the displacement form of a nearly incompressible solid, (A + B^T
   * C^-1 B) u = f, where the rows of B are the volume changes of cells, as the
   * saddle point problem
   *
   *   A u + B^T p = f,     B u - C p = g,      C diagonal,
   *
   * which is robust in the incompressible limit (C to zero). GMRES (Saad and
   * Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) with a block triangular
   * preconditioner (Bramble and Pasciak, Math. Comp. 50, 1988): one V-cycle of
   * multigrid for A; then, with B u - g of these displacements, a Chebyshev
   * polynomial in a sparse matrix for the Schur complement of the pressures.
   * For one rank.
   *
   * A may keep the part B^T D B of the volumetric stiffness, D diagonal. With
   * its remainder A0, Q = (C^-1 + D)^-1 + B A0^-1 B^T and the diagonal matrix a
   * = D / (C^-1 + D), the Schur complement has the exact inverse
   *
   *   (C + B A^-1 B^T)^-1 = (1 - a) (Q^-1 (1 - a) + D)
   *
   * (Woodbury's formula); the preconditioner is this with the caller's
   * approximation of Q.
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
     * Solves for the displacements u with the right-hand sides f and g. Returns
     * the number of iterations; throws IterationsFailed where they do not
     * converge.
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
