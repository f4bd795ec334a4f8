// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_minres.h>

#include <limber/fem/mixed_solver.h>
#include <limber/fem/multigrid.h>

namespace limber
{
  namespace
  {
    constexpr unsigned int most_minres_iterations = 500;
    // of the residual, in the norm of the preconditioner
    constexpr double       minres_accuracy  = 1e-8;
    constexpr unsigned int chebyshev_degree = 20;
    // largest over smallest eigenvalue that the polynomial cares for
    constexpr double chebyshev_range = 300;
    // Both by counting iterations: with A^-1 itself instead of the cycle there
    // would be half as many.
    const MultigridForm multigrid_form{4, "MGW", 1.5};
    constexpr double    weight_of_pressure = 0.4;

    using Vector = dealii::LinearAlgebra::distributed::BlockVector<double>;



    using Chebyshev =
      dealii::PreconditionChebyshev<dealii::SparseMatrix<double>, NodalVector>;



    struct Operator
    {
      void
      vmult(Vector &out, const Vector &in) const
      {
        equations.stiffness->vmult(out.block(0), in.block(0));
        equations.rows->Tvmult_add(out.block(0), in.block(1));
        equations.rows->vmult(out.block(1), in.block(0));
        for (std::size_t c = 0; c < equations.compliance->size(); ++c)
          out.block(1)[c] -= (*equations.compliance)[c] * in.block(1)[c];
      }

      const MixedSolver::Equations &equations;
    };



    struct Preconditioner
    {
      void
      vmult(Vector &out, const Vector &in) const
      {
        multigrid.vmult(out.block(0), in.block(0));
        of_pressure.vmult(out.block(1), in.block(1));
        for (std::size_t c = 0; c < equations.kept->size(); ++c)
          {
            const double kept  = (*equations.kept)[c];
            const double share = 1 / (1 + kept * (*equations.compliance)[c]);
            double      &value = out.block(1)[c];
            value              = weight_of_pressure * share *
                    (share * value + kept * in.block(1)[c]);
          }
      }

      const dealii::TrilinosWrappers::PreconditionAMG &multigrid;
      const Chebyshev                                 &of_pressure;
      const MixedSolver::Equations                    &equations;
    };
  } // namespace



  struct MixedSolver::Methods
  {
    dealii::TrilinosWrappers::PreconditionAMG multigrid;
    Chebyshev                                 of_pressure;
  };



  MixedSolver::MixedSolver(const unsigned int         dim,
                           const std::vector<double> &rigid_motions,
                           const Equations           &equations)
    : equations(equations)
    , methods(std::make_unique<Methods>())
  {
    make_multigrid(methods->multigrid,
                   *equations.stiffness,
                   dim,
                   rigid_motions,
                   multigrid_form);
    Chebyshev::AdditionalData settings;
    settings.degree              = chebyshev_degree;
    settings.smoothing_range     = chebyshev_range;
    settings.eig_cg_n_iterations = 0;
    // of a matrix whose eigenvalues are 1 at most and whose diagonal is 3/4 or
    // more, in space 1/2, before the inverse of the bulk modulus joins both
    settings.max_eigenvalue = dim == 2 ? 4. / 3. : 2.;
    settings.preconditioner =
      std::make_shared<dealii::DiagonalMatrix<NodalVector>>();
    NodalVector &diagonal = settings.preconditioner->get_vector();
    diagonal.reinit(equations.of_pressure->m());
    for (std::size_t c = 0; c < equations.of_pressure->m(); ++c)
      diagonal[c] = 1 / equations.of_pressure->diag_element(c);
    methods->of_pressure.initialize(*equations.of_pressure, settings);
  }



  MixedSolver::~MixedSolver() = default;



  unsigned int
  MixedSolver::solve(NodalVector               &solution,
                     const NodalVector         &right_side,
                     const std::vector<double> &of_volumes) const
  {
    Vector unknowns(2), right_sides(2);
    for (Vector *const vector : {&unknowns, &right_sides})
      {
        vector->block(0).reinit(right_side.size());
        vector->block(1).reinit(of_volumes.size());
        vector->collect_sizes();
      }
    right_sides.block(0) = right_side;
    for (std::size_t c = 0; c < of_volumes.size(); ++c)
      right_sides.block(1)[c] = of_volumes[c];

    const Operator       matrix{equations};
    const Preconditioner preconditioner{methods->multigrid,
                                        methods->of_pressure,
                                        equations};
    preconditioner.vmult(unknowns, right_sides);
    const double size = std::sqrt(std::abs(unknowns * right_sides));
    unknowns          = 0;
    solution          = 0;
    if (size == 0)
      return 0;
    dealii::SolverControl control(most_minres_iterations,
                                  minres_accuracy * size);
    try
      {
        dealii::SolverMinRes<Vector>(control).solve(matrix,
                                                    unknowns,
                                                    right_sides,
                                                    preconditioner);
      }
    catch (const dealii::SolverControl::NoConvergence &failure)
      {
        throw IterationsFailed("minimal residuals",
                               failure.last_step,
                               failure.last_residual / size);
      }
    solution = unknowns.block(0);
    return control.last_step();
  }
} // namespace limber
