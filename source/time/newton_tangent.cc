// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <limber/base/records_of_ranks.h>
#include <limber/time/newton_tangent.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>
#include <stdexcept>

namespace limber
{
  template <int dim>
  NewtonTangent<dim>::NewtonTangent(const NumberedNodes<dim>         &nodes,
                                    const std::vector<unsigned char> &held)
    : nodes(nodes)
    , held(held)
  {}



  template <int dim>
  void
  NewtonTangent<dim>::reinit(const GhostPenalty<dim> &ghost)
  {
    dealii::DynamicSparsityPattern               pattern(size(), size());
    std::vector<dealii::types::global_dof_index> of_block;
    const auto add = [&](const auto &numbers) {
      of_block.clear();
      for (const std::uint32_t number : numbers)
        for (int d = 0; d < dim; ++d)
          of_block.push_back(std::size_t(number) * dim + d);
      std::sort(of_block.begin(), of_block.end());
      for (const auto row : of_block)
        pattern.add_entries(row, of_block.begin(), of_block.end(), true);
    };
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      add(nodes.of_cell(c));
    for (const auto &face : ghost.faces())
      add(face.nodes);
    matrix.reinit(pattern);
    // Trilinos' own functions look up and lock each row.
    if (matrix.trilinos_matrix().ExtractCrsDataPointers(row_start,
                                                        row_columns,
                                                        entries) != 0)
      throw std::logic_error("the tangent is not stored in one piece");
  }



  template <int dim>
  void
  NewtonTangent<dim>::clear()
  {
    std::fill_n(entries, row_start[size()], 0.);
    rows.clear();
    columns.clear();
    of_columns.clear();
  }



  // Components of a node are next to each other, in rows and columns.
  template <int dim>
  std::size_t
  NewtonTangent<dim>::place_in_row(const std::uint32_t row_node,
                                   const std::uint32_t column_node) const
  {
    const std::size_t row  = std::size_t(row_node) * dim;
    const int *const begin = row_columns + row_start[row], *const end =
                                                             row_columns +
                                                             row_start[row + 1];
    return std::lower_bound(begin, end, int(column_node) * dim) - begin;
  }



  template <int dim>
  template <class Value>
  void
  NewtonTangent<dim>::add_block(const std::uint32_t *const numbers,
                                const unsigned int         n_nodes,
                                const Value               &value)
  {
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int j = 0; j < n_nodes; ++j)
        {
          const std::size_t place = place_in_row(numbers[i], numbers[j]);
          for (int d = 0; d < dim; ++d)
            {
              const std::size_t row = std::size_t(numbers[i]) * dim + d;
              if (held[row])
                continue;
              double *const entry = entries + row_start[row] + place;
              value(i, j, d, [&](const int e, const double summand) {
                const std::size_t column = std::size_t(numbers[j]) * dim + e;
                if (!held[column])
                  {
                    entry[e] += summand;
                    return;
                  }
                rows.push_back(row);
                columns.push_back(column);
                of_columns.push_back(summand);
              });
            }
        }
  }



  template <int dim>
  void
  NewtonTangent<dim>::add(const std::uint32_t *const numbers,
                          const unsigned int         n_nodes,
                          const double *const        block)
  {
    add_block(numbers,
              n_nodes,
              [&](const unsigned int i,
                  const unsigned int j,
                  const int          d,
                  const auto        &give) {
                const double *const from =
                  block + std::size_t(i * dim + d) * n_nodes * dim + j * dim;
                for (int e = 0; e < dim; ++e)
                  give(e, from[e]);
              });
  }



  template <int dim>
  void
  NewtonTangent<dim>::add_alike(const std::uint32_t *const numbers,
                                const unsigned int         n_nodes,
                                const double *const        block)
  {
    add_block(numbers,
              n_nodes,
              [&](const unsigned int i,
                  const unsigned int j,
                  const int          d,
                  const auto &give) { give(d, block[i * n_nodes + j]); });
  }



  template <int dim>
  double &
  NewtonTangent<dim>::on_diagonal(const std::size_t row)
  {
    const std::uint32_t node = row / dim;
    return entries[row_start[row] + place_in_row(node, node) + row % dim];
  }



  template <int dim>
  void
  NewtonTangent<dim>::add_to_diagonal(const std::vector<double> &values)
  {
    for (std::size_t k = 0; k < size(); ++k)
      if (!held[k])
        on_diagonal(k) += values[k];
  }



  template <int dim>
  void
  NewtonTangent<dim>::sum_over_ranks(const MPI_Comm communicator)
  {
    if (!nodes.is_parallel())
      return;
    nodes.sum(entries, row_start[size()]);
    unite(rows, communicator);
    unite(columns, communicator);
    unite(of_columns, communicator);
  }



  template <int dim>
  void
  NewtonTangent<dim>::finish()
  {
    largest = 0;
    for (std::size_t k = 0; k < size(); ++k)
      if (!held[k])
        largest = std::max(largest, on_diagonal(k));
    for (std::size_t k = 0; k < size(); ++k)
      if (held[k])
        on_diagonal(k) = largest;
  }



  template <int dim>
  NodalVector
  NewtonTangent<dim>::right_side(const std::vector<double> &unbalanced,
                                 const std::vector<double> &of_held) const
  {
    NodalVector result(size());
    for (std::size_t k = 0; k < size(); ++k)
      result[k] = held[k] ? of_held[k] * largest : unbalanced[k];
    for (std::size_t e = 0; e < rows.size(); ++e)
      result[rows[e]] -= of_columns[e] * of_held[columns[e]];
    return result;
  }



  template class NewtonTangent<2>;
  template class NewtonTangent<3>;
} // namespace limber
