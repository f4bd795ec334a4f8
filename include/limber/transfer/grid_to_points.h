// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_grid_to_points_h
#define limber_transfer_grid_to_points_h

#include <limber/points/point_view.h>

namespace limber
{
  /** What the points of a body take from the nodes in one sweep. */
  struct TakeFromGrid
  {
    // Share alpha of the velocity increment (FLIP); the rest is the velocity
    // itself (PIC): v = alpha (v + sum N dv) + (1 - alpha) sum N v.
    double flip_share = 1;
    // Points carry a gradient of their velocity: APIC with the share 0, else
    // AFLIP.
    bool affine = false;
    // With linear functions: nodes are light (LightNodes) if they have less
    // than so much per volume of a cell, kg/m^3; 0: none is.
    double light_density = 0;
    bool   remap         = false; // give the new momentum back to the nodes
    double move          = 0; // step by which the points move with the grid, s
  };



  /** What a sweep learns on its way. */
  struct VelocitySummary
  {
    double speed_squared = 0; // the largest, m^2/s^2
    double displacement  = 0; // the largest over the edge of its cell
    double removed       = 0; // kinetic energy that FLIP would have kept, J
  };



  /**
   * Update the velocities of the points from the nodes and, on request, move
   * the points and give the new momentum back to the nodes with the weights
   * of the old positions (MUSL). Where the points move and @p sums are given,
   * those of the new places are gathered.
   */
  template <int dim>
  VelocitySummary
  grid_to_points(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const TakeFromGrid   &what,
                 const CellSums<dim>  *sums);



  /** Gather the sums of the cells at the present places of the points. */
  template <int dim>
  void
  gather_cell_sums(const PointView<dim> &points,
                   const GridView<dim>  &grid,
                   const CellSums<dim>  &sums);
} // namespace limber

#endif
