// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <limber/base/records_of_ranks.h>
#include <limber/time/averaged_volumes.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace limber
{
  namespace
  {
    constexpr std::uint32_t not_numbered = 0xffffffffu;

    // Of what an unbounded body gives in to a pressure that alternates: the
    // share that cells know of. The rest is for surfaces and sides, found by
    // counting iterations.
    constexpr double alternating_share = 0.97;

    // A cell that is hardly filled hangs on nodes that others hold: it gives in
    // to its pressure as these do, by the diagonal of their stiffness, and not
    // as if its own shear modulus alone held it. The factor makes both the same
    // in a full cell amidst others.
    constexpr double of_diagonal = 3;
  } // namespace



  template <int dim>
  void
  AveragedVolumes<dim>::clear()
  {
    volumes.clear();
    solver.reset();
  }



  template <int dim>
  void
  AveragedVolumes<dim>::unite_ranks(const MPI_Comm communicator)
  {
    unite(volumes, communicator);
    std::stable_sort(volumes.begin(),
                     volumes.end(),
                     [](const auto &a, const auto &b) {
                       return std::tie(a.body, a.numbers) <
                              std::tie(b.body, b.numbers);
                     });
  }



  template <int dim>
  void
  AveragedVolumes<dim>::make_solver(
    const dealii::TrilinosWrappers::SparseMatrix &stiffness,
    const std::vector<double>                    &motions)
  {
    const auto for_each_free = [&](const auto &work) {
      for (std::size_t c = 0; c < volumes.size(); ++c)
        for (unsigned int k = 0; k < volumes[c].row.size(); ++k)
          {
            const std::size_t column =
              std::size_t(volumes[c].numbers[k / dim]) * dim + k % dim;
            if (!held[column])
              work(c, column, volumes[c].row[k]);
          }
    };
    rows.clear();
    rows_pattern.reinit(volumes.size(), held.size(), dim << dim);
    for_each_free([&](const std::size_t c, const std::size_t column, double) {
      rows_pattern.add(c, column);
    });
    rows_pattern.compress();
    rows.reinit(rows_pattern);
    for_each_free([&](const std::size_t c,
                      const std::size_t column,
                      const double      value) { rows.set(c, column, value); });
    compliance.clear();
    kept.clear();
    for (const Volume &volume : volumes)
      {
        compliance.push_back(1 / volume.stiffness);
        kept.push_back(volume.kept);
      }
    fill_pressure_matrix(stiffness);
    MixedSolver::Equations equations;
    equations.stiffness   = &stiffness;
    equations.rows        = &rows;
    equations.compliance  = &compliance;
    equations.of_pressure = &of_pressure;
    equations.kept        = &kept;
    solver.emplace(dim, motions, equations);
  }



  // What volumes give in to pressures, where the matrix keeps nothing of their
  // stiffness, 1/K + B A^-1 B^T, nearly: V/G, but nothing where pressures
  // alternate from cell to cell in two directions or more, as they move no
  // node. Of s = sin^2(k/2) along x and y, B A^-1 B^T is nearly proportional to
  // 1 - 2 s_x s_y / (s_x + s_y), and this matrix to 1 - s_x s_y, both zero in
  // the pattern alone.
  template <int dim>
  void
  AveragedVolumes<dim>::fill_pressure_matrix(
    const dealii::TrilinosWrappers::SparseMatrix &stiffness)
  {
    constexpr unsigned int n = 1 << dim;
    using Around = std::array<std::uint32_t, n>; // volumes around a node
    std::vector<Around> complete;
    Around              nothing;
    nothing.fill(not_numbered);
    for (std::size_t begin = 0, end; begin < volumes.size(); begin = end)
      {
        std::vector<Around> around(nodes.size(), nothing);
        for (end = begin;
             end < volumes.size() && volumes[end].body == volumes[begin].body;
             ++end)
          for (unsigned int i = 0; i < n; ++i)
            around[volumes[end].numbers[i]][n - 1 - i] = end;
        for (const Around &of_node : around)
          if (std::count(of_node.begin(), of_node.end(), not_numbered) == 0)
            complete.push_back(of_node);
      }

    dealii::DynamicSparsityPattern pattern(volumes.size(), volumes.size());
    for (std::size_t c = 0; c < volumes.size(); ++c)
      pattern.add(c, c);
    for (const Around &of_node : complete)
      for (const std::uint32_t c : of_node)
        pattern.add_entries(c, of_node.begin(), of_node.end());
    of_pressure.clear();
    pressure_pattern.copy_from(pattern);
    of_pressure.reinit(pressure_pattern);
    std::vector<double> root(volumes.size());
    for (std::size_t c = 0; c < volumes.size(); ++c)
      {
        double of_nodes = 0;
        for (unsigned int k = 0; k < volumes[c].row.size(); ++k)
          {
            const std::size_t column =
              std::size_t(volumes[c].numbers[k / dim]) * dim + k % dim;
            if (!held[column])
              of_nodes += volumes[c].row[k] * volumes[c].row[k] /
                          stiffness.diag_element(column);
          }
        root[c] =
          std::sqrt(std::min(1 / volumes[c].shear, of_diagonal * of_nodes));
        of_pressure.add(c,
                        c,
                        1 / (volumes[c].kept + volumes[c].stiffness) +
                          root[c] * root[c]);
      }
    for (const Around &of_node : complete)
      for (unsigned int directions = 0; directions < n; ++directions)
        if (__builtin_popcount(directions) >= 2)
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              {
                const double sign =
                  __builtin_popcount((i ^ j) & directions) % 2 == 0 ? 1 : -1;
                of_pressure.add(of_node[i],
                                of_node[j],
                                -alternating_share * sign * root[of_node[i]] *
                                  root[of_node[j]] / (n * n));
              }
  }



  template <int dim>
  unsigned int
  AveragedVolumes<dim>::solve(
    const dealii::TrilinosWrappers::SparseMatrix &stiffness,
    const std::vector<double>                    &motions,
    const std::vector<double>                    &of_held,
    const NodalVector                            &right_side,
    NodalVector                                  &solution)
  {
    if (!solver)
      make_solver(stiffness, motions);
    // what held components do to the volumes
    std::vector<double> of_volumes;
    for (const Volume &volume : volumes)
      {
        of_volumes.push_back(0);
        for (unsigned int k = 0; k < volume.row.size(); ++k)
          {
            const std::size_t column =
              std::size_t(volume.numbers[k / dim]) * dim + k % dim;
            if (held[column])
              of_volumes.back() -= volume.row[k] * of_held[column];
          }
      }
    return solver->solve(solution, right_side, of_volumes);
  }



  template class AveragedVolumes<2>;
  template class AveragedVolumes<3>;
} // namespace limber
