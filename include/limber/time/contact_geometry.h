// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_contact_geometry_h
#define limber_time_contact_geometry_h

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>

/** @file Common to contact between bodies and with rigid obstacles. */
namespace limber
{
  /** Tangential part of a vector at a surface with this unit normal. */
  template <int dim>
  inline dealii::Tensor<1, dim>
  along_surface(const dealii::Tensor<1, dim> &vector,
                const dealii::Tensor<1, dim> &normal)
  {
    return vector - (vector * normal) * normal;
  }



  /**
   * Whether a gap (m) may close in a step, so that contact is considered:
   * @p nearer is the approach (m) at the present velocity, @p reach the extent
   * of the material of a point (m). The margin is for other forces in the step.
   */
  inline bool
  may_press(const double gap, const double nearer, const double reach)
  {
    return gap <= 2 * nearer + 0.02 * reach;
  }



  /**
   * Lower bound for the growth of a gap in a step, m: an open gap may close;
   * a tenth of a penetration is removed, at most a fiftieth of the reach.
   */
  inline double
  least_growth(const double gap, const double reach)
  {
    return gap > 0 ? -gap : std::min(-0.1 * gap, 0.02 * reach);
  }



  /**
   * For material that may flow plastically: no penetration is removed. The
   * extent of its material beyond its points is not known well, as other points
   * come between those of its surface and all are sheared; pushed out it would
   * gain energy. So where a @p gap (m) is negative, the extent @p way (m) is
   * shortened until it is closed, at most to zero. Returns the remaining
   * fraction of the extent and updates the gap.
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



  /** Angular impulse, kg m^2/s, of an impulse (kg m/s) with a lever arm (m);
   * in the plane only the third component. */
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
