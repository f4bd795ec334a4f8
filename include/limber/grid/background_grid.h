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
   * The background grid: a distributed mesh of rectangular cells, those of the
   * scene's lattice or finer ones made of them, one scalar
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
    using Mesh = dealii::parallel::distributed::Triangulation<dim>;

    /**
     * Build the lattice of the scene. Cell counts are split into few coarse
     * cells and as many global refinements as the counts have factors of two
     * in common, since every rank stores all coarse cells. Where the scene has
     * levels, none of its cells is divided yet.
     */
    BackgroundGrid(const GridDescription<dim> &description,
                   MPI_Comm                    communicator);

    /** Renumber and rebuild all tables; to be called after mesh changes. */
    void
    rebuild();

    /**
     * The first part of that: what points need to find their cells and to go
     * with them to other ranks. For a mesh on its way to the wanted one, which
     * need not be graded.
     */
    void
    rebuild_cells();

    /** The second part: what a step needs. The mesh has to be graded, and no
     * siblings parted. */
    void
    complete();

    /**
     * Whether any cells that make up a larger one are on several ranks: the
     * mesh has become coarser there since it was last given to ranks, which
     * keeps such cells together. Collective.
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

    /** How often a cell of the scene has been halved to make this one. */
    unsigned int
    level_of(const Cell &cell) const
    {
      return cell->level() - global_refinements;
    }

    /** The same of a cell by its local number. */
    unsigned int
    level_of(const std::uint32_t cell) const
    {
      return has_levels() ? levels[cell] : 0;
    }

    /** Its place in the lattice of its level. */
    typename RefinedCells<dim>::Place
    place_of(const Cell &cell) const;

    /** The cell of this level, if it were there, that holds a place. */
    typename RefinedCells<dim>::Place
    place_at(const std::array<double, dim> &x, unsigned int level) const;

    /** Whether cells may differ in size. */
    bool
    has_levels() const
    {
      return description.levels > 0;
    }

    /** No wishes yet; see RefinedCells. */
    RefinedCells<dim>
    no_divided_cells() const
    {
      return {description.cells, description.levels};
    }

    /** The mesh as it is; collective. */
    RefinedCells<dim>
    divided_cells() const;

    /**
     * Mark the owned cells that have to be divided, or joined with their
     * siblings, to come one level closer to a graded mesh. Returns whether
     * there are any on any rank; collective.
     */
    bool
    mark_towards(const RefinedCells<dim> &mesh);

    /** Take back what it has marked. */
    void
    clear_marks();

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

    const GridDescription<dim>          description;
    const MPI_Comm                      communicator;
    Mesh                                triangulation;
    const dealii::MappingCartesian<dim> mapping;

    // Tables, by local number
    std::vector<CellGeometry<dim>> geometry;
    std::vector<std::uint32_t>     bin_table, bin_blocks, bin_nodes;
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
    put_into_bins(std::uint32_t cell);
    unsigned int
    finest_level() const;
    void
    build_hanging_nodes(const Numbering &numbering);
    void
    complete_boundary();

    unsigned int               global_refinements = 0; // to the lattice
    unsigned int               cells_owned        = 0;
    std::vector<std::uint8_t>  levels; // by local number, where there are any
    std::vector<std::uint32_t> cell_numbers; // by active cell index
    std::vector<CellElsewhere> ghost_cells;
  };
} // namespace limber

#endif
