// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_background_grid_h
#define limber_grid_background_grid_h

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/mapping_cartesian.h>

#include <limber/grid/grid_view.h>
#include <limber/grid/node_table.h>
#include <limber/grid/refined_cells.h>

#include <vector>

namespace limber
{
  /**
   * The background grid: a distributed mesh of rectangular cells (the lattice
   * of the scene, possibly refined), with one scalar Q1 space for nodal data at
   * vertices and one DGQ0 space for data in cells, which also numbers quadratic
   * splines. The local number of a vertex or cell is its degree of freedom on
   * this rank: owned ones first, then ghosts. The plain tables of the sweeps
   * are built from these after each change of the mesh; the degrees of freedom
   * themselves are not kept.
   */
  template <int dim>
  class BackgroundGrid
  {
  public:
    using Mesh = dealii::parallel::distributed::Triangulation<dim>;

    /**
     * Build the lattice of the scene. As every rank stores all coarse cells,
     * the cell counts are split into few coarse cells and as many global
     * refinements as common factors of two permit. Adaptive refinement comes
     * later.
     */
    BackgroundGrid(const GridDescription<dim> &description,
                   MPI_Comm                    communicator);

    /**
     * Renumber and rebuild all tables; required after each change of the mesh.
     */
    void
    rebuild();

    /**
     * First part of rebuild(): what points need to find their cells and to
     * migrate to other ranks. Suffices for intermediate meshes, which need not
     * be graded.
     */
    void
    rebuild_cells();

    /**
     * Second part: what a step needs. The mesh must be graded (2:1), without
     * parted siblings.
     */
    void
    complete();

    /**
     * Whether siblings (children of one cell) are on several ranks, which
     * happens when the mesh is coarsened; repartitioning brings them together
     * again. Collective.
     */
    bool
    has_parted_siblings() const;

    /** Local number of a locally owned or ghost cell. */
    std::uint32_t
    cell_number(const typename dealii::Triangulation<dim>::active_cell_iterator
                  &cell) const
    {
      return cell_numbers[cell->active_cell_index()];
    }

    using Cell = typename dealii::Triangulation<dim>::cell_iterator;

    /** The refinement level of a cell; zero for those of the lattice. */
    unsigned int
    level_of(const Cell &cell) const
    {
      return cell->level() - global_refinements;
    }

    /** The same by the local number of a cell. */
    unsigned int
    level_of(const std::uint32_t cell) const
    {
      return has_levels() ? levels[cell] : 0;
    }

    /** Its index in the lattice of its level. */
    typename RefinedCells<dim>::Place
    place_of(const Cell &cell) const;

    /**
     * Index of the (possibly non-existing) cell of this level at a position.
     */
    typename RefinedCells<dim>::Place
    place_at(const std::array<double, dim> &x, unsigned int level) const;

    /** Whether the mesh is adaptive. */
    bool
    has_levels() const
    {
      return description.levels > 0;
    }

    /** An empty set of refinement requests; see RefinedCells. */
    RefinedCells<dim>
    no_divided_cells() const
    {
      return {description.cells, description.levels};
    }

    /** The present mesh as a set of divided cells; collective. */
    RefinedCells<dim>
    divided_cells() const;

    /**
     * Set the refine and coarsen flags of owned cells that bring the mesh one
     * level closer to a graded one. Returns whether any rank has set any;
     * collective.
     */
    bool
    mark_towards(const RefinedCells<dim> &mesh);

    /** Clear these flags. */
    void
    clear_marks();

    /** The nodes of the kernel: vertices, or those of quadratic splines. */
    const NodeTable<dim> &
    nodes() const
    {
      return has_own_nodes() ? quadratic_nodes : vertices;
    }

    /** Whether these are not the vertices (which cubic splines use as well). */
    bool
    has_own_nodes() const
    {
      return description.kernel == KernelKind::quadratic;
    }

    /**
     * Whether the stencil of points is larger than the nodes of their cells; a
     * rank knows such nodes for its owned cells only.
     */
    bool
    reaches_beyond_cells() const
    {
      return description.kernel != KernelKind::linear;
    }

    /** A view without nodal records. */
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

    /** The owner of a ghost cell, and the local number of the cell there. */
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

    const GridDescription<dim>          description;
    const MPI_Comm                      communicator;
    Mesh                                triangulation;
    const dealii::MappingCartesian<dim> mapping;

    // Tables, by local number
    std::vector<CellGeometry<dim>> geometry;
    std::vector<std::uint32_t>     bin_table, bin_blocks, bin_nodes;
    BinView<dim>                   bins;
    double                         smallest_edge = 0; // m, over all ranks
    // Cells that are known to several ranks
    SharedRecords  shared_cells;
    NodeTable<dim> vertices; // of cells
    // Only for quadratic or cubic kernels; by cell
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
    put_into_bins(std::uint32_t cell);
    unsigned int
    finest_level() const;
    void
    build_hanging_nodes(const Numbering &numbering);
    void
    complete_boundary();

    unsigned int               global_refinements = 0; // to the lattice
    unsigned int               cells_owned        = 0;
    std::vector<std::uint8_t>  levels;       // by local number, if adaptive
    std::vector<std::uint32_t> cell_numbers; // by active cell index
    std::vector<CellElsewhere> ghost_cells;
  };
} // namespace limber

#endif
