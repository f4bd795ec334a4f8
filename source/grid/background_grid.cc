// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/partitioner.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/affine_constraints.h>

#include <limber/base/lazy_array.h>
#include <limber/grid/background_grid.h>
#include <limber/grid/order_of_trees.h>
#include <limber/grid/spline_nodes.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  /** deal.II's numbers of nodes and cells, from which the tables are made. */
  template <int dim>
  struct BackgroundGrid<dim>::Numbering
  {
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    explicit Numbering(const BackgroundGrid<dim> &grid)
      : nodes(grid.triangulation)
      , cells(grid.triangulation)
    {
      nodes.distribute_dofs(node_element);
      cells.distribute_dofs(cell_element);

      dealii::IndexSet relevant_nodes, relevant_cells;
      dealii::DoFTools::extract_locally_relevant_dofs(nodes, relevant_nodes);
      dealii::DoFTools::extract_locally_relevant_dofs(cells, relevant_cells);
      constraints.reinit(relevant_nodes);
      dealii::DoFTools::make_hanging_node_constraints(nodes, constraints);
      constraints.close();
      // Masters of relevant nodes may lie beyond the ghost layer.
      for (const auto &line : constraints.get_lines())
        for (const auto &[master, weight] : line.entries)
          relevant_nodes.add_index(master);

      node_records.reinit(nodes.locally_owned_dofs(),
                          relevant_nodes,
                          grid.communicator);
      cell_records.reinit(cells.locally_owned_dofs(),
                          relevant_cells,
                          grid.communicator);
    }

    const dealii::FE_Q<dim>           node_element{1};
    const dealii::FE_DGQ<dim>         cell_element{0};
    dealii::DoFHandler<dim>           nodes, cells;
    dealii::AffineConstraints<double> constraints;
    Partitioner                       node_records, cell_records;
  };



  template <int dim>
  BackgroundGrid<dim>::BackgroundGrid(const GridDescription<dim> &description,
                                      const MPI_Comm              communicator)
    : description(description)
    , communicator(communicator)
    , triangulation(
        communicator,
        dealii::Triangulation<dim>::limit_level_difference_at_vertices)
  {
    order_trees_quickly();
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
    rebuild();
  }



  template <int dim>
  void
  BackgroundGrid<dim>::rebuild()
  {
    {
      const Numbering numbering(*this);
      cells_owned      = numbering.cell_records.locally_owned_size();
      shared_cells     = SharedRecords(numbering.cell_records);
      vertices.n_owned = numbering.node_records.locally_owned_size();
      vertices.shared  = SharedRecords(numbering.node_records);
      build_cells(numbering);
      build_ghost_cells(numbering);
      build_hanging_nodes(numbering);
    }
    build_bins();
    complete_boundary();
    if (description.kernel == KernelKind::quadratic)
      {
        QuadraticNodes<dim> numbered = number_quadratic_nodes(*this);
        quadratic_nodes              = std::move(numbered.nodes);
        quadratics                   = std::move(numbered.cells);
      }
    if (description.kernel == KernelKind::cubic)
      {
        cubics = find_cubic_cells(*this);
        set_inward_vertices(*this, vertices);
      }
    // Refinement and numbering need for a while twice what stays.
    malloc_trim(0);
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_cells(const Numbering &numbering)
  {
    const auto &cells = numbering.cell_records;
    const auto &nodes = numbering.node_records;
    geometry.assign(cells.locally_owned_size() + cells.n_ghost_indices(), {});
    vertices.places.clear();
    vertices.sides.assign(nodes.locally_owned_size() + nodes.n_ghost_indices(),
                          0);
    cell_numbers.assign(triangulation.n_active_cells(), invalid_cell);

    double                                       smallest = 1e300;
    std::vector<dealii::types::global_dof_index> corners(1 << dim), self(1);
    for (const auto &cell : numbering.nodes.active_cell_iterators())
      if (!cell->is_artificial())
        {
          typename dealii::DoFHandler<dim>::active_cell_iterator own(
            &triangulation, cell->level(), cell->index(), &numbering.cells);
          own->get_dof_indices(self);
          const std::uint32_t number = cells.global_to_local(self[0]);
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
          cell->get_dof_indices(corners);
          for (unsigned int i = 0; i < corners.size(); ++i)
            entry.node[i] =
              nodes.global_to_local(corners[i]) * NodeLayout<dim>::stride;
          for (const unsigned int f : cell->face_indices())
            if (cell->at_boundary(f))
              for (unsigned int i = 0; i < corners.size(); ++i)
                if ((i >> f / 2 & 1) == f % 2)
                  {
                    const std::uint32_t node =
                      entry.node[i] / NodeLayout<dim>::stride;
                    vertices.sides[node] |= 1 << cell->face(f)->boundary_id();
                    vertices.places[node] = cell->vertex(i);
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
    bins.table        = bin_table.data();
    bins.one_per_cell = true;

    for (std::uint32_t c = 0; c < geometry.size(); ++c)
      {
        std::array<std::int64_t, 3> first{}, count{{1, 1, 1}};
        for (int d = 0; d < dim; ++d)
          {
            first[d] = std::lround((geometry[c].origin[d] - bins.lower[d]) *
                                   bins.inverse_edge[d]);
            count[d] =
              std::lround(bins.inverse_edge[d] / geometry[c].inverse_edge[d]);
            bins.one_per_cell = bins.one_per_cell && count[d] == 1;
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
  BackgroundGrid<dim>::build_hanging_nodes(const Numbering &numbering)
  {
    const auto &nodes = numbering.node_records;
    vertices.hanging.clear();
    for (const auto &line : numbering.constraints.get_lines())
      {
        HangingNode node;
        node.node = nodes.global_to_local(line.index);
        for (const auto &[master, weight] : line.entries)
          node.masters.emplace_back(nodes.global_to_local(master), weight);
        vertices.hanging.push_back(node);
      }
  }



  template <int dim>
  void
  BackgroundGrid<dim>::build_ghost_cells(const Numbering &numbering)
  {
    // A rank's cells are numbered consecutively over all ranks.
    const auto &cells = numbering.cell_records;
    const auto  first =
      dealii::Utilities::MPI::all_gather(communicator,
                                         cells.local_range().first);
    ghost_cells.clear();
    auto ghost = cells.ghost_indices().begin();
    for (const auto &[owner, n] : cells.ghost_targets())
      for (unsigned int i = 0; i < n; ++i)
        ghost_cells.push_back({owner, std::uint32_t(*ghost++ - first[owner])});
  }



  // No cell around a master beyond the ghost layer is known here; its owner
  // tells on which sides it lies, and where.
  template <int dim>
  void
  BackgroundGrid<dim>::complete_boundary()
  {
    if (dealii::Utilities::MPI::max(vertices.hanging.size(), communicator) == 0)
      return;
    constexpr unsigned int stride = 1 + dim;
    LazyArray<double>      values(vertices.n() * stride);
    for (const auto &[node, place] : vertices.places)
      if (node < vertices.n_owned)
        {
          values[node * stride] = vertices.sides[node];
          for (int d = 0; d < dim; ++d)
            values[node * stride + 1 + d] = place[d];
        }
    const ExchangePlan plan(vertices.shared);
    RecordExchange     exchange(stride);
    exchange.start(plan, values.data(), 0, stride);
    exchange.finish(values.data());
    for (std::uint32_t node = vertices.n_owned; node < vertices.n(); ++node)
      if (values[node * stride] != 0)
        {
          vertices.sides[node] = std::uint8_t(values[node * stride]);
          for (int d = 0; d < dim; ++d)
            vertices.places[node][d] = values[node * stride + 1 + d];
        }
  }



  template <int dim>
  GridView<dim>
  BackgroundGrid<dim>::view() const
  {
    GridView<dim> result;
    result.cells = geometry.data();
    result.bins  = bins;
    if (description.kernel == KernelKind::quadratic)
      result.quadratics = quadratics.data();
    if (description.kernel == KernelKind::cubic)
      result.cubics = cubics.data();
    return result;
  }



  template class BackgroundGrid<2>;
  template class BackgroundGrid<3>;
} // namespace limber
