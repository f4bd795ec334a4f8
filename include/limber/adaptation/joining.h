// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_joining_h
#define limber_adaptation_joining_h

#include <limber/adaptation/occupancy.h>

#include <unordered_set>

/**
 * @file Joining (merging) of points. Mass, momentum and the centre of mass are
 * conserved; kinetic energy, 1/2 sum m |v - V|^2, and some strain energy are
 * lost, and angular momentum of points that do not move as one. As nodal
 * records change, it is done only where no nodal mass is small and velocity and
 * stress are smooth.
 */
namespace limber
{
  /** Whether any point is of a finer size class than its cell; collective. */
  template <int dim>
  bool
  any_finer_than_cells(
    const BackgroundGrid<dim>                             &grid,
    const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

  /**
   * Sets of points, by index, that may be joined. Points are in owned cells. A
   * set fills the sub-box of one point of the cell's level with points of the
   * next finer class, about 2^dim of them, none of them @p kept. Conditions:
   * all cells around the cell have points, it contains points of this body
   * only, their velocity deviates from the linear fit by less than 1e-3 c and
   * their stress from its mean by less than 5 %, or by less than 1e-3 rho c^2,
   * the stress of a wave with a velocity of 1e-3 c. Collective.
   */
  template <int dim>
  std::vector<std::vector<std::size_t>>
  sets_to_join(const BackgroundGrid<dim>               &grid,
               const Occupancy<dim>                    &occupancy,
               const MaterialBody<dim>                 &body,
               const std::unordered_set<std::uint64_t> &kept);

  /** Join them; returns the kinetic and strain energy that is lost, J. */
  template <int dim>
  double
  join(const std::vector<std::vector<std::size_t>> &sets,
       MaterialBody<dim>                           &body);
} // namespace limber

#endif
