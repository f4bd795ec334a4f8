// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_refined_cells_h
#define limber_grid_refined_cells_h

#include <limber/problem/problem.h>

#include <cstdint>
#include <vector>

namespace limber
{
  /**
   * Which cells of a scene's lattice are divided, and which of their children,
   * level by level: a whole mesh as a list of numbers, the same on all ranks.
   * A cell of level l is known by its place in the lattice that has 2^l times
   * as many cells along each edge as that of the scene, x fastest. Eight bytes
   * for each divided cell.
   */
  template <int dim>
  class RefinedCells
  {
  public:
    /** A cell of a level, by its steps along each axis. */
    using Place = std::array<std::uint32_t, dim>;

    /** None, in the lattice of the scene and @p levels finer ones. */
    RefinedCells(const std::array<unsigned int, dim> &cells,
                 unsigned int                         levels);

    /** Wish that a cell of this level be divided, and those that hold it. */
    void
    divide(unsigned int level, const Place &place);

    /** What the other divides as well, which is in order. */
    void
    join(const RefinedCells &other);

    /** Join the wishes of all ranks; collective. */
    void
    sum_over_ranks(MPI_Comm communicator);

    /**
     * Add @p buffer cells around those that are divided, on each level, and
     * what a graded mesh needs: around a divided cell, and across corners,
     * all cells of its size are there. So two jumps in size are at least two
     * cells apart.
     */
    void
    grade(unsigned int buffer);

    /** Whether the cell is divided; wishes have been summed or graded. */
    bool
    is_divided(unsigned int level, const Place &place) const;

    /** As numbers, level after level: how many cells, then their places. */
    std::vector<std::uint64_t>
    numbers() const;

    /** And back; throws std::invalid_argument where they are none. */
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

    /** That of the smallest cells: how many levels hold divided ones. */
    unsigned int
    finest_level() const
    {
      unsigned int result = of_level.size();
      while (result > 0 && of_level[result - 1].empty())
        --result;
      return result;
    }

    /** Give up what the other does not divide as well; both are in order. */
    void
    keep_common(const RefinedCells &other);

    /** The number of a place, and back. */
    std::uint64_t
    number(unsigned int level, const Place &place) const;
    Place
    place(unsigned int level, std::uint64_t number) const;

    /** Whether there is such a place in the box. */
    bool
    is_inside(unsigned int level, const Place &place) const;

  private:
    using Cells = std::vector<std::uint64_t>; // ascending, when in order

    Cells
    with_neighbours(unsigned int level, const Cells &cells) const;

    std::array<unsigned int, dim> cells; // of level 0
    std::vector<Cells>            of_level;
  };
} // namespace limber

#endif
