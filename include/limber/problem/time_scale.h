// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_time_scale_h
#define limber_problem_time_scale_h

#include <limber/problem/problem.h>

namespace limber
{
  /**
   * Shortest time scale of what drives a scene, s: velocities of sides, motions
   * of obstacles and the body force; 1/omega where they go as sin(omega t). It
   * is the root mean square of each about its mean over that of its rate,
   * sampled in the box and over the run; infinite where nothing changes.
   */
  template <int dim>
  double
  time_scale_of_formulas(const Problem<dim> &problem);
} // namespace limber

#endif
