// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_background_grid_h
#define limber_grid_background_grid_h

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/mapping_cartesian.h>

#include <limber/grid/grid_view.h>
#include <limber/grid/shared_records.h>
#include <limber/problem/problem.h>

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
   * of the sweeps are built, anew after each change of the mesh; the degrees
   * of freedom themselves are not kept.
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
      return nodes_owned;
    }

    /** Owned and ghost. */
    unsigned int
    n_nodes() const
    {
      return sides_of_node.size();
    }

    unsigned int
    n_owned_cells() const
    {
      return cells_owned;
    }

    unsigned int
    n_cells() const
    {
      return geometry.size();
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

    /**
     * Slots [first, last) of records of nodes: hanging nodes hand what has
     * been added to them on to their masters, and are left with zero.
     */
    void
    give_to_masters(double      *records,
                    unsigned int stride,
                    unsigned int first,
                    unsigned int last) const;

    /** The same: hanging nodes get the values that follow from masters. */
    void
    take_from_masters(double      *records,
                      unsigned int stride,
                      unsigned int first,
                      unsigned int last) const;

    const GridDescription<dim>                        description;
    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const dealii::MappingCartesian<dim>               mapping;

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
    // Nodes and cells that other ranks hold as well
    SharedRecords shared_nodes, shared_cells;

  private:
    struct Numbering;

    void
    build_cells(const Numbering &numbering);
    void
    build_ghost_cells(const Numbering &numbering);
    void
    build_bins();
    void
    build_hanging_nodes(const Numbering &numbering);
    void
    complete_boundary();

    unsigned int               nodes_owned = 0, cells_owned = 0;
    std::vector<std::uint32_t> cell_numbers; // by active cell index
    std::vector<CellElsewhere> ghost_cells;
  };
} // namespace limber

#endif
