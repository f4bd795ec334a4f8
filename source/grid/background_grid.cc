// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/partitioner.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/affine_constraints.h>

#include <limber/base/lazy_array.h>
#include <limber/base/records_of_ranks.h>
#include <limber/grid/background_grid.h>
#include <limber/grid/order_of_trees.h>
#include <limber/grid/spline_nodes.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Tolerance of coordinates relative to cell edges
    constexpr double tolerance = 1e-6;
  } // namespace



  /** deal.II's degrees of freedom, from which the tables are built. */
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
      // Masters of relevant nodes may be outside of the ghost layer.
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
        dealii::Triangulation<dim>::limit_level_difference_at_vertices,
        // Cells that are refined with points in them stay on their rank until
        // balance() repartitions.
        has_levels() ? Mesh::no_automatic_repartitioning :
                       Mesh::default_setting)
  {
    order_trees_quickly();
    std::vector<unsigned int> coarse(description.cells.begin(),
                                     description.cells.end());
    while (std::all_of(coarse.begin(), coarse.end(), [](const unsigned int n) {
      return n % 2 == 0;
    }))
      {
        for (unsigned int &n : coarse)
          n /= 2;
        ++global_refinements;
      }
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                      coarse,
                                                      description.lower,
                                                      description.upper,
                                                      /*colorize=*/true);
    triangulation.refine_global(global_refinements);
    if (has_levels())
      triangulation.repartition();
    rebuild();
    // Refinement and numbering need temporarily twice the memory that remains.
    // Adaptive meshes need it again.
    malloc_trim(0);
  }



  template <int dim>
  void
  BackgroundGrid<dim>::rebuild()
  {
    rebuild_cells();
    complete();
  }



  template <int dim>
  void
  BackgroundGrid<dim>::rebuild_cells()
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
  }



  template <int dim>
  void
  BackgroundGrid<dim>::complete()
  {
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
    levels.assign(has_levels() ? geometry.size() : 0, 0);

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
          if (has_levels())
            levels[number] = level_of(cell);

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



  // Bins are the cells of the lattice of the scene, in the bounding box of the
  // cells of this rank; refined ones have a block each.
  template <int dim>
  void
  BackgroundGrid<dim>::build_bins()
  {
    bins = {};
    bin_blocks.clear();
    if (geometry.empty())
      return;

    std::array<double, dim> upper;
    for (int d = 0; d < dim; ++d)
      {
        bins.lower[d]        = 1e300;
        upper[d]             = -1e300;
        bins.inverse_edge[d] = has_levels() ? 1 / description.edge(d) : 0;
        for (const auto &cell : geometry)
          {
            bins.lower[d] = std::min(bins.lower[d], cell.origin[d]);
            upper[d] =
              std::max(upper[d], cell.origin[d] + 1 / cell.inverse_edge[d]);
            if (!has_levels())
              bins.inverse_edge[d] =
                std::max(bins.inverse_edge[d], cell.inverse_edge[d]);
          }
        if (has_levels()) // the box may begin within a cell of the lattice
          bins.lower[d] =
            description.lower[d] +
            std::floor(tolerance + (bins.lower[d] - description.lower[d]) *
                                     bins.inverse_edge[d]) /
              bins.inverse_edge[d];
        bins.n[d] = std::lround(std::ceil(
          (upper[d] - bins.lower[d]) * bins.inverse_edge[d] - tolerance));
      }

    std::size_t size = 1;
    for (int d = 0; d < dim; ++d)
      size *= bins.n[d];
    bin_table.assign(size, invalid_cell);
    bins.one_per_cell = !has_levels();
    bins.per_edge     = 1 << finest_level();
    for (std::uint32_t c = 0; c < geometry.size(); ++c)
      put_into_bins(c);
    bins.table  = bin_table.data();
    bins.blocks = bin_blocks.data();
    if (has_domains(description.kernel) && bins.one_per_cell)
      {
        bin_nodes  = nodes_of_bins(bins, geometry);
        bins.nodes = bin_nodes.data();
      }
  }



  template <int dim>
  unsigned int
  BackgroundGrid<dim>::finest_level() const
  {
    return levels.empty() ? 0 : *std::max_element(levels.begin(), levels.end());
  }



  template <int dim>
  void
  BackgroundGrid<dim>::put_into_bins(const std::uint32_t cell)
  {
    std::size_t             bin = 0;
    std::array<double, dim> begin; // in sub-bins of a block
    for (int d = dim - 1; d >= 0; --d)
      {
        const double at =
          (geometry[cell].origin[d] - bins.lower[d]) * bins.inverse_edge[d];
        const double first = std::floor(at + tolerance);
        begin[d]           = (at - first) * bins.per_edge;
        bin                = bin * bins.n[d] + std::size_t(first);
      }
    if (level_of(cell) == 0)
      {
        bin_table[bin] = cell;
        return;
      }

    std::size_t in_block = 1;
    for (int d = 0; d < dim; ++d)
      in_block *= bins.per_edge;
    if (bin_table[bin] == invalid_cell)
      {
        bin_table[bin] =
          BinView<dim>::first_block + bin_blocks.size() / in_block;
        bin_blocks.resize(bin_blocks.size() + in_block, invalid_cell);
      }
    std::uint32_t *const block =
      bin_blocks.data() +
      (bin_table[bin] - BinView<dim>::first_block) * in_block;
    const std::size_t width = bins.per_edge >> level_of(cell);
    std::size_t       n     = 1;
    for (int d = 0; d < dim; ++d)
      n *= width;
    for (std::size_t i = 0; i < n; ++i)
      {
        std::size_t place = 0, stride = 1, rest = i;
        for (int d = 0; d < dim; ++d, rest /= width, stride *= bins.per_edge)
          place += (std::lround(begin[d]) + rest % width) * stride;
        block[place] = cell;
      }
  }



  template <int dim>
  typename RefinedCells<dim>::Place
  BackgroundGrid<dim>::place_of(const Cell &cell) const
  {
    typename RefinedCells<dim>::Place result;
    for (int d = 0; d < dim; ++d)
      result[d] = std::lround((cell->vertex(0)[d] - description.lower[d]) /
                              description.edge(d) * (1u << level_of(cell)));
    return result;
  }



  template <int dim>
  typename RefinedCells<dim>::Place
  BackgroundGrid<dim>::place_at(const std::array<double, dim> &x,
                                const unsigned int             level) const
  {
    typename RefinedCells<dim>::Place result;
    for (int d = 0; d < dim; ++d)
      {
        const double n  = description.cells[d] << level;
        const double at = (x[d] - description.lower[d]) /
                          (description.upper[d] - description.lower[d]) * n;
        result[d] =
          static_cast<std::uint32_t>(std::min(std::max(0., at), n - 1));
      }
    return result;
  }



  // A cell is divided if it has any owned child on any rank.
  template <int dim>
  RefinedCells<dim>
  BackgroundGrid<dim>::divided_cells() const
  {
    RefinedCells<dim> result = no_divided_cells();
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && level_of(cell) > 0)
        result.divide(level_of(cell) - 1, place_of(cell->parent()));
    result.sum_over_ranks(communicator);
    return result;
  }



  template <int dim>
  bool
  BackgroundGrid<dim>::mark_towards(const RefinedCells<dim> &mesh)
  {
    clear_marks();
    bool any = false;
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        if (!cell->is_locally_owned())
          continue;
        const unsigned int level = level_of(cell);
        if (mesh.is_divided(level, place_of(cell)))
          cell->set_refine_flag();
        else if (level > 0 &&
                 !mesh.is_divided(level - 1, place_of(cell->parent())))
          cell->set_coarsen_flag();
        else
          continue;
        any = true;
      }
    if (dealii::Utilities::MPI::max(any ? 1 : 0, communicator) == 0)
      return false;
    triangulation.prepare_coarsening_and_refinement();
    return true;
  }



  // Siblings share a node, so they are known as ghosts at least.
  template <int dim>
  bool
  BackgroundGrid<dim>::has_parted_siblings() const
  {
    unsigned int any = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && level_of(cell) > 0)
        {
          unsigned int   n_active = 0, n_own = 0;
          constexpr auto n = dealii::GeometryInfo<dim>::max_children_per_cell;
          for (unsigned int child = 0; child < n; ++child)
            if (const auto sibling = cell->parent()->child(child);
                sibling->is_active())
              {
                ++n_active;
                n_own += sibling->is_locally_owned() ? 1 : 0;
              }
          if (n_active == n && n_own < n)
            any = 1;
        }
    return dealii::Utilities::MPI::max(any, communicator) > 0;
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
    // Owned cells are numbered consecutively over the ranks.
    const auto &cells = numbering.cell_records;
    std::vector first = {cells.local_range().first};
    unite(first, communicator);
    ghost_cells.clear();
    auto ghost = cells.ghost_indices().begin();
    for (const auto &[owner, n] : cells.ghost_targets())
      for (unsigned int i = 0; i < n; ++i)
        ghost_cells.push_back({owner, std::uint32_t(*ghost++ - first[owner])});
  }



  // This rank does not know the cells around a master outside of the ghost
  // layer; its owner tells on which sides the master lies, and its position,
  // and whether it is the master of hanging nodes behind a ghost cell. A ghost
  // cell could have a hanging node on its far side that only its owner
  // recognises; this cannot occur in a mesh of RefinedCells::grade() with
  // siblings on one rank.
  template <int dim>
  void
  BackgroundGrid<dim>::complete_boundary()
  {
    vertices.masters.clear();
    if (dealii::Utilities::MPI::max(vertices.hanging.size(), communicator) == 0)
      return;
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
      {
        for (const HangingNode &hanging : vertices.hanging)
          for (const auto &[master, weight] : hanging.masters)
            vertices.masters.push_back(master);
        std::sort(vertices.masters.begin(), vertices.masters.end());
        vertices.masters.erase(std::unique(vertices.masters.begin(),
                                           vertices.masters.end()),
                               vertices.masters.end());
        return;
      }
    constexpr unsigned int hangs = 1 + dim, leads = 2 + dim, stride = 3 + dim;
    LazyArray<double>      values(vertices.n() * stride);
    for (const auto &[node, place] : vertices.places)
      if (node < vertices.n_owned)
        {
          values[node * stride] = vertices.sides[node];
          for (int d = 0; d < dim; ++d)
            values[node * stride + 1 + d] = place[d];
        }
    for (const HangingNode &hanging : vertices.hanging)
      {
        if (hanging.node < vertices.n_owned)
          values[hanging.node * stride + hangs] = 1;
        for (const auto &[master, weight] : hanging.masters)
          values[master * stride + leads] = 1;
      }
    const ExchangePlan plan(vertices.shared);
    RecordExchange     exchange(stride);
    exchange.start(plan, values.data(), 0, stride);
    exchange.finish(values.data());
    for (std::uint32_t node = 0; node < vertices.n(); ++node)
      if (values[node * stride + leads] > 0)
        vertices.masters.push_back(node);
    for (const HangingNode &hanging : vertices.hanging)
      values[hanging.node * stride + hangs] = 0;
    for (std::uint32_t node = vertices.n_owned; node < vertices.n(); ++node)
      {
        AssertThrow(values[node * stride + hangs] == 0,
                    dealii::ExcMessage("A rank does not know that a node of a "
                                       "ghost cell is a hanging one."));
        if (values[node * stride] == 0)
          continue;
        vertices.sides[node] = std::uint8_t(values[node * stride]);
        for (int d = 0; d < dim; ++d)
          vertices.places[node][d] = values[node * stride + 1 + d];
      }
  }



  template <int dim>
  void
  BackgroundGrid<dim>::clear_marks()
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        cell->clear_refine_flag();
        cell->clear_coarsen_flag();
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
