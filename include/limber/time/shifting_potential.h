// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_shifting_potential_h
#define limber_time_shifting_potential_h

#include <limber/grid/nodal_fields.h>

#include <vector>

namespace limber
{
  /**
   * Displacement potential phi that makes room for a liquid whose nodes are
   * uniformly overfilled, its points taking less volume than they should:
   * Poisson's equation
   *
   *   - div (grad phi) = g,   phi = 0 at free surfaces,
   *
   * with natural conditions (no flux) at walls, in natural coordinates of the
   * cells, by linear functions. Points that move by - grad phi (in cells)
   * expand by the overfill g. Solved by few steps of Chebyshev's iteration: it
   * needs no sums over all nodes (dot products), and waves longer than it
   * resolves are left to the next time. For cells of one size.
   */
  template <int dim>
  class ShiftingPotential
  {
  public:
    explicit ShiftingPotential(const BackgroundGrid<dim> &grid)
      : grid(grid)
    {}

    /** Adopt a mesh. */
    void
    reinit();

    /** Start a new system with these nodes, active of @p vertices. */
    void
    clear(const NodalFields<dim> &vertices);

    /** Add a cell of this rank that holds liquid, with the volume in m^3 that
     * obstacles leave of it. */
    void
    add_cell(std::uint32_t cell, double volume);

    /** Set the source of a node: its overfill g times its nodal volume, m^3. A
     * node at a free surface is fixed. Once per node, the same on all ranks. */
    void
    set_source(const std::uint32_t node, const double source, const bool fixed)
    {
      double *const of_node     = record(node);
      of_node[Record::residual] = source;
      of_node[Record::is_free]  = !fixed;
    }

    /** Find phi; collective. */
    void
    solve(const NodalFields<dim> &vertices);

    double
    at(const std::uint32_t node) const
    {
      return records[std::size_t(node) * Record::stride + Record::potential];
    }

  private:
    static constexpr unsigned int n_corners = 1 << dim;

    struct Record
    {
      static constexpr unsigned int potential = 0, residual = 1, is_free = 2,
                                    direction = 3, product = 4, diagonal = 5,
                                    stride = 6;
    };

    struct Cell
    {
      std::uint32_t number;
      double        volume;
    };

    void
    multiply(const NodalFields<dim> &vertices);
    void
    sum_over_cells(const NodalFields<dim> &vertices, unsigned int slot);

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * Record::stride;
    }

    double *
    record_at(const std::uint32_t cell, const unsigned int corner)
    {
      return record(grid.geometry[cell].node[corner] / NodeLayout<dim>::stride);
    }

    const BackgroundGrid<dim> &grid;
    LazyArray<double>          records; // by vertex
    RecordExchange             exchange{Record::stride};
    std::vector<Cell>          cells;
  };
} // namespace limber

#endif
