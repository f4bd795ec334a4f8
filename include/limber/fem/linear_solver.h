// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_linear_solver_h
#define limber_fem_linear_solver_h

#include <deal.II/lac/la_parallel_vector.h>

#include <limber/base/exceptions.h>

#include <memory>
#include <string>
#include <vector>

namespace dealii
{
  namespace TrilinosWrappers
  {
    class SparseMatrix;
  }
} // namespace dealii

namespace limber
{
  using NodalVector = dealii::LinearAlgebra::distributed::Vector<double>;



  /** Iterations have not converged. */
  class IterationsFailed : public ComputationError
  {
  public:
    /** @p method: name of the iteration, as the subject of a sentence; @p
     * residual: relative to that at the start. */
    IterationsFailed(const std::string &method,
                     unsigned int       iterations,
                     double             residual,
                     const std::string &what_to_do = "");

    /** "conjugate gradients stopped after 2000 iterations ..." */
    const std::string event;
  };



  /**
   * How LinearSolver solves. Cholesky factors are for symmetric matrices; what
   * is not positive definite, or lies on several ranks, gets LU factors.
   */
  enum class SolutionMethod
  {
    cholesky,
    lu,
    conjugate_gradients
  };



  /**
   * Solver for elasticity matrices, for many right-hand sides with one matrix:
   * small systems by factorisation (SparseCholesky, Amesos), large symmetric
   * positive definite ones by conjugate gradients with algebraic multigrid
   * (ML), whose near null space is the rigid motions of the body.
   */
  class LinearSolver
  {
  public:
    /**
     * @p rigid_motions: values of each motion on the locally owned degrees
     * of freedom, one motion after the other; @p dim: components of a node.
     * Iterations have failed where they do not converge in @p most_iterations.
     */
    LinearSolver(const SolutionMethod       method,
                 const unsigned int         dim,
                 const std::vector<double> &rigid_motions,
                 const unsigned int         most_iterations = 2000);

    ~LinearSolver();

    /** The matrix has to live until the next call. */
    void
    set_matrix(const dealii::TrilinosWrappers::SparseMatrix &matrix);

    /**
     * Returns the iterations it took, none by factorisation. Throws
     * IterationsFailed where they do not converge, ComputationError where the
     * matrix is singular.
     */
    unsigned int
    solve(NodalVector &solution, const NodalVector &right_side);

    const SolutionMethod method;

  private:
    struct Methods;

    bool
    has_cholesky_factors(const dealii::TrilinosWrappers::SparseMatrix &matrix);

    const unsigned int        dim;
    const std::vector<double> rigid_motions;
    std::unique_ptr<Methods>  methods;
    const unsigned int        most_iterations;
  };
} // namespace limber

#endif
