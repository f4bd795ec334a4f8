// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_node_rooms_h
#define limber_time_node_rooms_h

#include <limber/time/cut_cells.h>

namespace limber
{
  /** Nodal volumes of the vertices of a mesh: R_i, the integral of N_i over
   * what obstacles leave of the box, m^3; a liquid fills it inside. */
  template <int dim>
  class NodeRooms
  {
  public:
    /** Cells that obstacles cut, or null. */
    NodeRooms(const BackgroundGrid<dim> &grid, const CutCells<dim> *cut_cells);

    /** Adopt a mesh; collective. */
    void
    reinit();

    /** Whether obstacles take some of the volume of a vertex. */
    bool
    is_at_obstacle(const std::uint32_t node) const
    {
      return cut_cells != nullptr && (cut_cells->is_cut(node) ||
                                      cut_cells->covered_corners()[node] > 0);
    }

    /** R_i; zero where obstacles leave so little (small cut) that a single
     * point would overfill it by far. */
    double
    at(const std::uint32_t node) const
    {
      if (!is_at_obstacle(node))
        return rooms[node];
      const double left = cut_cells->rooms()[node];
      return left < least_share * rooms[node] ? 0 : left;
    }

  private:
    static constexpr double least_share = 0.1;

    const BackgroundGrid<dim> &grid;
    const CutCells<dim> *const cut_cells; // or null
    LazyArray<double>          rooms;     // of the box alone
    RecordExchange             exchange{1};
  };
} // namespace limber

#endif
