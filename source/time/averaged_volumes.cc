// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <limber/base/records_of_ranks.h>
#include <limber/time/averaged_volumes.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace limber
{
  namespace
  {
    // Share by which a node does not feel pressures around it that exert no
    // force on it. The rest accounts for the other nodes; the value was found
    // by counting iterations.
    constexpr double filtered_share = 0.999;

    // In a small-cut cell the stiffness of the nodes comes from its neighbours:
    // its compliance to its pressure follows from the diagonal of A at the
    // nodes, not from its own shear modulus. With this factor both are the same
    // in a full cell inside the body.
    constexpr double of_diagonal = 3;



    /** The volumes of one body around a node. */
    template <int dim>
    struct VolumesAround
    {
      void
      add(const std::size_t volume, const unsigned int corner)
      {
        volumes[n_volumes] = volume;
        corners[n_volumes] = corner;
        ++n_volumes;
      }

      unsigned int                        n_volumes = 0;
      std::array<std::uint32_t, 1 << dim> volumes;
      std::array<unsigned char, 1 << dim> corners; // that the node is of each
    };
  } // namespace



  /**
   * Local operator on the pressures around a node, divided by scales: keeps a
   * constant pressure and those that exert a force on the node (orthonormalised
   * by Gram-Schmidt), and reduces the rest, checkerboards, by filtered_share.
   */
  template <int dim>
  class AveragedVolumes<dim>::CheckerboardFilter
  {
  public:
    CheckerboardFilter(const VolumesAround<dim>  &around,
                       const std::vector<Volume> &volumes,
                       const std::vector<double> &scale)
    {
      std::array<double, 1 << dim> direction;
      for (int d = -1; d < dim; ++d)
        {
          for (unsigned int i = 0; i < around.n_volumes; ++i)
            {
              const std::size_t c = around.volumes[i];
              // zero where all nodes of a cell are held
              direction[i] =
                d < 0 || scale[c] == 0 ?
                  scale[c] :
                  volumes[c].row[around.corners[i] * dim + d] / scale[c];
            }
          add(direction, around.n_volumes);
        }
    }

    double
    operator()(const unsigned int i, const unsigned int j) const
    {
      double result = i == j ? 1 - filtered_share : 0;
      for (unsigned int k = 0; k < n_directions; ++k)
        result += filtered_share * directions[k][i] * directions[k][j];
      return result;
    }

  private:
    void
    add(std::array<double, 1 << dim> &direction, const unsigned int n)
    {
      const auto length = [&] {
        return std::sqrt(std::inner_product(
          direction.begin(), direction.begin() + n, direction.begin(), 0.));
      };
      const double before = length();
      for (unsigned int twice = 0; twice < 2; ++twice)
        for (unsigned int k = 0; k < n_directions; ++k)
          {
            const double part = std::inner_product(direction.begin(),
                                                   direction.begin() + n,
                                                   directions[k].begin(),
                                                   0.);
            for (unsigned int i = 0; i < n; ++i)
              direction[i] -= part * directions[k][i];
          }
      const double after = length();
      if (after <= 1e-6 * before)
        return;
      for (unsigned int i = 0; i < n; ++i)
        directions[n_directions][i] = direction[i] / after;
      ++n_directions;
    }

    unsigned int                                      n_directions = 0;
    std::array<std::array<double, 1 << dim>, dim + 1> directions;
  };



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
    equations.bound       = &bound;
    equations.least_share = least_share;
    equations.kept        = &kept;
    solver.emplace(dim, motions, equations);
  }



  // Sparse approximation Q of the Schur complement of the pressures, 1/K +
  // B A^-1 B^T (with nothing of the volumetric stiffness in A): B A^-1 B^T is
  // nearly 1/(G V), but zero for pressures that differ between the cells around
  // a node and exert no force on it. In full cells these are checkerboards,
  // which alternate in two directions or more: with s = sin^2(k/2) along x and
  // y, B A^-1 B^T is nearly proportional to 1 - 2 s_x s_y / (s_x + s_y), and
  // this matrix to 1 - s_x s_y, both zero for the checkerboard alone.
  template <int dim>
  void
  AveragedVolumes<dim>::fill_pressure_matrix(
    const dealii::TrilinosWrappers::SparseMatrix &stiffness)
  {
    constexpr unsigned int n = 1 << dim;
    using Around             = VolumesAround<dim>;
    std::vector<Around> all_around;
    for (std::size_t begin = 0, end; begin < volumes.size(); begin = end)
      {
        std::vector<Around> around(nodes.size());
        for (end = begin;
             end < volumes.size() && volumes[end].body == volumes[begin].body;
             ++end)
          for (unsigned int i = 0; i < n; ++i)
            around[volumes[end].numbers[i]].add(end, i);
        for (const Around &of_node : around)
          if (of_node.n_volumes > 0)
            all_around.push_back(of_node);
      }

    dealii::DynamicSparsityPattern pattern(volumes.size(), volumes.size());
    for (const Around &of_node : all_around)
      for (unsigned int i = 0; i < of_node.n_volumes; ++i)
        pattern.add_entries(of_node.volumes[i],
                            of_node.volumes.begin(),
                            of_node.volumes.begin() + of_node.n_volumes);
    of_pressure.clear();
    pressure_pattern.copy_from(pattern);
    of_pressure.reinit(pressure_pattern);
    bound.clear();
    least_share = 1;
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
        const double softness =
          std::min(1 / volumes[c].shear, of_diagonal * of_nodes);
        root[c]             = std::sqrt(softness / n);
        const double direct = 1 / (volumes[c].kept + volumes[c].stiffness);
        of_pressure.add(c, c, direct);
        bound.push_back(direct + softness);
        least_share =
          std::min(least_share,
                   (direct + (1 - filtered_share) * softness) / bound.back());
      }
    for (const Around &of_node : all_around)
      {
        const CheckerboardFilter filter(of_node, volumes, root);
        for (unsigned int i = 0; i < of_node.n_volumes; ++i)
          for (unsigned int j = 0; j < of_node.n_volumes; ++j)
            of_pressure.add(of_node.volumes[i],
                            of_node.volumes[j],
                            root[of_node.volumes[i]] * filter(i, j) *
                              root[of_node.volumes[j]]);
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
    // right side from prescribed displacements
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
