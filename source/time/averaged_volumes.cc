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
        volumes.push_back(volume);
        corners.push_back(corner);
      }

      // as many as a cell has corners; with levels more
      std::vector<std::uint32_t> volumes;
      std::vector<unsigned char> corners; // that the node is of each
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
      std::vector<double> direction(around.volumes.size());
      for (int d = -1; d < dim; ++d)
        {
          for (std::size_t i = 0; i < around.volumes.size(); ++i)
            {
              const std::size_t c = around.volumes[i];
              // zero where all nodes of a cell are held
              direction[i] =
                d < 0 || scale[c] == 0 ?
                  scale[c] :
                  volumes[c].row[around.corners[i] * dim + d] / scale[c];
            }
          add(direction);
        }
    }

    double
    operator()(const unsigned int i, const unsigned int j) const
    {
      double result = i == j ? 1 - filtered_share : 0;
      for (const auto &direction : directions)
        result += filtered_share * direction[i] * direction[j];
      return result;
    }

  private:
    void
    add(std::vector<double> direction)
    {
      const auto length = [&] {
        return std::sqrt(std::inner_product(
          direction.begin(), direction.end(), direction.begin(), 0.));
      };
      const double before = length();
      for (unsigned int twice = 0; twice < 2; ++twice)
        for (const auto &former : directions)
          {
            const double part = std::inner_product(direction.begin(),
                                                   direction.end(),
                                                   former.begin(),
                                                   0.);
            for (std::size_t i = 0; i < direction.size(); ++i)
              direction[i] -= part * former[i];
          }
      const double after = length();
      if (after <= 1e-6 * before)
        return;
      for (double &component : direction)
        component /= after;
      directions.push_back(std::move(direction));
    }

    std::vector<std::vector<double>> directions;
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
          if (!of_node.volumes.empty())
            all_around.push_back(of_node);
      }

    dealii::DynamicSparsityPattern pattern(volumes.size(), volumes.size());
    for (const Around &of_node : all_around)
      for (std::size_t i = 0; i < of_node.volumes.size(); ++i)
        pattern.add_entries(of_node.volumes[i],
                            of_node.volumes.begin(),
                            of_node.volumes.end());
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
        for (std::size_t i = 0; i < of_node.volumes.size(); ++i)
          for (std::size_t j = 0; j < of_node.volumes.size(); ++j)
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
