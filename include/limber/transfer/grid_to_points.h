// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_grid_to_points_h
#define limber_transfer_grid_to_points_h

#include <limber/points/point_view.h>

namespace limber
{
  /** Options of G2P for the points of a body. */
  struct G2POptions
  {
    // FLIP share alpha of the velocity increment; the rest is the velocity
    // itself (PIC): v = alpha (v + sum N dv) + (1 - alpha) sum N v.
    double flip_share = 1;
    // Points store a velocity gradient: APIC with alpha = 0, else AFLIP.
    bool affine = false;
    // With linear functions: nodes with less mass than this per volume of a
    // cell, kg/m^3, are light (LightNodes); 0: none
    double light_density = 0;
    bool   remap         = false; // re-map the new momentum to the nodes (MUSL)
    double move          = 0;     // step by which points move with the grid, s
  };



  /** Results of a G2P sweep. */
  struct VelocitySummary
  {
    double speed_squared = 0; // the largest, m^2/s^2
    double displacement  = 0; // the largest over the edge of its cell
    double removed       = 0; // kinetic energy that FLIP would have kept, J
  };



  /**
   * G2P: update the velocities of the points from the nodes and, on request,
   * move the points or map the new momentum back to the nodes with the weights
   * of the old positions (MUSL). If the points move and @p sums are given, the
   * cell sums at the new positions are gathered.
   */
  template <int dim>
  VelocitySummary
  grid_to_points(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const G2POptions     &what,
                 const CellSums<dim>  *sums);



  /** Gather the sums of the cells at the present positions of the points. */
  template <int dim>
  void
  gather_cell_sums(const PointView<dim> &points,
                   const GridView<dim>  &grid,
                   const CellSums<dim>  &sums);
} // namespace limber

#endif
