// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/shifting_potential.h>

#include <algorithm>
#include <array>

namespace limber
{
  namespace
  {
    // Bounds of the eigenvalues of the matrix with Jacobi's preconditioner: the
    // largest one of linear functions on squares and cubes is 1.5; the smallest
    // one here is that of a layer of eight cells over a wall. What is deeper
    // converges more slowly.
    constexpr double largest = 1.6, smallest = largest / 100;

    // Leaves at most 2 ((10 - 1) / (10 + 1))^20 = 4 % of the error.
    constexpr unsigned int n_iterations = 20;



    /** Integrals of grad N_a . grad N_b over the unit cell. */
    template <int dim>
    std::array<std::array<double, 1 << dim>, 1 << dim>
    stiffness()
    {
      std::array<std::array<double, 1 << dim>, 1 << dim> result{};
      for (unsigned int a = 0; a < 1u << dim; ++a)
        for (unsigned int b = 0; b < 1u << dim; ++b)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double product = 1;
              for (unsigned int e = 0; e < dim; ++e)
                {
                  const bool same = (a >> e & 1) == (b >> e & 1);
                  product *=
                    e == d ? (same ? 1. : -1.) : (same ? 1. / 3 : 1. / 6);
                }
              result[a][b] += product;
            }
      return result;
    }
  } // namespace



  template <int dim>
  void
  ShiftingPotential<dim>::reinit()
  {
    records.reinit(std::size_t(grid.vertices.n()) * Record::stride);
  }



  template <int dim>
  void
  ShiftingPotential<dim>::clear(const NodalFields<dim> &vertices)
  {
    for (const std::uint32_t node : vertices.active_nodes())
      std::fill_n(record(node), Record::stride, 0.);
    cells.clear();
  }



  template <int dim>
  void
  ShiftingPotential<dim>::add_cell(const std::uint32_t cell,
                                   const double        volume)
  {
    static const auto matrix = stiffness<dim>();
    cells.push_back({cell, volume});
    for (unsigned int a = 0; a < n_corners; ++a)
      record_at(cell, a)[Record::diagonal] += volume * matrix[a][a];
  }



  // Sum over ranks of a slot to which cells of this rank have been added.
  template <int dim>
  void
  ShiftingPotential<dim>::sum_over_cells(const NodalFields<dim> &vertices,
                                         const unsigned int      slot)
  {
    exchange.start(vertices.node_plan(), records.data(), slot, slot + 1);
    exchange.finish(records.data());
  }



  template <int dim>
  void
  ShiftingPotential<dim>::multiply(const NodalFields<dim> &vertices)
  {
    static const auto matrix = stiffness<dim>();
    for (const std::uint32_t node : vertices.active_nodes())
      record(node)[Record::product] = 0;
    for (const Cell &cell : cells)
      {
        std::array<double, n_corners> direction;
        for (unsigned int a = 0; a < n_corners; ++a)
          direction[a] = record_at(cell.number, a)[Record::direction];
        for (unsigned int a = 0; a < n_corners; ++a)
          {
            double sum = 0;
            for (unsigned int b = 0; b < n_corners; ++b)
              sum += matrix[a][b] * direction[b];
            record_at(cell.number, a)[Record::product] += cell.volume * sum;
          }
      }
    sum_over_cells(vertices, Record::product);
  }



  // Chebyshev iteration: Y. Saad, Iterative methods for sparse linear systems,
  // 2003, algorithm 12.1
  template <int dim>
  void
  ShiftingPotential<dim>::solve(const NodalFields<dim> &vertices)
  {
    const std::vector<std::uint32_t> &nodes = vertices.active_nodes();
    sum_over_cells(vertices, Record::diagonal);
    const auto correction = [&](const double *const of_node) {
      return of_node[Record::is_free] != 0 && of_node[Record::diagonal] > 0 ?
               of_node[Record::residual] / of_node[Record::diagonal] :
               0.;
    };
    constexpr double middle = 0.5 * (largest + smallest),
                     half   = 0.5 * (largest - smallest);
    double rho              = half / middle;
    for (const std::uint32_t node : nodes)
      record(node)[Record::direction] = correction(record(node)) / middle;
    for (unsigned int k = 0; k < n_iterations; ++k)
      {
        multiply(vertices);
        const double former = rho;
        rho                 = 1 / (2 * middle / half - former);
        for (const std::uint32_t node : nodes)
          {
            double *const of_node = record(node);
            of_node[Record::potential] += of_node[Record::direction];
            of_node[Record::residual] -= of_node[Record::product];
            of_node[Record::direction] =
              rho * (former * of_node[Record::direction] +
                     2 / half * correction(of_node));
          }
      }
  }



  template class ShiftingPotential<2>;
  template class ShiftingPotential<3>;
} // namespace limber
