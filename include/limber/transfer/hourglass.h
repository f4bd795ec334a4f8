// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_hourglass_h
#define limber_transfer_hourglass_h

#include <limber/grid/grid_view.h>

#include <vector>

namespace limber
{
  /** A body that resists hourglass motion: its masses in the cells, chi c. */
  template <int dim>
  struct HourglassResistance
  {
    CellSums<dim> sums;
    double        speed = 0; // chi times the wave speed, m/s
  };



  /**
   * Viscous resistance to the motions of a cell that averages over it do not
   * see: for each hourglass mode with signs s_a at the nodes a, and its
   * amplitude q = sum s_a v_a / 2^dim,
   *
   *   f_a -= s_a k q,  k = sum over bodies chi c m_cell / h,
   *
   * with k at most half (a quarter in 3d) of the smallest nodal mass over the
   * step, which keeps it stable. Adds to no force and no moment, and leaves
   * linear fields alone (theory: doc/theory/treatments.md). Reads mass and
   * momentum of the nodes, adds the forces to the re-mapped slots, which are
   * not in use then.
   */
  template <int dim>
  void
  resist_hourglass(const std::vector<std::uint32_t>            &cells,
                   const GridView<dim>                         &grid,
                   const std::vector<HourglassResistance<dim>> &bodies,
                   double                                       step);
} // namespace limber

#endif
