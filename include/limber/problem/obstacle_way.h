// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_obstacle_way_h
#define limber_problem_obstacle_way_h

#include <limber/problem/problem.h>

namespace limber
{
  /**
   * Largest displacement, m, of a corner of the obstacle's bounding box in a
   * step from @p time on, s; of the corners of the grid where the obstacle is
   * unbounded. Infinite or undefined where its position is.
   */
  template <int dim>
  double
  way_of_obstacle(const Obstacle<dim>        &obstacle,
                  const GridDescription<dim> &grid,
                  double                      time,
                  double                      step);

  /**
   * @p step from @p time on, or as much of it as keeps the displacement of each
   * obstacle below the Courant number times the smallest edge of a cell (CFL
   * condition).
   */
  template <int dim>
  double
  step_that_obstacles_allow(const Problem<dim> &problem,
                            double              time,
                            double              step);
} // namespace limber

#endif
