// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/points_to_splines_sweep.h>

namespace limber
{
  template std::size_t
  points_to_splines<Cubic<2>>(const PointView<2> &,
                              const GridView<2> &,
                              const P2GOptions &,
                              const CellSums<2> *);
  template std::size_t
  points_to_splines<Cubic<3>>(const PointView<3> &,
                              const GridView<3> &,
                              const P2GOptions &,
                              const CellSums<3> *);
} // namespace limber
