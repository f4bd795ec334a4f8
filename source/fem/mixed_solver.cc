// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/diagonal_matrix.h>
#include <deal.II/lac/la_parallel_block_vector.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_gmres.h>

#include <limber/fem/mixed_solver.h>
#include <limber/fem/multigrid.h>

namespace limber
{
  namespace
  {
    constexpr unsigned int most_iterations = 500;
    // of the Krylov space; GMRES restarts beyond
    constexpr unsigned int most_vectors = 150;
    // relative, of the preconditioned residual
    constexpr double accuracy = 1e-10;
    // All tuned by counting iterations and seconds. The degree of the Chebyshev
    // polynomial is this times the square root of its range of eigenvalues: an
    // eighth of the error is left.
    constexpr double    chebyshev_degree = 1.4;
    const MultigridForm multigrid_form{3, "MGV", 1.5};
    constexpr double    weight_of_pressure = 0.6;

    using Vector = dealii::LinearAlgebra::distributed::BlockVector<double>;



    using Chebyshev =
      dealii::PreconditionChebyshev<dealii::SparseMatrix<double>, NodalVector>;



    /** Preconditioned equations for scaled unknowns (GMRES works on these). */
    struct ScaledEquations
    {
      ScaledEquations(
        const MixedSolver::Equations                    &equations,
        const dealii::TrilinosWrappers::PreconditionAMG &multigrid,
        const Chebyshev                                 &of_pressure);

      void
      precondition(Vector &unknowns, const Vector &right_sides) const;

      void
      vmult(Vector &out, const Vector &in) const
      {
        unscaled = in;
        unscaled.scale(inverse_scale);
        equations.stiffness->vmult(image.block(0), unscaled.block(0));
        equations.rows->Tvmult_add(image.block(0), unscaled.block(1));
        equations.rows->vmult(image.block(1), unscaled.block(0));
        for (std::size_t c = 0; c < equations.compliance->size(); ++c)
          image.block(1)[c] -=
            (*equations.compliance)[c] * unscaled.block(1)[c];
        precondition(out, image);
        out.scale(scale);
      }

      const MixedSolver::Equations                    &equations;
      const dealii::TrilinosWrappers::PreconditionAMG &multigrid;
      const Chebyshev                                 &of_pressure;
      // with this scaling by the diagonal the residual is nearly the energy of
      // the error, with both kinds of unknowns in the same unit
      Vector scale, inverse_scale;

    private:
      mutable Vector      unscaled, image;
      NodalVector         share; // 1 - a
      mutable NodalVector volume, shared_volume;
    };



    ScaledEquations::ScaledEquations(
      const MixedSolver::Equations                    &equations,
      const dealii::TrilinosWrappers::PreconditionAMG &multigrid,
      const Chebyshev                                 &of_pressure)
      : equations(equations)
      , multigrid(multigrid)
      , of_pressure(of_pressure)
      , scale(2)
      , share(equations.compliance->size())
      , volume(share.size())
      , shared_volume(share.size())
    {
      scale.block(0).reinit(equations.stiffness->m());
      scale.block(1).reinit(volume.size());
      scale.collect_sizes();
      for (std::size_t k = 0; k < scale.block(0).size(); ++k)
        scale.block(0)[k] = std::sqrt(equations.stiffness->diag_element(k));
      for (std::size_t c = 0; c < volume.size(); ++c)
        {
          const double kept = (*equations.kept)[c];
          share[c]          = 1 / (1 + kept * (*equations.compliance)[c]);
          scale.block(1)[c] =
            1 / std::sqrt(
                  share[c] *
                  (share[c] / equations.of_pressure->diag_element(c) + kept));
        }
      inverse_scale = scale;
      for (unsigned int b = 0; b < 2; ++b)
        for (double &value : inverse_scale.block(b))
          value = 1 / value;
      unscaled = image = scale;
    }



    // Block triangular: first the displacements without a change of pressure,
    // then the pressures that their change of volume needs (Schur complement)
    void
    ScaledEquations::precondition(Vector       &unknowns,
                                  const Vector &right_sides) const
    {
      multigrid.vmult(unknowns.block(0), right_sides.block(0));
      equations.rows->vmult(volume, unknowns.block(0));
      volume -= right_sides.block(1);
      NodalVector &pressure = unknowns.block(1);
      shared_volume         = volume;
      shared_volume.scale(share);
      of_pressure.vmult(pressure, shared_volume);
      for (std::size_t c = 0; c < volume.size(); ++c)
        pressure[c] = weight_of_pressure * share[c] *
                      (pressure[c] + (*equations.kept)[c] * volume[c]);
    }
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
    settings.smoothing_range = 1 / equations.least_share;
    settings.degree =
      std::ceil(chebyshev_degree * std::sqrt(settings.smoothing_range));
    settings.eig_cg_n_iterations = 0;
    settings.max_eigenvalue      = 1;
    settings.preconditioner =
      std::make_shared<dealii::DiagonalMatrix<NodalVector>>();
    NodalVector &diagonal = settings.preconditioner->get_vector();
    diagonal.reinit(equations.of_pressure->m());
    for (std::size_t c = 0; c < equations.of_pressure->m(); ++c)
      diagonal[c] = 1 / (*equations.bound)[c];
    methods->of_pressure.initialize(*equations.of_pressure, settings);
  }



  MixedSolver::~MixedSolver() = default;



  unsigned int
  MixedSolver::solve(NodalVector               &solution,
                     const NodalVector         &right_side,
                     const std::vector<double> &of_volumes) const
  {
    const ScaledEquations scaled(equations,
                                 methods->multigrid,
                                 methods->of_pressure);
    Vector                right_sides(scaled.scale), start(scaled.scale);
    right_sides.block(0) = right_side;
    for (std::size_t c = 0; c < of_volumes.size(); ++c)
      right_sides.block(1)[c] = of_volumes[c];
    scaled.precondition(start, right_sides);
    start.scale(scaled.scale);
    const double size = start.l2_norm();
    solution          = 0;
    if (size == 0)
      return 0;
    Vector unknowns(scaled.scale);
    unknowns = 0;
    dealii::SolverControl control(most_iterations, accuracy * size);
    try
      {
        dealii::SolverGMRES<Vector>(
          control, dealii::SolverGMRES<Vector>::AdditionalData(most_vectors))
          .solve(scaled, unknowns, start, dealii::PreconditionIdentity());
      }
    catch (const dealii::SolverControl::NoConvergence &failure)
      {
        throw IterationsFailed("generalised minimal residuals",
                               failure.last_step,
                               failure.last_residual / size);
      }
    unknowns.scale(scaled.inverse_scale);
    solution = unknowns.block(0);
    return control.last_step();
  }
} // namespace limber
