// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_solver.h>

#include <limber/base/text.h>
#include <limber/fem/linear_solver.h>
#include <limber/fem/multigrid.h>
#include <limber/fem/sparse_cholesky.h>

#include <optional>

namespace limber
{
  namespace
  {
    constexpr double cg_accuracy = 1e-10; // relative residual



    [[noreturn]] void
    refuse_singular_matrix(const unsigned int n_equations)
    {
      throw ComputationError(
        "The " + std::to_string(n_equations) +
        " equations of the finite element reference have no unique solution. "
        "Usually nothing holds the body, an element of 'Reference/Mesh file' "
        "is degenerate, or numbers are too large or not finite. Set a side to "
        "'no slip' in 'Boundaries', or 'Reference/Method = implicit'.");
    }
    std::string
    failed_iterations(const std::string &method,
                      const unsigned int iterations,
                      const double       residual)
    {
      return method + " stopped after " + std::to_string(iterations) +
             " iterations with " + brief(residual) +
             " of the residual at the start";
    }
  } // namespace



  IterationsFailed::IterationsFailed(const std::string &method,
                                     const unsigned int iterations,
                                     const double       residual,
                                     const std::string &what_to_do)
    : ComputationError("The " +
                       failed_iterations(method, iterations, residual) + "." +
                       what_to_do)
    , event(failed_iterations(method, iterations, residual))
  {}



  struct LinearSolver::Methods
  {
    std::optional<SparseCholesky>                           cholesky;
    dealii::SolverControl                                   control;
    std::unique_ptr<dealii::TrilinosWrappers::SolverDirect> factors;
    dealii::TrilinosWrappers::PreconditionAMG               multigrid;
    const dealii::TrilinosWrappers::SparseMatrix           *matrix = nullptr;
  };



  LinearSolver::LinearSolver(const SolutionMethod       method,
                             const unsigned int         dim,
                             const std::vector<double> &rigid_motions,
                             const unsigned int         most_iterations)
    : method(method)
    , dim(dim)
    , rigid_motions(rigid_motions)
    , methods(std::make_unique<Methods>())
    , most_iterations(most_iterations)
  {}



  LinearSolver::~LinearSolver() = default;



  bool
  LinearSolver::has_cholesky_factors(
    const dealii::TrilinosWrappers::SparseMatrix &matrix)
  {
    if (method != SolutionMethod::cholesky ||
        dealii::Utilities::MPI::n_mpi_processes(matrix.get_mpi_communicator()) >
          1)
      return false;
    if (!methods->cholesky)
      methods->cholesky.emplace();
    return methods->cholesky->factorise(matrix);
  }



  void
  LinearSolver::set_matrix(const dealii::TrilinosWrappers::SparseMatrix &matrix)
  {
    methods->matrix = &matrix;
    methods->factors.reset();
    if (has_cholesky_factors(matrix))
      return;
    if (method != SolutionMethod::conjugate_gradients)
      {
        using Direct = dealii::TrilinosWrappers::SolverDirect;
        // MUMPS factorises on all ranks; on one, KLU is faster for small
        // systems.
        const bool alone = dealii::Utilities::MPI::n_mpi_processes(
                             matrix.get_mpi_communicator()) == 1;
        methods->factors = std::make_unique<Direct>(
          methods->control,
          Direct::AdditionalData(false, alone ? "Amesos_Klu" : "Amesos_Mumps"));
        try
          {
            methods->factors->initialize(matrix);
          }
        catch (const dealii::ExceptionBase &)
          {
            refuse_singular_matrix(matrix.m());
          }
        return;
      }

    make_multigrid(methods->multigrid, matrix, dim, rigid_motions, {});
  }



  unsigned int
  LinearSolver::solve(NodalVector &solution, const NodalVector &right_side)
  {
    if (method != SolutionMethod::conjugate_gradients)
      {
        if (methods->factors == nullptr)
          {
            methods->cholesky->solve(solution, right_side);
            return 0;
          }
        try
          {
            methods->factors->solve(solution, right_side);
          }
        catch (const dealii::ExceptionBase &)
          {
            refuse_singular_matrix(right_side.size());
          }
        return 0;
      }
    const double          size = right_side.l2_norm();
    dealii::SolverControl control(most_iterations, cg_accuracy * size);
    solution = 0;
    if (size == 0)
      return 0;
    try
      {
        dealii::SolverCG<NodalVector>(control).solve(*methods->matrix,
                                                     solution,
                                                     right_side,
                                                     methods->multigrid);
      }
    catch (const dealii::SolverControl::NoConvergence &failure)
      {
        throw IterationsFailed(
          "conjugate gradients",
          failure.last_step,
          failure.last_residual / size,
          " Usually the body has lost its stability or Poisson's ratio is too "
          "close to 0.5. Set 'Reference/Load steps' or 'Reference/Time step' "
          "finer, or take 'Element = Q1-P0-P0'.");
      }
    return control.last_step();
  }
} // namespace limber
