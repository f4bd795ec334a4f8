// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_stretched_points_h
#define limber_adaptation_stretched_points_h

#include <limber/state/material_body.h>

#include <unordered_set>

namespace limber
{
  /**
   * The points of a body that have become longer than 2/3 of their cell along
   * some direction, and how each is to be divided there: in two, those @p kept,
   * which must stay where they are, in three. Neighbours that stand a cell
   * apart share too few nodes to hold together, and nothing would resist any
   * further stretch (numerical fracture).
   *
   * The half edge along an axis d is C_d / sqrt(C_dd), with C_ij = s_i b_ij s_j
   * of the left Cauchy-Green tensor b of the law, which is elastic, and half
   * the edges s that the point has had at the start, less what divisions have
   * taken. Domains have edges of their own. It becomes longer as the linear
   * function of the place does that fits the velocities of the points in the
   * cells around best, weighted with mass; not at all where these points are in
   * one row. Points are in owned cells. Collective.
   */
  template <int dim>
  std::vector<Division<dim>>
  stretched_points(const BackgroundGrid<dim>               &grid,
                   const MaterialBody<dim>                 &body,
                   const std::unordered_set<std::uint64_t> &kept);
} // namespace limber

#endif
