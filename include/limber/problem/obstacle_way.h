// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_obstacle_way_h
#define limber_problem_obstacle_way_h

#include <limber/problem/problem.h>

namespace limber
{
  /**
   * How far the corner of an obstacle's box that goes the furthest moves in a
   * step of so many seconds from @p time on, m; where the obstacle has no end,
   * the corner of the grid. Infinite or undefined where its place is.
   */
  template <int dim>
  double
  way_of_obstacle(const Obstacle<dim>        &obstacle,
                  const GridDescription<dim> &grid,
                  double                      time,
                  double                      step);

  /**
   * @p step, or so much of it that no obstacle of the scene moves by more than
   * the Courant number in edges of the smallest cells; it starts at @p time.
   */
  template <int dim>
  double
  step_that_obstacles_allow(const Problem<dim> &problem,
                            double              time,
                            double              step);
} // namespace limber

#endif
