// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/lac/trilinos_vector.h>

#include <limber/base/exceptions.h>
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>
#include <limber/time/envelope_cholesky.h>
#include <limber/time/pressure_solver.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace limber
{
  namespace
  {
    constexpr unsigned int most_iterations = 500;

    // Setting up the multigrid takes as long as so many iterations.
    constexpr unsigned int iterations_of_making = 40;

    // The matrix is factorised in each step if this takes at most so many
    // multiplications per row, less time than iterating, and there are at most
    // so many rows, as every rank gathers the whole system.
    constexpr double        most_work_for_a_row = 3000;
    constexpr std::uint32_t most_rows_of_factor = 20000;

    // Most solutions with a factor: the first, then iterative refinement.
    constexpr unsigned int most_repetitions = 5;

    using Vector = dealii::TrilinosWrappers::MPI::Vector;



    [[noreturn]] void
    fail_to_solve(const double residual, const unsigned int iterations)
    {
      throw ComputationError(
        "The equations of the implicit pressure were not solved: after " +
          std::to_string(iterations) + " iterations the residual is " +
          brief(residual) +
          " times what is asked for. Usually the step is too long or the "
          "run has become unstable. Set 'Method/Courant number' lower, or "
          "'Time integration = explicit'.",
        FailureKind::not_finite);
    }
  } // namespace



  struct PressureSolver::Methods
  {
    explicit Methods(const MPI_Comm communicator)
      : communicator(communicator)
    {}

    void
    find_entries(const PressureEquations &equations);
    void
    set_values(const PressureEquations &equations);
    void
    make_multigrid();
    unsigned int
    iterate(double accuracy);
    void
    prepare_iterations(const PressureEquations &equations);
    bool
    factorise(const PressureEquations &equations);
    std::optional<unsigned int>
    solve_directly(const PressureEquations &equations,
                   double                   accuracy,
                   std::vector<double>     &solution);
    unsigned int
    solve_iteratively(const PressureEquations &equations,
                      double                   accuracy,
                      std::vector<double>     &solution);

    bool
    prepare_factor(const PressureEquations &equations);
    template <class Number>
    void
    gather(const std::vector<Number> &own,
           unsigned int               width,
           std::vector<Number>       &all) const;

    const MPI_Comm             communicator;
    bool                       is_direct = false;
    EnvelopeCholesky           factor;
    PressureEquations          whole; // of all ranks, for the factor
    std::vector<std::uint32_t> n_of_ranks;
    bool                       has_multigrid       = false;
    unsigned int               iterations_when_new = 0;
    unsigned int more_iterations = 0; // with a reused one, beyond those
    dealii::TrilinosWrappers::SparseMatrix    matrix;
    std::vector<double *>                     entries; // by entry
    dealii::TrilinosWrappers::PreconditionAMG multigrid;
    Vector                                    x, b;
  };



  void
  PressureSolver::set_pattern(const PressureEquations &equations)
  {
    methods->is_direct = methods->prepare_factor(equations);
    if (!methods->is_direct)
      methods->prepare_iterations(equations);
  }



  void
  PressureSolver::Methods::prepare_iterations(
    const PressureEquations &equations)
  {
    dealii::IndexSet rows(equations.n_all);
    rows.add_range(equations.first, equations.first + equations.n);

    dealii::TrilinosWrappers::SparsityPattern    pattern(rows,
                                                      communicator,
                                                      equations.width);
    std::vector<dealii::types::global_dof_index> of_row;
    for (std::uint32_t r = 0; r < equations.n; ++r)
      {
        of_row.clear();
        for (unsigned int k = 0; k < equations.width; ++k)
          if (const auto column = equations.columns[r * equations.width + k];
              column != PressureEquations::no_column)
            of_row.push_back(column);
        pattern.add_entries(equations.first + r, of_row.begin(), of_row.end());
      }
    pattern.compress();
    matrix.reinit(pattern);
    find_entries(equations);
    x.reinit(rows, communicator);
    b.reinit(rows, communicator);
    has_multigrid = false;
  }



  // Pointers to the entries in the matrix: to look each of them up in every
  // step would take longer than to compute them.
  void
  PressureSolver::Methods::find_entries(const PressureEquations &equations)
  {
    const Epetra_CrsMatrix &rows = matrix.trilinos_matrix();
    entries.assign(equations.columns.size(), nullptr);
    for (std::uint32_t r = 0; r < equations.n; ++r)
      {
        int     n       = 0;
        double *values  = nullptr;
        int    *columns = nullptr;
        rows.ExtractMyRowView(r, n, values, columns);
        for (unsigned int k = 0; k < equations.width; ++k)
          {
            const std::size_t place = std::size_t(r) * equations.width + k;
            if (equations.columns[place] == PressureEquations::no_column)
              continue;
            const int local = rows.LCID(int(equations.columns[place]));
            entries[place] =
              values + (std::find(columns, columns + n, local) - columns);
          }
      }
  }



  void
  PressureSolver::Methods::set_values(const PressureEquations &equations)
  {
    for (std::size_t place = 0; place < entries.size(); ++place)
      if (entries[place] != nullptr)
        *entries[place] = equations.values[place];
  }



  void
  PressureSolver::Methods::make_multigrid()
  {
    dealii::TrilinosWrappers::PreconditionAMG::AdditionalData settings;
    settings.elliptic              = true;
    settings.smoother_type         = "Chebyshev";
    settings.smoother_sweeps       = 4;
    settings.aggregation_threshold = 0.02;
    settings.coarse_type           = "Amesos-KLU";
    multigrid.initialize(matrix, settings);
  }



  unsigned int
  PressureSolver::Methods::iterate(const double accuracy)
  {
    dealii::SolverControl control(most_iterations, accuracy);
    try
      {
        dealii::SolverCG<Vector>(control).solve(matrix, x, b, multigrid);
      }
    catch (const dealii::SolverControl::NoConvergence &failure)
      {
        fail_to_solve(failure.last_residual / accuracy, failure.last_step);
      }
    return control.last_step();
  }



  // Whether to factorise. Every rank factorises the whole system, which is
  // small: so results on several ranks agree with those on one to round-off.
  bool
  PressureSolver::Methods::prepare_factor(const PressureEquations &equations)
  {
    if (equations.n_all > most_rows_of_factor)
      return false;
    n_of_ranks = {equations.n};
    unite(n_of_ranks, communicator);

    whole.n_all = whole.n = equations.n_all;
    whole.width = dealii::Utilities::MPI::max(equations.width, communicator);
    gather(equations.columns, whole.width, whole.columns);
    return factor.set_pattern(whole) <= most_work_for_a_row * whole.n;
  }



  // @p own has @p width numbers for each row of this rank.
  template <class Number>
  void
  PressureSolver::Methods::gather(const std::vector<Number> &own,
                                  const unsigned int         width,
                                  std::vector<Number>       &all) const
  {
    std::vector<int> counts, places;
    int              sum = 0;
    for (const std::uint32_t n : n_of_ranks)
      {
        counts.push_back(n * width);
        places.push_back(sum);
        sum += counts.back();
      }
    all.resize(sum);
    const MPI_Datatype type =
      std::is_same<Number, double>::value ? MPI_DOUBLE : MPI_UINT32_T;
    MPI_Allgatherv(own.data(),
                   own.size(),
                   type,
                   all.data(),
                   counts.data(),
                   places.data(),
                   type,
                   communicator);
  }



  bool
  PressureSolver::Methods::factorise(const PressureEquations &equations)
  {
    gather(equations.values, whole.width, whole.values);
    return factor.factorise(whole);
  }



  // Direct solution with iterative refinement: round-off leaves a residual in
  // nearly incompressible cells. Returns the number of solutions with the
  // factor; nothing where the residual does not get small enough, as in a
  // closed vessel whose mean pressure is undetermined.
  std::optional<unsigned int>
  PressureSolver::Methods::solve_directly(const PressureEquations &equations,
                                          const double             accuracy,
                                          std::vector<double>     &solution)
  {
    gather(equations.right_side, 1, whole.right_side);
    std::vector<double> found(whole.n, 0.), residual = whole.right_side;
    for (unsigned int n = 1; n <= most_repetitions; ++n)
      {
        factor.solve(residual);
        double squares = 0;
        for (std::uint32_t row = 0; row < whole.n; ++row)
          found[row] += residual[row];
        for (std::uint32_t row = 0; row < whole.n; ++row)
          {
            const std::size_t first = std::size_t(row) * whole.width;
            residual[row]           = whole.right_side[row];
            for (unsigned int k = 0; k < whole.width; ++k)
              if (const auto column = whole.columns[first + k];
                  column != PressureEquations::no_column)
                residual[row] -= whole.values[first + k] * found[column];
            squares += residual[row] * residual[row];
          }
        if (squares <= accuracy * accuracy)
          {
            std::copy_n(found.begin() + equations.first,
                        equations.n,
                        solution.begin());
            return n;
          }
      }
    return {};
  }



  // With the matrix and the multigrid as they are; @p solution is the initial
  // guess.
  unsigned int
  PressureSolver::Methods::solve_iteratively(const PressureEquations &equations,
                                             const double             accuracy,
                                             std::vector<double>     &solution)
  {
    std::copy(solution.begin(), solution.end(), x.begin());
    std::copy(equations.right_side.begin(),
              equations.right_side.end(),
              b.begin());
    const unsigned int iterations =
      iterate(accuracy * equations.share_of_accuracy);
    std::copy(x.begin(), x.end(), solution.begin());
    return iterations;
  }



  PressureSolver::PressureSolver(const MPI_Comm communicator)
    : methods(std::make_unique<Methods>(communicator))
  {}



  PressureSolver::~PressureSolver() = default;



  unsigned int
  PressureSolver::solve(const PressureEquations &equations,
                        const double             accuracy,
                        std::vector<double>     &solution)
  {
    if (equations.n_all == 0)
      return 0;
    if (methods->is_direct)
      {
        if (methods->factorise(equations))
          if (const auto n =
                methods->solve_directly(equations, accuracy, solution))
            return *n;
        methods->is_direct = false;
        methods->prepare_iterations(equations);
      }
    methods->set_values(equations);
    const bool is_new = !methods->has_multigrid;
    if (is_new)
      methods->make_multigrid();
    const unsigned int iterations =
      methods->solve_iteratively(equations, accuracy, solution);
    if (is_new)
      {
        methods->iterations_when_new = iterations;
        methods->more_iterations     = 0;
      }
    else if (iterations > methods->iterations_when_new)
      methods->more_iterations += iterations - methods->iterations_when_new;
    methods->has_multigrid = methods->more_iterations < iterations_of_making;
    return iterations;
  }



  unsigned int
  PressureSolver::solve_again(const PressureEquations &equations,
                              const double             accuracy,
                              std::vector<double>     &solution)
  {
    if (equations.n_all == 0)
      return 0;
    solution.assign(equations.n, 0.);
    if (methods->is_direct)
      if (const auto n = methods->solve_directly(equations, accuracy, solution))
        return *n;
    if (methods->is_direct)
      return solve(equations, accuracy, solution);
    return methods->solve_iteratively(equations, accuracy, solution);
  }
} // namespace limber
