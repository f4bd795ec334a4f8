// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_newton_tangent_h
#define limber_time_newton_tangent_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/fem/linear_solver.h>
#include <limber/time/ghost_penalty.h>

#include <vector>

namespace limber
{
  /**
   * The matrix of NewtonEquations. Rows and columns of held components meet
   * nothing else in it; what their correction does to the others is kept
   * besides.
   */
  template <int dim>
  class NewtonTangent
  {
  public:
    /** @p held: by equation. Both are those of the caller. */
    NewtonTangent(const NumberedNodes<dim>         &nodes,
                  const std::vector<unsigned char> &held);

    /** Room for what cells and the faces of the penalty give. */
    void
    reinit(const GhostPenalty<dim> &ghost);

    void
    clear();

    /** A block of the nodes with these numbers, row by row, N/m. */
    void
    add(const std::uint32_t *numbers,
        unsigned int         n_nodes,
        const double        *block);

    /** To the diagonal of what is free, N/m. */
    void
    add_to_diagonal(const std::vector<double> &values);

    /** Each rank has added what its points resist with; collective. */
    void
    sum_over_ranks(MPI_Comm communicator);

    /** Nothing more comes: what is held is as stiff as the rest. */
    void
    finish();

    /** For corrections @p of_held of what is held. */
    NodalVector
    right_side(const std::vector<double> &unbalanced,
               const std::vector<double> &of_held) const;

    const dealii::TrilinosWrappers::SparseMatrix &
    values() const
    {
      return matrix;
    }

  private:
    std::size_t
    size() const
    {
      return held.size();
    }

    const NumberedNodes<dim>              &nodes;
    const std::vector<unsigned char>      &held;
    dealii::TrilinosWrappers::SparseMatrix matrix;
    std::vector<std::uint32_t>             rows, columns; // of held columns
    std::vector<double>                    of_columns;
    // Of a row of a block, while it is added
    std::vector<dealii::types::global_dof_index> row_places;
    std::vector<double>                          row_values;
    double                                       largest = 0; // of the diagonal
  };
} // namespace limber

#endif
