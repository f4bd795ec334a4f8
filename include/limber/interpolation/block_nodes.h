// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_block_nodes_h
#define limber_interpolation_block_nodes_h

#include <limber/interpolation/batch_lanes.h>

namespace limber
{
  /**
   * The block of cells that the domains of the points of a pack (GIMP, CPDI)
   * overlap, on a uniform lattice: the points are in one cell and no domain is
   * longer than a cell, so that a block has up to three cells along a
   * direction, of which each domain sees at most two. Blocks have at least two
   * cells, for domains that reach beyond a side of the grid.
   */
  template <int dim>
  class BlockNodes
  {
  public:
    using Number                  = PointPack<dim>;
    using Vector                  = std::array<Number, dim>;
    static constexpr int n_points = pack_width<Number>;
    static constexpr int longest  = 4; // max. nodes along a direction
    static constexpr int n_nodes  = dim == 2 ? 16 : 64; // max. in all

    /**
     * Find the block for points in @p cell at natural coordinates @p xi, whose
     * domains extend at most @p half <= 0.5 (in cells) from them. False if
     * there is none.
     */
    bool
    find(const GridView<dim> &grid,
         std::uint32_t        cell,
         const Vector        &xi,
         const Vector        &half);

    /** Call work(i, record) for each node: its number and its record offset. */
    template <class Work>
    __attribute__((always_inline)) void
    for_nodes(const Work &work) const
    {
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = row_begin(j, k), end = i + n[0]; i < end; ++i)
            work(i, records[i]);
    }

    /** The number of the first node of a row. */
    static int
    row_begin(const int j, const int k)
    {
      return longest * (longest * k + j);
    }

    std::array<int, 3> n; // nodes along each direction
    // First node of the cell of the points in the block: 0 or 1
    std::array<double, dim> cell_begin;
    // First of the two cells that each point sees
    Vector start;
    // Whether a domain extends beyond a side of the grid, per direction
    std::array<bool, dim> reaches_beyond;
    // record offsets, first direction fastest, rows of length `longest`
    std::array<std::uint32_t, n_nodes> records;

  private:
    /** Index of the first cell in the lattice of cells of one size. */
    using Place = std::array<std::int64_t, 3>;

    bool
    read_records(const BinView<dim> &bins, const Place &first);

    bool
    collect_records(const GridView<dim>     &grid,
                    const CellGeometry<dim> &geometry,
                    const Place             &first);
  };
} // namespace limber

#endif
