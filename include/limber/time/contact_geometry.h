// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_geometry_h
#define limber_time_contact_geometry_h

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>

/** @file What contact with bodies and with obstacles have in common. */
namespace limber
{
  /** The part of a vector across a unit normal: along the surface. */
  template <int dim>
  inline dealii::Tensor<1, dim>
  along_surface(const dealii::Tensor<1, dim> &vector,
                const dealii::Tensor<1, dim> &normal)
  {
    return vector - (vector * normal) * normal;
  }



  /**
   * Whether material that goes @p reach (m) from its point may press in a step
   * over a gap (m) that it closes by @p nearer (m) in the step by itself: with
   * some room for what else may move it.
   */
  inline bool
  may_press(const double gap, const double nearer, const double reach)
  {
    return gap <= 2 * nearer + 0.02 * reach;
  }



  /**
   * The least of what a gap may grow by in a step, m: it may close; of what has
   * gone in, a tenth comes out, and no more than a fiftieth of the reach.
   */
  inline double
  least_growth(const double gap, const double reach)
  {
    return gap > 0 ? -gap : std::min(-0.1 * gap, 0.02 * reach);
  }

} // namespace limber

#endif
