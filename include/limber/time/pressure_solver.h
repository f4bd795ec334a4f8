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
   * Symmetric positive definite equations with a diagonal of ones, the rows of
   * each rank together and in the order of ranks. Each row has the same number
   * of places for entries, most of which are taken.
   */
  struct PressureEquations
  {
    static constexpr std::uint32_t no_column = 0xffffffffu;

    std::uint32_t              n_all = 0;  // rows of all ranks
    std::uint32_t              first = 0;  // row of this rank
    std::uint32_t              n     = 0;  // rows of this rank
    unsigned int               width = 0;  // places in a row
    std::vector<std::uint32_t> columns;    // by row; no_column where none
    std::vector<double>        values;     // likewise
    std::vector<double>        right_side; // by row
    // Of the accuracy that is asked for, what iterations have to reach: a
    // factor leaves hardly more than round-off
    double share_of_accuracy = 1;
  };



  /**
   * Where few cells make a narrow matrix, a factor of it
   * (EnvelopeCholesky) in each step; else conjugate gradients, preconditioned
   * by algebraic multigrid (Trilinos' ML). The multigrid of a former matrix
   * serves the next ones as well until the iterations say that it has become
   * too old.
   */
  class PressureSolver
  {
  public:
    explicit PressureSolver(MPI_Comm communicator);
    ~PressureSolver();

    /** Adopt other columns, those of all steps from now on. Collective. */
    void
    set_pattern(const PressureEquations &equations);

    /**
     * Improve @p solution, the start, until the residual is below @p accuracy
     * (Euclidean norm over all ranks); returns the iterations that took.
     * Throws ComputationError if it cannot be done. Collective.
     */
    unsigned int
    solve(const PressureEquations &equations,
          double                   accuracy,
          std::vector<double>     &solution);

    /** The same with the matrix of the last solve() and another right side,
     * from zero. Collective. */
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
