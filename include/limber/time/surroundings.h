// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_surroundings_h
#define limber_time_surroundings_h

#include <limber/grid/nodal_fields.h>

#include <vector>

namespace limber
{
  /**
   * Which of the cells around the vertices of a mesh hold material: finds free
   * surfaces. A hanging vertex is no corner of the larger cells around it; its
   * masters are.
   */
  template <int dim>
  class Surroundings
  {
  public:
    explicit Surroundings(const BackgroundGrid<dim> &grid)
      : grid(grid)
    {}

    /** Adopt a mesh; collective. */
    void
    reinit();

    /**
     * Find which cells hold material, asking holds(cell) for each occupied one
     * of this rank; collective. Others that @p taken marks by vertex, in the
     * same way as this class (covered by obstacles), count as holding in any
     * case: next to them there is no free surface.
     */
    template <class Holds>
    void
    find(const NodalFields<dim> &vertices,
         const Holds            &holds,
         const double *const     taken = nullptr)
    {
      for (const std::uint32_t node : vertices.active_nodes())
        holding[node] = 0;
      for (const std::uint32_t cell : vertices.owned_occupied_cells())
        if (holds(cell))
          add(holding, cell);
      exchange.start(vertices.node_plan(), holding.data(), 0, 1);
      exchange.finish(holding.data());
      if (taken != nullptr)
        for (const std::uint32_t node : vertices.active_nodes())
          holding[node] += taken[node];
      find_surrounded(vertices.active_nodes());
      for (const auto *const cells :
           {&vertices.owned_occupied_cells(), &vertices.ghost_occupied_cells()})
        find_inside(*cells);
    }

    /** Whether all cells around a vertex hold material; for vertices that were
     * active in find(). */
    bool
    is_surrounded(const std::uint32_t node) const
    {
      return surrounded[node];
    }

    /** Whether all cells around the vertices of a cell hold material; for cells
     * that were occupied in find(). */
    bool
    is_inside(const std::uint32_t cell) const
    {
      return inside[cell];
    }

    /** Whether the neighbour of a cell holds material, at the lower end (0) of
     * a direction or the upper (1). */
    bool
    has_neighbour(std::uint32_t cell,
                  unsigned int  direction,
                  unsigned int  end) const;

    /** The same, or whether a side of the grid is there. */
    bool
    is_bounded(const std::uint32_t cell,
               const unsigned int  direction,
               const unsigned int  end) const
    {
      return has_neighbour(cell, direction, end) ||
             (grid.vertices.sides[node_of(cell, end << direction)] >>
                (2 * direction + end) &
              1);
    }

    std::uint32_t
    node_of(const std::uint32_t cell, const unsigned int corner) const
    {
      return grid.geometry[cell].node[corner] / NodeLayout<dim>::stride;
    }

  private:
    static constexpr unsigned int n_corners = 1 << dim;

    /** Set the bits of a cell at its corners. */
    void
    add(LazyArray<double> &to, const std::uint32_t cell) const
    {
      for (unsigned int a = 0; a < n_corners; ++a)
        to[node_of(cell, a)] += 1u << a;
    }

    void
    find_surrounded(const std::vector<std::uint32_t> &nodes);
    void
    find_inside(const std::vector<std::uint32_t> &cells);

    bool
    hangs(const std::uint32_t node) const
    {
      return !masters_of.empty() && masters_of[node] != nullptr;
    }

    const BackgroundGrid<dim> &grid;
    // By vertex, bits: which cells have it as a corner, and which of these hold
    // material; the sum of 2^k, the vertex being their corner k
    LazyArray<double> cells_at, holding;
    RecordExchange    exchange{1};
    LazyArray<bool>   surrounded; // by vertex
    LazyArray<bool>   inside;     // by cell
    // By vertex, its constraint as a hanging node; null: it does not hang.
    // Empty where none hangs
    std::vector<const HangingNode *> masters_of;
  };
} // namespace limber

#endif
