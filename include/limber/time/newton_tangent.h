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
   * The tangent matrix of NewtonEquations. Held components (Dirichlet) are
   * eliminated: their rows and columns keep the diagonal alone, and the columns
   * are stored for the right-hand side.
   */
  template <int dim>
  class NewtonTangent
  {
  public:
    /** @p held: by equation. Both are those of the caller. */
    NewtonTangent(const NumberedNodes<dim>         &nodes,
                  const std::vector<unsigned char> &held);

    /** Set up the sparsity pattern of cells and faces of the ghost penalty. */
    void
    reinit(const GhostPenalty<dim> &ghost);

    void
    clear();

    /** Add a block of the nodes with these numbers, row by row, N/m. */
    void
    add(const std::uint32_t *numbers,
        unsigned int         n_nodes,
        const double        *block);

    /** The same for a block of the nodes that is alike for all components, and
     * zero between them. */
    void
    add_alike(const std::uint32_t *numbers,
              unsigned int         n_nodes,
              const double        *block);

    /** Add to the diagonal of free components, N/m. */
    void
    add_to_diagonal(const std::vector<double> &values);

    /** Sum up what ranks have added for their points; collective. */
    void
    sum_over_ranks(MPI_Comm communicator);

    /** Finish assembly: held components get the largest diagonal entry of the
     * others. */
    void
    finish();

    /** Right-hand side for the residual @p unbalanced and corrections @p
     * of_held of the held components. */
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
    std::vector<std::uint32_t>             rows, columns; // eliminated entries
    std::vector<double>                    of_columns;
    // Buffers for a row of a block
    std::vector<dealii::types::global_dof_index> row_places;
    std::vector<double>                          row_values;
    double                                       largest = 0; // of the diagonal
  };
} // namespace limber

#endif
