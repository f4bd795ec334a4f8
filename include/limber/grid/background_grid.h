// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_background_grid_h
#define limber_grid_background_grid_h

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/mapping_cartesian.h>

#include <limber/grid/grid_view.h>
#include <limber/grid/node_table.h>
#include <limber/problem/problem.h>

#include <vector>

namespace limber
{
  /**
   * The background grid: a distributed mesh of rectangular cells, one scalar
   * Q1 space for everything on vertices and one DGQ0 space for everything in
   * cells, which also numbers quadratic splines. A vertex's or a
   * cell's local number is that of its degree of freedom on this rank: owned
   * ones first, then ghosts. From these the plain tables
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

    /** The nodes whose functions interpolate: vertices, or of splines. */
    const NodeTable<dim> &
    nodes() const
    {
      return has_own_nodes() ? quadratic_nodes : vertices;
    }

    /** Whether these are others than the vertices, which cubic splines have. */
    bool
    has_own_nodes() const
    {
      return description.kernel == KernelKind::quadratic;
    }

    /**
     * Whether points see nodes beyond those of their cells; a rank knows these
     * of its own cells alone.
     */
    bool
    reaches_beyond_cells() const
    {
      return description.kernel != KernelKind::linear;
    }

    /** For sweeps that need no records of nodes. */
    GridView<dim>
    view() const;

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

    const GridDescription<dim>                        description;
    const MPI_Comm                                    communicator;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const dealii::MappingCartesian<dim>               mapping;

    // Tables, by local number
    std::vector<CellGeometry<dim>> geometry;
    std::vector<std::uint32_t>     bin_table;
    BinView<dim>                   bins;
    double                         smallest_edge = 0; // m, over all ranks
    // Cells that other ranks hold as well
    SharedRecords  shared_cells;
    NodeTable<dim> vertices; // of cells
    // Only where the kernel is quadratic, or cubic; by cell
    NodeTable<dim>                  quadratic_nodes;
    std::vector<SplineCell<dim, 2>> quadratics;
    std::vector<SplineCell<dim, 3>> cubics;

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

    unsigned int               cells_owned = 0;
    std::vector<std::uint32_t> cell_numbers; // by active cell index
    std::vector<CellElsewhere> ghost_cells;
  };
} // namespace limber

#endif
