// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_background_grid_h
#define limber_grid_background_grid_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_cartesian.h>

#include <deal.II/lac/affine_constraints.h>

#include <limber/grid/grid_view.h>
#include <limber/problem/problem.h>

#include <memory>
#include <unordered_map>
#include <vector>

namespace limber
{
  /** A node that the mesh constrains to others: u = sum weight u_master. */
  struct HangingNode
  {
    std::uint32_t                                 node; // local number
    std::vector<std::pair<std::uint32_t, double>> masters;
  };



  /**
   * The background grid: a distributed mesh of rectangular cells, one scalar
   * Q1 space for everything on nodes and one DGQ0 space for everything in
   * cells. A node's or a cell's local number is that of its degree of freedom
   * on this rank: owned ones first, then ghosts. From these the plain tables
   * of the sweeps are built, anew after each change of the mesh.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    /**
     * Build the mesh of the scene. Cell counts are split into few coarse
     * cells and as many global refinements as the counts have factors of two
     * in common, since every rank stores all coarse cells.
     */
    BackgroundGrid(const GridDescription<dim> &description,
                   MPI_Comm                    communicator);

    /** Renumber and rebuild all tables; to be called after mesh changes. */
    void
    rebuild();

    /** Local number of a locally owned or ghost cell. */
    std::uint32_t
    cell_number(const typename dealii::Triangulation<dim>::active_cell_iterator
                  &cell) const
    {
      return cell_numbers[cell->active_cell_index()];
    }

    unsigned int
    n_owned_nodes() const
    {
      return node_partitioner->locally_owned_size();
    }

    /** Owned and ghost. */
    unsigned int
    n_nodes() const
    {
      return n_owned_nodes() + node_partitioner->n_ghost_indices();
    }

    unsigned int
    n_owned_cells() const
    {
      return cell_partitioner->locally_owned_size();
    }

    unsigned int
    n_cells() const
    {
      return n_owned_cells() + cell_partitioner->n_ghost_indices();
    }

    /** The rank that owns a ghost cell, and the cell's local number there. */
    struct CellElsewhere
    {
      unsigned int  owner;
      std::uint32_t number;
    };

    const CellElsewhere &
    ghost_cell(const std::uint32_t cell) const
    {
      return ghost_cells[cell - n_owned_cells()];
    }

    /** A layout of @p stride consecutive numbers per node or per cell. */
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner>
    node_records(const unsigned int stride) const;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner>
    cell_records(const unsigned int stride) const;

    /** Owned nodes and cells that other ranks hold as ghosts. */
    std::vector<std::uint32_t>
    shared_nodes() const;
    std::vector<std::uint32_t>
    shared_cells() const;

    const GridDescription<dim>                        description;
    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const dealii::MappingCartesian<dim>               mapping;
    const dealii::FE_Q<dim>                           node_element{1};
    const dealii::FE_DGQ<dim>                         cell_element{0};
    dealii::DoFHandler<dim>                           node_handler;
    dealii::DoFHandler<dim>                           cell_handler;
    dealii::AffineConstraints<double>                 constraints;

    // Tables, by local number
    std::vector<CellGeometry<dim>> geometry;
    std::vector<HangingNode>       hanging_nodes;
    std::vector<std::uint32_t>     bin_table;
    BinView<dim>                   bins;
    // Bit s is set for nodes on side s of the box.
    std::vector<std::uint8_t> sides_of_node;
    // Places of these nodes only
    std::unordered_map<std::uint32_t, dealii::Point<dim>> boundary_places;
    double smallest_edge = 0; // m, over all ranks

  private:
    void
    build_cells();
    void
    build_ghost_cells(const dealii::Utilities::MPI::Partitioner &cells);
    void
    build_bins();
    void
    build_hanging_nodes();

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> node_partitioner;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> cell_partitioner;
    std::vector<std::uint32_t> cell_numbers; // by active cell index
    std::vector<CellElsewhere> ghost_cells;
  };
} // namespace limber

#endif
