// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_refined_cells_h
#define limber_grid_refined_cells_h

#include <limber/problem/problem.h>

#include <cstdint>
#include <vector>

namespace limber
{
  /**
   * The set of divided cells, level by level: a whole adaptive mesh as a list
   * of numbers, the same on all ranks. A cell of level l is identified by its
   * index in the lattice with 2^l times as many cells along each edge as that
   * of the scene, x fastest. Eight bytes per divided cell.
   */
  template <int dim>
  class RefinedCells
  {
  public:
    /** A cell of a level, by its index along each axis. */
    using Place = std::array<std::uint32_t, dim>;

    /** Empty, for the lattice of the scene and @p levels finer ones. */
    RefinedCells(const std::array<unsigned int, dim> &cells,
                 unsigned int                         levels);

    /** Request that a cell of this level and its ancestors be divided. */
    void
    divide(unsigned int level, const Place &place);

    /** Add the divided cells of another, sorted set. */
    void
    join(const RefinedCells &other);

    /** Unite the requests of all ranks; collective. */
    void
    sum_over_ranks(MPI_Comm communicator);

    /**
     * Add @p buffer cells around the divided ones on each level, and what 2:1
     * balance needs: around a divided cell, also across corners, all cells of
     * its size exist. So two jumps in size are at least two cells apart.
     */
    void
    grade(unsigned int buffer);

    /** Whether a cell is divided; only after summation or grading. */
    bool
    is_divided(unsigned int level, const Place &place) const;

    /** Serialise, level by level: number of cells, then their indices. */
    std::vector<std::uint64_t>
    numbers() const;

    /** The inverse; throws std::invalid_argument for invalid input. */
    void
    set(const std::vector<std::uint64_t> &numbers);

    bool
    operator==(const RefinedCells &other) const
    {
      return of_level == other.of_level;
    }

    unsigned int
    levels() const
    {
      return of_level.size();
    }

    /**
     * Level of the smallest cells, i.e. the number of levels with divided ones.
     */
    unsigned int
    finest_level() const
    {
      unsigned int result = of_level.size();
      while (result > 0 && of_level[result - 1].empty())
        --result;
      return result;
    }

    /** Intersect with the divided cells of another; both are sorted. */
    void
    keep_common(const RefinedCells &other);

    /** The linear index of a cell, and back. */
    std::uint64_t
    number(unsigned int level, const Place &place) const;
    Place
    place(unsigned int level, std::uint64_t number) const;

    /** Whether the index is inside the box. */
    bool
    is_inside(unsigned int level, const Place &place) const;

  private:
    using Cells = std::vector<std::uint64_t>; // ascending, once sorted

    Cells
    with_neighbours(unsigned int level, const Cells &cells) const;

    std::array<unsigned int, dim> cells; // of level 0
    std::vector<Cells>            of_level;
  };
} // namespace limber

#endif
