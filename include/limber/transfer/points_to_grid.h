// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_points_to_grid_h
#define limber_transfer_points_to_grid_h

#include <limber/materials/treatment.h>
#include <limber/points/point_view.h>

namespace limber
{
  /** Options of P2G for the points of a body. */
  struct P2GOptions
  {
    bool            momentum        = true;  // mass and momentum
    bool            force           = true;  // internal force
    bool            pressure        = true;  // pressure part of the force
    bool            affine          = false; // momentum with C (APIC)
    double          inverse_density = 0;     // 1 / rho_0, m^3/kg
    StrainTreatment treatment;               // of the force
    // Pressure projected on nodes (nodal_means.h) or, for domains, averaged
    // (domain_means.h), if the treatment needs it
    const double *projected_pressure = nullptr;
    // By cell, with Treatment::cell: factor of the pressure of a liquid
    // (LiquidMeans); null: one
    const double *volume_shares = nullptr;
  };



  /**
   * P2G: add to the nodes, with N_i at the points and B the strain operator of
   * the body's treatment (strain_operator.h),
   *
   *   m_i = sum m N_i,  p_i = sum m N_i (v + C (x_i - x)),
   *   f_i = - sum (m/rho_0) B_i^T (J sigma)
   *
   * (Mast et al. 2012, mass-specific form); in the initial frame the forces
   * come from the StressUpdate. @p sums may be null if nothing is averaged;
   * forces without the pressure are for Treatment::cell. Returns the number of
   * batches.
   */
  template <int dim>
  std::size_t
  points_to_grid(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const P2GOptions     &what,
                 const CellSums<dim>  *sums);
} // namespace limber

#endif
