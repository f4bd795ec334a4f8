// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/grid/grid_generator.h>

#include <limber/grid/background_grid.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    /** The same owners and ghosts, with @p stride numbers in place of one. */
    std::shared_ptr<const Partitioner>
    scale(const Partitioner &one, const unsigned int stride)
    {
      const auto widen = [stride](const dealii::IndexSet &set) {
        dealii::IndexSet wide(set.size() * stride);
        for (auto range = set.begin_intervals(); range != set.end_intervals();
             ++range)
          wide.add_range(*range->begin() * stride,
                         (range->last() + 1) * stride);
        wide.compress();
        return wide;
      };
      return std::make_shared<Partitioner>(widen(one.locally_owned_range()),
                                           widen(one.ghost_indices()),
                                           one.get_mpi_communicator());
    }



    /** Local numbers of what is owned here and held elsewhere, ascending. */
    std::vector<std::uint32_t>
    exported(const Partitioner &partitioner)
    {
      std::vector<std::uint32_t> result;
      for (const auto &[begin, end] : partitioner.import_indices())
        for (unsigned int i = begin; i < end; ++i)
          result.push_back(i);
      std::sort(result.begin(), result.end());
      result.erase(std::unique(result.begin(), result.end()), result.end());
      return result;
    }
  } // namespace



  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridDescription<dim> &description,
                                      const MPI_Comm              communicator)
    : description(description)
    , communicator(communicator)
    , triangulation(
        communicator,
        dealii::Triangulation<dim>::limit_level_difference_at_vertices)
    , node_handler(triangulation)
    , cell_handler(triangulation)
  {
    std::vector<unsigned int> coarse(description.cells.begin(),
                                     description.cells.end());
    unsigned int              refinements = 0;
    while (std::all_of(coarse.begin(), coarse.end(), [](const unsigned int n) {
      return n % 2 == 0;
    }))
      {
        for (unsigned int &n : coarse)
          n /= 2;
        ++refinements;
      }
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                      coarse,
                                                      description.lower,
                                                      description.upper,
                                                      /*colorize=*/true);
    triangulation.refine_global(refinements);
    // Refinement needs for a while twice what the mesh keeps; points come next.
    malloc_trim(0);
    rebuild();
  }



  template <int dim>
  void
  BackgroundGrid<dim>::rebuild()
  {
    node_handler.distribute_dofs(node_element);
    cell_handler.distribute_dofs(cell_element);

    dealii::IndexSet relevant_nodes, relevant_cells;
    dealii::DoFTools::extract_locally_relevant_dofs(node_handler,
                                                    relevant_nodes);
    dealii::DoFTools::extract_locally_relevant_dofs(cell_handler,
                                                    relevant_cells);
    constraints.clear();
    constraints.reinit(relevant_nodes);
    dealii::DoFTools::make_hanging_node_constraints(node_handler, constraints);
    constraints.close();
    // Masters of relevant nodes may lie beyond the ghost layer.
    for (const auto &line : constraints.get_lines())
      for (const auto &[master, weight] : line.entries)
        relevant_nodes.add_index(master);

    node_partitioner =
      std::make_shared<Partitioner>(node_handler.locally_owned_dofs(),
                                    relevant_nodes,
                                    communicator);
    cell_partitioner =
      std::make_shared<Partitioner>(cell_handler.locally_owned_dofs(),
                                    relevant_cells,
                                    communicator);

    build_cells();
    build_ghost_cells(*cell_partitioner);
    build_bins();
    build_hanging_nodes();
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_cells()
  {
    geometry.assign(n_cells(), {});
    boundary_places.clear();
    sides_of_node.assign(n_nodes(), 0);
    cell_numbers.assign(triangulation.n_active_cells(), invalid_cell);

    double                                       smallest = 1e300;
    std::vector<dealii::types::global_dof_index> nodes(1 << dim), self(1);
    for (const auto &cell : node_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          typename dealii::DoFHandler<dim>::active_cell_iterator own(
            &triangulation, cell->level(), cell->index(), &cell_handler);
          own->get_dof_indices(self);
          const std::uint32_t number =
            cell_partitioner->global_to_local(self[0]);
          cell_numbers[cell->active_cell_index()] = number;

          CellGeometry<dim> &entry = geometry[number];
          const auto         lower = cell->vertex(0);
          const auto         edge  = cell->vertex((1 << dim) - 1) - lower;
          for (int d = 0; d < dim; ++d)
            {
              entry.origin[d]       = lower[d];
              entry.inverse_edge[d] = 1 / edge[d];
              smallest              = std::min(smallest, edge[d]);
            }
          cell->get_dof_indices(nodes);
          for (unsigned int i = 0; i < nodes.size(); ++i)
            entry.node[i] = node_partitioner->global_to_local(nodes[i]) *
                            NodeLayout<dim>::stride;
          for (const unsigned int f : cell->face_indices())
            if (cell->at_boundary(f))
              for (unsigned int i = 0; i < nodes.size(); ++i)
                if ((i >> f / 2 & 1) == f % 2)
                  {
                    const std::uint32_t node =
                      entry.node[i] / NodeLayout<dim>::stride;
                    sides_of_node[node] |= 1 << cell->face(f)->boundary_id();
                    boundary_places[node] = cell->vertex(i);
                  }
        }
    smallest_edge = dealii::Utilities::MPI::min(smallest, communicator);
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_bins()
  {
    bins = {};
    if (geometry.empty())
      return;

    // Bins as fine as the finest cell of this rank, over the box around its
    // cells.
    std::array<double, dim> upper;
    for (int d = 0; d < dim; ++d)
      {
        bins.lower[d] = 1e300;
        upper[d]      = -1e300;
        for (const auto &cell : geometry)
          {
            bins.lower[d] = std::min(bins.lower[d], cell.origin[d]);
            upper[d] =
              std::max(upper[d], cell.origin[d] + 1 / cell.inverse_edge[d]);
            bins.inverse_edge[d] =
              std::max(bins.inverse_edge[d], cell.inverse_edge[d]);
          }
        bins.n[d] =
          std::lround((upper[d] - bins.lower[d]) * bins.inverse_edge[d]);
      }

    std::size_t size = 1;
    for (int d = 0; d < dim; ++d)
      size *= bins.n[d];
    bin_table.assign(size, invalid_cell);
    bins.table = bin_table.data();

    for (std::uint32_t c = 0; c < geometry.size(); ++c)
      {
        std::array<std::int64_t, 3> first{}, count{{1, 1, 1}};
        for (int d = 0; d < dim; ++d)
          {
            first[d] = std::lround((geometry[c].origin[d] - bins.lower[d]) *
                                   bins.inverse_edge[d]);
            count[d] =
              std::lround(bins.inverse_edge[d] / geometry[c].inverse_edge[d]);
          }
        for (std::int64_t k = 0; k < count[2]; ++k)
          for (std::int64_t j = 0; j < count[1]; ++j)
            for (std::int64_t i = 0; i < count[0]; ++i)
              {
                std::int64_t bin = first[1] + j;
                if constexpr (dim == 3)
                  bin += (first[2] + k) * bins.n[1];
                bin_table[bin * bins.n[0] + first[0] + i] = c;
              }
      }
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_hanging_nodes()
  {
    hanging_nodes.clear();
    for (const auto &line : constraints.get_lines())
      {
        HangingNode node;
        node.node = node_partitioner->global_to_local(line.index);
        for (const auto &[master, weight] : line.entries)
          node.masters.emplace_back(node_partitioner->global_to_local(master),
                                    weight);
        hanging_nodes.push_back(node);
      }
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_ghost_cells(const Partitioner &cells)
  {
    // A rank's cells are numbered consecutively over all ranks.
    const auto first =
      dealii::Utilities::MPI::all_gather(communicator,
                                         cells.local_range().first);
    ghost_cells.clear();
    auto ghost = cells.ghost_indices().begin();
    for (const auto &[owner, n] : cells.ghost_targets())
      for (unsigned int i = 0; i < n; ++i)
        ghost_cells.push_back({owner, std::uint32_t(*ghost++ - first[owner])});
  }



  template <int dim>
  std::shared_ptr<const Partitioner>
  BackgroundGrid<dim>::node_records(const unsigned int stride) const
  {
    return scale(*node_partitioner, stride);
  }



  template <int dim>
  std::shared_ptr<const Partitioner>
  BackgroundGrid<dim>::cell_records(const unsigned int stride) const
  {
    return scale(*cell_partitioner, stride);
  }



  template <int dim>
  std::vector<std::uint32_t>
  BackgroundGrid<dim>::shared_nodes() const
  {
    return exported(*node_partitioner);
  }



  template <int dim>
  std::vector<std::uint32_t>
  BackgroundGrid<dim>::shared_cells() const
  {
    return exported(*cell_partitioner);
  }



  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace limber
