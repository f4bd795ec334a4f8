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
    // vectors that are kept; iterations start again beyond
    constexpr unsigned int most_vectors = 150;
    // of the preconditioned residual
    constexpr double accuracy = 1e-10;
    // All by counting iterations and seconds; with A^-1 itself instead of the
    // cycle half as many would do where cells are full, and three quarters to
    // nine tenths where they are cut.
    constexpr unsigned int chebyshev_degree = 10;
    // largest over smallest eigenvalue that the polynomial cares for
    constexpr double    chebyshev_range = 50;
    const MultigridForm multigrid_form{3, "MGV", 1.5};
    constexpr double    weight_of_pressure = 0.8;

    using Vector = dealii::LinearAlgebra::distributed::BlockVector<double>;



    using Chebyshev =
      dealii::PreconditionChebyshev<dealii::SparseMatrix<double>, NodalVector>;



    // What the volume of a cell gives in to its pressure, inverted: the exact
    // inverse of MixedSolver, given Q^-1 of the change @p volume
    double
    pressure_of(const double volume,
                const double by_inverse_of_q,
                const double compliance,
                const double kept)
    {
      const double share = 1 / (1 + kept * compliance);
      return share * (share * by_inverse_of_q + kept * volume);
    }



    /** Preconditioned equations for scaled unknowns. */
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
      // the residual is nearly the energy of the error, as the diagonal tells
      // it: both kinds of unknowns in the same unit
      Vector scale, inverse_scale;

    private:
      mutable Vector      unscaled, image;
      mutable NodalVector volume;
    };



    ScaledEquations::ScaledEquations(
      const MixedSolver::Equations                    &equations,
      const dealii::TrilinosWrappers::PreconditionAMG &multigrid,
      const Chebyshev                                 &of_pressure)
      : equations(equations)
      , multigrid(multigrid)
      , of_pressure(of_pressure)
      , scale(2)
      , volume(equations.compliance->size())
    {
      scale.block(0).reinit(equations.stiffness->m());
      scale.block(1).reinit(volume.size());
      scale.collect_sizes();
      for (std::size_t k = 0; k < scale.block(0).size(); ++k)
        scale.block(0)[k] = std::sqrt(equations.stiffness->diag_element(k));
      for (std::size_t c = 0; c < volume.size(); ++c)
        scale.block(1)[c] =
          1 / std::sqrt(pressure_of(1,
                                    1 / equations.of_pressure->diag_element(c),
                                    (*equations.compliance)[c],
                                    (*equations.kept)[c]));
      inverse_scale = scale;
      for (unsigned int b = 0; b < 2; ++b)
        for (double &value : inverse_scale.block(b))
          value = 1 / value;
      unscaled = image = scale;
    }



    // First the displacements without a change of pressure, then the pressures
    // that the volumes, as these leave them, need
    void
    ScaledEquations::precondition(Vector       &unknowns,
                                  const Vector &right_sides) const
    {
      multigrid.vmult(unknowns.block(0), right_sides.block(0));
      equations.rows->vmult(volume, unknowns.block(0));
      volume -= right_sides.block(1);
      NodalVector &pressure = unknowns.block(1);
      of_pressure.vmult(pressure, volume);
      for (std::size_t c = 0; c < volume.size(); ++c)
        pressure[c] =
          weight_of_pressure * pressure_of(volume[c],
                                           pressure[c],
                                           (*equations.compliance)[c],
                                           (*equations.kept)[c]);
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
