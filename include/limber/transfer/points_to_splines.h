// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_points_to_splines_h
#define limber_transfer_points_to_splines_h

#include <limber/transfer/points_to_grid.h>

namespace limber
{
  /**
   * points_to_grid() with splines, those of @p Basis; each degree in its own
   * translation unit.
   */
  template <class Basis>
  std::size_t
  points_to_splines(const PointView<Basis::dim> &points,
                    const GridView<Basis::dim>  &grid,
                    const P2GOptions            &what,
                    const CellSums<Basis::dim>  *sums);
} // namespace limber

#endif
