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
  }



  template <int dim>
  void
  NewtonTangent<dim>::clear()
  {
    matrix = 0;
    rows.clear();
    columns.clear();
    of_columns.clear();
  }



  template <int dim>
  void
  NewtonTangent<dim>::add(const std::uint32_t *const numbers,
                          const unsigned int         n_nodes,
                          const double *const        block)
  {
    const unsigned int n = n_nodes * dim;
    row_places.resize(n);
    row_values.resize(n);
    for (unsigned int k = 0; k < n; ++k)
      {
        const std::size_t row = std::size_t(numbers[k / dim]) * dim + k % dim;
        if (held[row])
          continue;
        unsigned int found = 0;
        for (unsigned int l = 0; l < n; ++l)
          {
            const std::size_t column =
              std::size_t(numbers[l / dim]) * dim + l % dim;
            if (held[column])
              {
                rows.push_back(row);
                columns.push_back(column);
                of_columns.push_back(block[k * n + l]);
                continue;
              }
            row_places[found]   = column;
            row_values[found++] = block[k * n + l];
          }
        matrix.add(
          row, found, row_places.data(), row_values.data(), false, false);
      }
  }



  template <int dim>
  void
  NewtonTangent<dim>::add_alike(const std::uint32_t *const numbers,
                                const unsigned int         n_nodes,
                                const double *const        block)
  {
    row_places.resize(n_nodes);
    row_values.resize(n_nodes);
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (int d = 0; d < dim; ++d)
        {
          const std::size_t row = std::size_t(numbers[i]) * dim + d;
          if (held[row])
            continue;
          unsigned int found = 0;
          for (unsigned int j = 0; j < n_nodes; ++j)
            {
              const std::size_t column = std::size_t(numbers[j]) * dim + d;
              const double      value  = block[i * n_nodes + j];
              if (held[column])
                {
                  rows.push_back(row);
                  columns.push_back(column);
                  of_columns.push_back(value);
                  continue;
                }
              row_places[found]   = column;
              row_values[found++] = value;
            }
          matrix.add(
            row, found, row_places.data(), row_values.data(), false, false);
        }
  }



  template <int dim>
  void
  NewtonTangent<dim>::add_to_diagonal(const std::vector<double> &values)
  {
    for (std::size_t k = 0; k < size(); ++k)
      if (!held[k])
        matrix.add(k, k, values[k]);
  }



  template <int dim>
  void
  NewtonTangent<dim>::sum_over_ranks(const MPI_Comm communicator)
  {
    matrix.compress(dealii::VectorOperation::add);
    if (!nodes.is_parallel())
      return;
    const Epetra_CrsMatrix &stored = matrix.trilinos_matrix();
    int                    *starts = nullptr, *places = nullptr;
    double                 *values = nullptr;
    if (stored.ExtractCrsDataPointers(starts, places, values) != 0)
      throw std::logic_error("the tangent is not stored in one piece");
    nodes.sum(values, stored.NumMyNonzeros());

    unite(rows, communicator);
    unite(columns, communicator);
    unite(of_columns, communicator);
  }



  template <int dim>
  void
  NewtonTangent<dim>::finish()
  {
    matrix.compress(dealii::VectorOperation::add);
    largest = 0;
    for (std::size_t k = 0; k < size(); ++k)
      if (!held[k])
        largest = std::max(largest, matrix.diag_element(k));
    for (std::size_t k = 0; k < size(); ++k)
      if (held[k])
        matrix.set(k, k, largest);
    matrix.compress(dealii::VectorOperation::insert);
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
