// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_joining_h
#define limber_adaptation_joining_h

#include <limber/adaptation/occupancy.h>

#include <unordered_set>

/**
 * @file Points that become one. Mass, momentum and the centre of mass stay;
 * kinetic energy, 1/2 sum m |v - V|^2, and some strain energy go, and moment of
 * momentum of points that do not move as one. Nodal records change, so it is
 * done only where no small mass is near and motion and stress are even.
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
   * Sets of points, by their places in the arrays, that may be joined. Points
   * are in owned cells. A set fills the room of one point of the cell's level
   * with points of the next finer one, about 2^dim of them, none of them
   * @p kept. All cells around the cell have points, it has points of this
   * body alone, their velocity differs from a linear function by less than
   * 1e-3 c and their stress from its mean by less than 5 %, or by less than a
   * velocity of 1e-3 c makes in a wave, 1e-3 rho c^2. Collective.
   */
  template <int dim>
  std::vector<std::vector<std::size_t>>
  sets_to_join(const BackgroundGrid<dim>               &grid,
               const Occupancy<dim>                    &occupancy,
               const MaterialBody<dim>                 &body,
               const std::unordered_set<std::uint64_t> &kept);

  /** Join them; returns the kinetic and strain energy that goes, J. */
  template <int dim>
  double
  join(const std::vector<std::vector<std::size_t>> &sets,
       MaterialBody<dim>                           &body);
} // namespace limber

#endif
