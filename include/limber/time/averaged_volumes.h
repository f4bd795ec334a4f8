// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_averaged_volumes_h
#define limber_time_averaged_volumes_h

#include <limber/fem/mixed_solver.h>
#include <limber/time/numbered_nodes.h>

#include <array>
#include <optional>
#include <vector>

namespace limber
{
  /**
   * Mixed displacement-pressure form (saddle point system) of the volumetric
   * stiffness of nearly incompressible bodies with the treatment `cell`: the
   * averaged volume of each cell has a pressure as an unknown, instead of its
   * stiffness in the matrix of NewtonEquations (doc/theory/implicit_steps.md,
   * "What hardly changes its volume"). For linear functions.
   */
  template <int dim>
  class AveragedVolumes
  {
  public:
    /** The averaged volume of a body's points in a cell. */
    struct Volume
    {
      std::size_t                         body = 0;
      std::array<std::uint32_t, 1 << dim> numbers;
      std::array<double, dim << dim>      row;       // of B, 1/m
      double                              stiffness; // 1/C: not in A, J
      double                              kept;      // D: in A, J
      double                              shear;     // G times the volume, J
    };

    /** @p held: by equation. Both arguments must outlive the object. */
    AveragedVolumes(const NumberedNodes<dim>         &nodes,
                    const std::vector<unsigned char> &held)
      : nodes(nodes)
      , held(held)
    {}

    void
    clear();

    void
    add(const Volume &volume)
    {
      volumes.push_back(volume);
    }

    const std::vector<Volume> &
    all() const
    {
      return volumes;
    }

    /** Gather the volumes that all ranks have added; collective. */
    void
    unite_ranks(MPI_Comm communicator);

    /**
     * Solve for the displacements; see MixedSolver, also for the number that is
     * returned. @p stiffness (A) has to live until the next clear(),
     * @p motions are rigid body modes (make_multigrid()).
     */
    unsigned int
    solve(const dealii::TrilinosWrappers::SparseMatrix &stiffness,
          const std::vector<double>                    &motions,
          const std::vector<double>                    &of_held,
          const NodalVector                            &right_side,
          NodalVector                                  &solution);

  private:
    class CheckerboardFilter;

    void
    make_solver(const dealii::TrilinosWrappers::SparseMatrix &stiffness,
                const std::vector<double>                    &motions);
    void
    fill_pressure_matrix(
      const dealii::TrilinosWrappers::SparseMatrix &stiffness);

    const NumberedNodes<dim>         &nodes;
    const std::vector<unsigned char> &held;
    std::vector<Volume>               volumes;
    dealii::SparsityPattern           rows_pattern, pressure_pattern;
    dealii::SparseMatrix<double>      rows, of_pressure;
    std::vector<double>               compliance, kept, bound; // MixedSolver
    double                            least_share = 1;
    std::optional<MixedSolver>        solver;
  };
} // namespace limber

#endif
