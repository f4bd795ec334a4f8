// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_convected_transfer_h
#define limber_transfer_convected_transfer_h

#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>

#include <vector>

/**
 * @file Sweeps of points with domains (GIMP, CPDI; interpolation/convected.h),
 * each of which has a stencil of its own.
 */
namespace limber
{
  /** points_to_grid() for them; returns the number of batches. */
  template <int dim>
  std::size_t
  domains_to_grid(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const P2GOptions     &what);



  /**
   * grid_to_points() for them; if the points move, their domains are convected.
   */
  template <int dim>
  VelocitySummary
  grid_to_domains(const PointView<dim> &points,
                  const GridView<dim>  &grid,
                  const G2POptions     &what);



  /**
   * sum_divergence() for them: with NodalMeanSums of domain_means.h for means
   * around nodes, with CellMeanSums for means over cells.
   */
  template <class Sums, int dim>
  void
  sum_divergence_of_domains(const PointView<dim> &points,
                            const GridView<dim>  &grid,
                            bool                  remapped,
                            double               *records);



  /** Sums over cells for the mean of the stored pressure J p. */
  template <int dim>
  void
  sum_pressure_over_cells(const PointView<dim> &points, double *records);



  /**
   * The cells of the corners of domains that overlap several cells, ascending:
   * their nodes get mass as well.
   */
  template <int dim>
  std::vector<std::uint32_t>
  cells_of_corners(const PointView<dim> &points, const GridView<dim> &grid);
} // namespace limber

#endif
