// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_numbered_nodes_h
#define limber_time_numbered_nodes_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>

#include <limber/time/hanging_corners.h>
#include <limber/time/integrator.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace limber
{
  /**
   * The nodes of all cells that hold points, on whatever rank, numbered in the
   * order of their places in the lattice (the first direction runs fastest):
   * the same on every rank and for any number of ranks. With linear functions
   * nodes are the vertices that do not hang, on which those that do depend
   * (HangingCorners); with quadratic splines, on cells of one size, along each
   * direction the centres of the cells and both sides. What is summed over
   * ranks is the same on all of them, to the last bit.
   */
  template <int dim>
  class NumberedNodes
  {
  public:
    /** Numbers of the nodes of a cell, in the order of the basis. */
    using Numbers = dealii::ArrayView<const std::uint32_t>;

    explicit NumberedNodes(const RunParts<dim> &parts);

    /** Number the nodes of the cells that hold points now, which must be
     * sorted; false if these are the same as before. Collective. */
    bool
    update();

    /** Number the nodes anew in any case: the mesh has changed. */
    void
    forget()
    {
      own_cells.clear();
      cells.clear();
    }

    std::size_t
    size() const
    {
      return keys.size();
    }

    /** Nodes of this rank's grid, by number; invalid_cell where it has no
     * points around a node. */
    const std::vector<std::uint32_t> &
    on_grid() const
    {
      return local;
    }

    /** Whether this rank owns a node: the first rank that has points around it,
     * and so knows the sums over all points. */
    bool
    owns(const std::size_t number) const
    {
      return speakers[number] == this_rank;
    }

    /** Positions, m, by number. */
    const std::vector<dealii::Point<dim>> &
    places() const
    {
      return of_lattice;
    }

    /** Sides of the box in which a node lies, as bits. */
    std::uint8_t
    sides(std::size_t number) const;

    /** Nodes of a cell along each direction: 2 of linear functions, 3 of
     * splines. */
    unsigned int
    n_along() const
    {
      return along;
    }

    /** Number of cells with points, on whatever rank. */
    std::size_t
    n_cells() const
    {
      return cells.size();
    }

    /** Nodes of such a cell, in the order of the basis; of cells with hanging
     * corners those on which these depend. */
    Numbers
    of_cell(const std::size_t cell) const
    {
      return {&numbers[cell * in_cell], in_cell};
    }

    /** Index among these of a cell of this rank's grid in which it has
     * points. */
    std::size_t
    number_of(const std::uint32_t cell) const
    {
      return index_of_local[cell];
    }

    /** Nodes of such a cell. */
    Numbers
    numbers_in(const std::uint32_t cell) const
    {
      return of_cell(number_of(cell));
    }

    /** Of a cell of that index; none with splines. */
    const HangingCorners<dim> &
    hanging_corners(const std::size_t cell) const
    {
      return cells[cell].corners;
    }

    /** Whether a cell of that index ends at the lower and upper side. */
    std::array<bool, 2>
    at_sides(std::size_t cell, unsigned int direction) const;

    /** The next cells along a direction from a cell with points: one of its
     * size or larger, or smaller ones. */
    struct Neighbours
    {
      std::vector<std::size_t> cells;        // with points
      bool                     any_is_empty; // in the box
    };
    Neighbours
    neighbours(std::size_t cell, unsigned int direction, int step) const;

    /** Lower corner of a cell of that index, in edges of the finest cells. */
    std::array<unsigned int, dim>
    place_of_cell(const std::size_t cell) const
    {
      return place_of(cells[cell].key, n_cells_along);
    }

    /** Its edges over those of the finest cells. */
    unsigned int
    size_of_cell(const std::size_t cell) const
    {
      return 1u << cells[cell].coarser;
    }

    /** Its edge, m. */
    double
    edge(const std::size_t cell, const unsigned int direction) const
    {
      return size_of_cell(cell) * edges[direction];
    }

    /** Edge of the finest cells that a mesh may have, m. */
    double
    finest_edge(const unsigned int direction) const
    {
      return edges[direction];
    }

    /** Volume of a whole cell, m^dim. */
    double
    volume_of_cell(const std::size_t cell) const
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result *= edge(cell, d);
      return result;
    }

    /** Replace values by their sums over all ranks. Collective. */
    void
    sum(double *values, std::size_t n) const;
    void
    sum(std::vector<double> &values) const
    {
      sum(values.data(), values.size());
    }

    bool
    is_parallel() const
    {
      return parallel;
    }

  private:
    // Place in the lattice of nodes, or of cells, as one number
    using Key   = std::uint64_t;
    using Place = std::array<unsigned int, dim>;

    // Of the lattices of the finest cells that a mesh may have
    struct CellInLattice
    {
      bool
      operator<(const CellInLattice &other) const
      {
        return key < other.key;
      }
      bool
      operator==(const CellInLattice &other) const
      {
        return key == other.key;
      }

      Key                 key = 0; // of the lower corner
      HangingCorners<dim> corners;
      std::uint8_t        coarser = 0; // than the finest, in levels
    };

    // By local number; null: it does not hang. Empty with cells of one size.
    using HangingVertices = std::vector<const HangingNode *>;

    HangingVertices
    hanging_vertices() const;
    CellInLattice
    in_lattice(std::uint32_t cell, const HangingVertices &hanging) const;
    std::optional<std::size_t>
    find(const Place &place, unsigned int coarser) const;
    static Key
    key_of(const Place &place, const Place &extent);
    static Place
    place_of(Key key, const Place &extent);
    void
    number_nodes();
    void
    find_places();
    void
    find_on_grid(const std::vector<CellInLattice> &own);
    void
    find_masters(const HangingVertices &hanging);
    void
    find_owners();

    const RunParts<dim>             parts;
    const bool                      parallel;
    const unsigned int              along, in_cell; // nodes of a cell
    dealii::Point<dim>              edges;          // of the finest cells, m
    Place                           n_nodes, n_cells_along; // of such cells
    std::vector<std::uint32_t>      own_cells;      // of this rank, with points
    std::vector<CellInLattice>      cells;          // sorted
    std::vector<Key>                keys;           // of nodes, sorted
    std::vector<std::uint32_t>      numbers;        // in_cell for each cell
    std::vector<std::uint32_t>      index_of_local; // cells
    std::vector<std::uint32_t>      local;
    std::vector<int>                speakers; // ranks, by number
    int                             this_rank = 0;
    std::vector<dealii::Point<dim>> of_lattice;
  };
} // namespace limber

#endif
