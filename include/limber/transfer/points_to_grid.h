// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_points_to_grid_h
#define limber_transfer_points_to_grid_h

#include <limber/points/point_view.h>

namespace limber
{
  /** What the points of a body give to the nodes in one sweep. */
  struct GiveToGrid
  {
    bool   momentum        = true;  // mass and momentum
    bool   force           = true;  // internal force
    bool   affine          = false; // momentum with the affine part (APIC)
    bool   history         = true;  // the volumetric sums of projected bodies
    double inverse_density = 0;     // 1 / rho_0 of the body, m^3/kg
  };



  /**
   * Add to the nodes, with N_i and G_i = grad N_i at the points,
   *
   *   m_i = sum m N_i,  p_i = sum m N_i (v + C (x_i - x)),
   *   f_i = - sum (m/rho_0) (J sigma) G_i
   *
   * (theory: Mast et al. 2012, mass-specific form). Where @p sums is given,
   * the body is projected: only the deviatoric stress acts at once, while the
   * sums of each cell are gathered; add_projected_pressure() adds the rest
   * when they are complete. Returns the number of batches.
   */
  template <int dim>
  std::size_t
  points_to_grid(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const GiveToGrid     &what,
                 const CellSums<dim>  *sums);



  /**
   * Turn the complete sums of the given cells into averages, in place: shares
   * in nodal masses into means of the monomials over the points (slot 0 keeps
   * the mass), the volumetric sum into its mean. With @p add_force also do
   * what add_projected_pressure() does, in the same pass over the cells.
   */
  template <int dim>
  void
  average_cells(const std::uint32_t *cells,
                std::size_t          n_cells,
                const GridView<dim> &grid,
                const CellSums<dim> &sums,
                bool                 add_force);



  /**
   * Add the force of the mean pressure of each of the given cells, whose
   * sums have been averaged, with the weights that average the divergence:
   * f_i += (sum V p) <G_i>, where the mean of G_i over the points follows
   * from those of the monomials.
   */
  template <int dim>
  void
  add_projected_pressure(const std::uint32_t *cells,
                         std::size_t          n_cells,
                         const GridView<dim> &grid,
                         const CellSums<dim> &sums);
} // namespace limber

#endif
