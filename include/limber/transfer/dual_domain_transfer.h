// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_dual_domain_transfer_h
#define limber_transfer_dual_domain_transfer_h

#include <limber/transfer/points_to_grid.h>

/**
 * @file P2G sweeps of the dual domain method (interpolation/dual_domain.h); the
 * grid must have records for it.
 */
namespace limber
{
  /**
   * P2G of internal forces: add to the nodes the forces of the share alpha of
   * the stress, which acts on grad N_i, and the rest to their tensors,
   *
   *   f_i = - sum alpha V sigma grad N_i,   T_j = sum (1 - alpha) N_j V sigma,
   *
   * V sigma = (m/rho_0) J sigma. Returns the number of batches.
   */
  template <int dim>
  std::size_t
  stress_to_dual_domain(const PointView<dim> &points,
                        const GridView<dim>  &grid,
                        const P2GOptions     &what);



  /**
   * sum_divergence() for this method: with NodalMeanSums of domain_means.h for
   * means around nodes, with CellMeanSums for means over cells.
   */
  template <class Sums, int dim>
  void
  sum_divergence_of_dual_domain(const PointView<dim> &points,
                                const GridView<dim>  &grid,
                                bool                  remapped,
                                double               *records);
} // namespace limber

#endif
