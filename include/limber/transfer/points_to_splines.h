// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_points_to_splines_h
#define limber_transfer_points_to_splines_h

#include <limber/transfer/points_to_grid.h>

namespace limber
{
  /** What points_to_grid() does where the functions are quadratic splines. */
  template <int dim>
  std::size_t
  points_to_splines(const PointView<dim> &points,
                    const GridView<dim>  &grid,
                    const GiveToGrid     &what,
                    const CellSums<dim>  *sums);
} // namespace limber

#endif
