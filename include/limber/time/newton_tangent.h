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

    std::size_t
    place_in_row(std::uint32_t row_node, std::uint32_t column_node) const;
    template <class Value>
    void
    add_block(const std::uint32_t *numbers,
              unsigned int         n_nodes,
              const Value         &value);
    double &
    on_diagonal(std::size_t row);

    const NumberedNodes<dim>              &nodes;
    const std::vector<unsigned char>      &held;
    dealii::TrilinosWrappers::SparseMatrix matrix;
    std::vector<std::uint32_t>             rows, columns; // eliminated entries
    std::vector<double>                    of_columns;
    double                                 largest = 0; // of the diagonal
    // Storage of the matrix
    int    *row_start = nullptr, *row_columns = nullptr;
    double *entries = nullptr;
  };
} // namespace limber

#endif
