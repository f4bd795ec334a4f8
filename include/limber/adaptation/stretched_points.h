// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_stretched_points_h
#define limber_adaptation_stretched_points_h

#include <limber/state/material_body.h>

#include <unordered_set>

namespace limber
{
  /**
   * The points of a body that have become longer than 2/3 of their cell in some
   * direction, and how each is to be divided along it: in two, or in three if
   * it is @p kept and must stay in place. Neighbours a cell apart share too few
   * nodes to be connected, and further stretch would meet no resistance
   * (numerical fracture).
   *
   * The half edge along an axis d is C_d / sqrt(C_dd), with C_ij = s_i b_ij s_j
   * from the left Cauchy-Green tensor b of the (elastic) law, and the initial
   * half edges s, reduced by former divisions. Domains have edges of their own.
   * The rate of stretch follows from the mass-weighted linear fit of the
   * velocities of the points in the cells around; zero if these are in one row.
   * Points are in owned cells. Collective.
   */
  template <int dim>
  std::vector<Division<dim>>
  stretched_points(const BackgroundGrid<dim>               &grid,
                   const MaterialBody<dim>                 &body,
                   const std::unordered_set<std::uint64_t> &kept);
} // namespace limber

#endif
