// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_pressure_solver_h
#define limber_time_pressure_solver_h

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace limber
{
  /**
   * Symmetric positive definite system with a diagonal of ones, the rows of
   * each rank together and in the order of ranks, stored with the same number
   * of entries in each row (ELLPACK), most of which are taken.
   */
  struct PressureEquations
  {
    static constexpr std::uint32_t no_column = 0xffffffffu;

    std::uint32_t              n_all = 0;  // rows of all ranks
    std::uint32_t              first = 0;  // row of this rank
    std::uint32_t              n     = 0;  // rows of this rank
    unsigned int               width = 0;  // entries in a row
    std::vector<std::uint32_t> columns;    // by row; no_column where none
    std::vector<double>        values;     // likewise
    std::vector<double>        right_side; // by row
    // Factor on the accuracy that is asked for, for the iterative solver: the
    // direct one leaves hardly more than round-off
    double share_of_accuracy = 1;
  };



  /**
   * Direct solver with a Cholesky factor (EnvelopeCholesky) in each step where
   * the matrix is small and has a small bandwidth; else conjugate gradients,
   * preconditioned by algebraic multigrid (Trilinos' ML). The multigrid of a
   * former matrix is reused until the number of iterations shows that it has
   * become too old.
   */
  class PressureSolver
  {
  public:
    explicit PressureSolver(MPI_Comm communicator);
    ~PressureSolver();

    /** Adopt another sparsity pattern, for all steps from now on.
     * Collective. */
    void
    set_pattern(const PressureEquations &equations);

    /**
     * Solve from the initial guess @p solution until the residual is below @p
     * accuracy (Euclidean norm over all ranks); returns the number of
     * iterations. Throws ComputationError if it cannot be done. Collective.
     */
    unsigned int
    solve(const PressureEquations &equations,
          double                   accuracy,
          std::vector<double>     &solution);

    /** The same with the matrix of the last solve(), another right-hand side
     * and zero as initial guess. Collective. */
    unsigned int
    solve_again(const PressureEquations &equations,
                double                   accuracy,
                std::vector<double>     &solution);

  private:
    struct Methods;
    std::unique_ptr<Methods> methods;
  };
} // namespace limber

#endif
