// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/parpack_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <limber/base/exceptions.h>
#include <limber/fem/natural_modes.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    using Vector = dealii::TrilinosWrappers::MPI::Vector;

    // Eigenvalues (squares of circular frequencies) below this share of the
    // shift are zero: rigid motions.
    constexpr double round_off = 1e-5;



    /**
     * Mass matrix, or the inverse of K + s M, on components that are not held.
     */
    template <int dim>
    class Operator
    {
    public:
      Operator(const SolidModel<dim> &model, LinearSolver *solver)
        : model(model)
        , solver(solver)
        , source(model.make_vector())
        , result(model.make_vector())
      {}

      void
      vmult(Vector &to, const Vector &from) const
      {
        for (const auto i : from.locally_owned_elements())
          source[i] = from[i];
        model.held().clear(source);
        if (solver != nullptr)
          solver->solve(result, source);
        else
          model.mass_matrix().vmult(result, source);
        model.held().clear(result);
        for (const auto i : from.locally_owned_elements())
          to[i] = result[i];
        to.compress(dealii::VectorOperation::insert);
      }

    private:
      const SolidModel<dim> &model;
      LinearSolver *const    solver;
      mutable NodalVector    source, result;
    };
  } // namespace



  template <int dim>
  NaturalFrequencies
  natural_frequencies(const SolidModel<dim> &model, const unsigned int count)
  {
    // The shift is of the order of the lowest eigenvalues, and positive so that
    // K + s M is regular in spite of rigid motions.
    const double shift =
      std::pow(model.element->shear_wave_speed /
                 model.problem.grid.lower.distance(model.problem.grid.upper),
               2);
    typename SolidModel<dim>::Matrix matrix;
    model.reinit(matrix);
    model.assemble(model.make_vector(), shift, matrix);
    LinearSolver solver(is_small(model) ? SolutionMethod::cholesky :
                                          SolutionMethod::conjugate_gradients,
                        dim,
                        model.rigid_motions());
    solver.set_matrix(matrix);

    const unsigned int n_modes   = count + (dim == 2 ? 3 : 6);
    const unsigned int n_vectors = 2 * n_modes + 20;
    if (n_vectors >= model.dof_handler.n_dofs() / 2)
      throw InputError("The mesh of the reference has too few nodes for " +
                       std::to_string(count) +
                       " natural frequencies ('Reference/Frequencies'). Set "
                       "'Reference/Elements over depth' to 4 or more.");

    using Solver = dealii::PArpackSolver<Vector>;
    dealii::SolverControl control(1000, 1e-10);
    Solver                lanczos(control,
                   model.communicator,
                   Solver::AdditionalData(n_vectors,
                                          Solver::largest_magnitude,
                                          true));
    const auto           &owned = model.dof_handler.locally_owned_dofs();
    lanczos.reinit(owned);
    lanczos.set_shift(-shift);
    std::vector<std::complex<double>> values(n_modes);
    std::vector<Vector> vectors(n_modes, Vector(owned, model.communicator));
    try
      {
        lanczos.solve(matrix,
                      Operator<dim>(model, nullptr),
                      Operator<dim>(model, &solver),
                      values,
                      vectors,
                      n_modes);
      }
    catch (const dealii::ExceptionBase &)
      {
        throw ComputationError(
          "The eigensolver of the finite element reference does not converge "
          "to " +
          std::to_string(count) +
          " natural frequencies. Set 'Reference/Frequencies' lower, or "
          "'Reference/Elements over depth' higher.");
      }

    std::vector<double> squares;
    for (const auto &value : values)
      squares.push_back(value.real());
    std::sort(squares.begin(), squares.end());
    NaturalFrequencies result;
    for (const double square : squares)
      if (square < round_off * shift)
        ++result.n_rigid_motions;
      else if (result.frequencies.size() < count)
        result.frequencies.push_back(std::sqrt(square) /
                                     (2 * dealii::numbers::PI));
    return result;
  }



  template NaturalFrequencies
  natural_frequencies(const SolidModel<2> &, const unsigned int);
  template NaturalFrequencies
  natural_frequencies(const SolidModel<3> &, const unsigned int);
} // namespace limber
