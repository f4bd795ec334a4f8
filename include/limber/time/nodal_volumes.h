// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_nodal_volumes_h
#define limber_time_nodal_volumes_h

#include <limber/time/cut_cells.h>

namespace limber
{
  /** Nodal volumes of the vertices of a mesh: R_i, the integral of N_i over
   * what obstacles leave of the box, m^3; a liquid fills it inside. */
  template <int dim>
  class NodalVolumes
  {
  public:
    /** Cells that obstacles cut, or null. */
    NodalVolumes(const BackgroundGrid<dim> &grid,
                 const CutCells<dim>       *cut_cells);

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

    /** R_i, see beside_obstacle(). */
    double
    at(const std::uint32_t node) const
    {
      return is_at_obstacle(node) ?
               beside_obstacle(cut_cells->open_nodal_volumes()[node],
                               nodal_volumes[node]) :
               nodal_volumes[node];
    }

    /** R_i where obstacles leave @p open of the volume @p whole: zero where
     * that is so little (small cut) that a single point would overfill it by
     * far. */
    static double
    beside_obstacle(const double open, const double whole)
    {
      return open < least_share * whole ? 0 : open;
    }

  private:
    static constexpr double least_share = 0.1;

    const BackgroundGrid<dim> &grid;
    const CutCells<dim> *const cut_cells;     // or null
    LazyArray<double>          nodal_volumes; // of the box alone
    RecordExchange             exchange{1};
  };
} // namespace limber

#endif
