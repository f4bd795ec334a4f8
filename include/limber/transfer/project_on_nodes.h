// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_project_on_nodes_h
#define limber_transfer_project_on_nodes_h

#include <limber/points/point_view.h>

namespace limber
{
  /**
   * The sums over the points of a body, in the records of NodalMeanLayout,
   * from which its projection on nodes follows (nodal_means.h): of the
   * divergence of the re-mapped, or else the new, velocity of the nodes.
   */
  template <int dim>
  void
  sum_divergence(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 bool                  remapped,
                 double               *records);

  /** The same of the pressure that the points store (times J). */
  template <int dim>
  void
  sum_pressure(const PointView<dim> &points,
               const GridView<dim>  &grid,
               double               *records);

  /**
   * The same of a quantity @p value with the weights m times @p ratio; both
   * arrays have a number for each point.
   */
  template <int dim>
  void
  sum_weighted(const PointView<dim> &points,
               const GridView<dim>  &grid,
               const double         *ratio,
               const double         *value,
               double               *records);
} // namespace limber

#endif
