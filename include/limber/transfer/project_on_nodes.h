// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_project_on_nodes_h
#define limber_transfer_project_on_nodes_h

#include <limber/points/point_view.h>

namespace limber
{
  /**
   * Nodal sums (NodalMeanLayout) over the points of a body for the lumped
   * projection (nodal_means.h) of the divergence of the re-mapped or else the
   * new nodal velocity.
   */
  template <int dim>
  void
  sum_divergence(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 bool                  remapped,
                 double               *records);

  /** The same for the stored pressure J p. */
  template <int dim>
  void
  sum_pressure(const PointView<dim> &points,
               const GridView<dim>  &grid,
               double               *records);

  /**
   * The same for a quantity @p value with the weights m times @p ratio, both
   * given by point.
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
