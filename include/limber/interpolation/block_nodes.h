// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_interpolation_block_nodes_h
#define limber_interpolation_block_nodes_h

#include <limber/interpolation/batch_lanes.h>

namespace limber
{
  /**
   * Blocks of 2^dim cells around the points of a pack, one for each, where all
   * cells are alike: the 3^dim nodes whose functions a domain no longer than a
   * cell can see.
   */
  template <int dim>
  class BlockNodes
  {
  public:
    using Number                  = PointPack<dim>;
    using Vector                  = std::array<Number, dim>;
    static constexpr int n_points = pack_width<Number>;
    static constexpr int n_nodes  = dim == 2 ? 9 : 27;
    static constexpr int n_cells  = 1 << dim;

    /**
     * Find the blocks of the first @p n points, which are in @p cell. In cells,
     * points are @p at from the lower corner of the bins, and afterwards from
     * the lower corners of their blocks, and nothing of their domains is
     * farther than @p half from them. False if a point has none.
     */
    __attribute__((always_inline)) bool
    find(const GridView<dim> &grid,
         const std::uint32_t  cell,
         const int            n,
         Vector              &at,
         const Vector        &half)
    {
      const BinView<dim> &bins = grid.bins;
      if (rarely(!bins.one_per_cell))
        return find_of_size(grid, grid.cells[cell], n, at, half);
      Number index = Number{};
#pragma GCC unroll 3
      for (int d = dim - 1; d >= 0; --d)
        {
          if (bins.n[d] < 2)
            return false;
          const double last  = static_cast<double>(bins.n[d] - 2);
          const Number lower = at[d] - half[d];
          const Number inner = lower > 0. ? lower : Number{};
          const Number block =
            rounded_down(inner < last ? inner : broadcast<Number>(last));
          at[d] -= block;
          store(at[d] + half[d], end[d]);
          index = index * static_cast<double>(bins.n[d]) + block;
        }

      const auto bin = to_integers(index);
      for (int p = 0; p < n; ++p)
#pragma GCC unroll 8
        for (int c = 0; c < n_cells; ++c)
          {
            std::int64_t offset = c & 1;
            if (c & 2)
              offset += bins.n[0];
            if (c & 4)
              offset += bins.n[0] * bins.n[1];
            const std::uint32_t there = bins.table[bin[p] + offset];
            if (rarely(there == invalid_cell))
              return false;
            blocks[p][c] = &grid.cells[there].node;
          }
      return true;
    }

    /** Whether nothing of point p reaches the last nodes along d. */
    bool
    ends_before(const int p, const int d, const int digit) const
    {
      return digit == 2 && end[d][p] <= 1;
    }

    /** The record of node i of the block of point p. */
    __attribute__((always_inline)) std::uint32_t
    record(const int p, const int i) const
    {
      return (*blocks[p][cell_with_node(i)])[node_in_cell(i)];
    }

    /** Call work(i, record) for the nodes of the block of point p. */
    template <class Work>
    __attribute__((always_inline)) void
    for_nodes(const int p, const Work &work) const
    {
#pragma GCC unroll 9
      for (int row = 0; row < n_nodes / 3; ++row)
        {
          if (ends_before(p, 1, row % 3) ||
              (dim == 3 && ends_before(p, dim - 1, row / 3)))
            continue;
#pragma GCC unroll 3
          for (int i = 3 * row; i < 3 * row + 3; ++i)
            work(i, record(p, i));
        }
    }

  private:
    /** Where cells have several sizes: blocks of cells of the size of this. */
    __attribute__((noinline)) bool
    find_of_size(const GridView<dim>     &grid,
                 const CellGeometry<dim> &geometry,
                 const int                n,
                 Vector                  &at,
                 const Vector            &half)
    {
      const BinView<dim> &bins = grid.bins;
      Vector              first;
      for (int d = 0; d < dim; ++d)
        {
          const double last =
            std::round(static_cast<double>(bins.n[d]) *
                       geometry.inverse_edge[d] / bins.inverse_edge[d]) -
            2;
          if (last < 0)
            return false;
          const Number lower = at[d] - half[d];
          const Number inner = lower > 0. ? lower : Number{};
          first[d] =
            rounded_down(inner < last ? inner : broadcast<Number>(last));
          at[d] -= first[d];
          store(at[d] + half[d], end[d]);
        }
      for (int p = 0; p < n; ++p)
        for (int c = 0; c < n_cells; ++c)
          {
            std::array<double, dim> middle;
            for (int d = 0; d < dim; ++d)
              middle[d] = bins.lower[d] + (first[d][p] + (c >> d & 1) + 0.5) /
                                            geometry.inverse_edge[d];
            const std::uint32_t there = bins.cell_at(middle);
            if (there == invalid_cell)
              return false;
            const double ratio =
              grid.cells[there].inverse_edge[0] / geometry.inverse_edge[0];
            if (ratio > 1.5 || ratio < 0.75)
              return false;
            blocks[p][c] = &grid.cells[there].node;
          }
      return true;
    }

    /** The place of node i of a block along d: 0, 1, 2. */
    static constexpr int
    digit(const int i, const int d)
    {
      return i / (d == 0 ? 1 : d == 1 ? 3 : 9) % 3;
    }

    /** The cell of the block that has node i, and which of its nodes that is.
     */
    static constexpr int
    cell_with_node(const int i)
    {
      int result = 0;
      for (int d = 0; d < dim; ++d)
        result |= (digit(i, d) == 2) << d;
      return result;
    }

    static constexpr int
    node_in_cell(const int i)
    {
      int result = 0;
      for (int d = 0; d < dim; ++d)
        result |= (digit(i, d) != 0) << d;
      return result;
    }

    // Of each point the records of the nodes of the cells of its block, and
    // where in it the domain ends, in cells
    const std::array<std::uint32_t, n_cells> *blocks[n_points][n_cells];
    alignas(64) double end[dim][n_points];
  };
} // namespace limber

#endif
