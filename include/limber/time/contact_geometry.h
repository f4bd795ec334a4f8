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



  /**
   * How far what flows goes from its points is not known well: others come
   * between those of its surface, and all are sheared. Pushed out of what it
   * touches it would gain energy, so where a @p gap (m) is negative, it ends
   * there instead. How much is left of the way (m) that it goes from its
   * points; the rest is no longer part of the gap.
   */
  inline double
  share_left(double &gap, const double way)
  {
    if (gap >= 0 || !(way > 0))
      return 1;
    const double share = std::max(0., 1 + gap / way);
    gap += (1 - share) * way;
    return share;
  }



  /** Of an impulse (kg m/s) at the end of an arm (m), kg m^2/s; in the plane
   * the last of three. */
  template <int dim>
  inline dealii::Tensor<1, 3>
  moment_of(const dealii::Tensor<1, dim> &arm,
            const dealii::Tensor<1, dim> &impulse)
  {
    dealii::Tensor<1, 3> result;
    result[2] = arm[0] * impulse[1] - arm[1] * impulse[0];
    if constexpr (dim == 3)
      {
        result[0] = arm[1] * impulse[2] - arm[2] * impulse[1];
        result[1] = arm[2] * impulse[0] - arm[0] * impulse[2];
      }
    return result;
  }
} // namespace limber

#endif
