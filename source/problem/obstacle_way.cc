// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/obstacle_way.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  template <int dim>
  double
  way_of_obstacle(const Obstacle<dim>        &obstacle,
                  const GridDescription<dim> &grid,
                  const double                time,
                  const double                step)
  {
    if (!obstacle.moves())
      return 0;
    const ObstaclePlace<dim> before(obstacle, time),
      after(obstacle, time + step);
    if (!before.is_finite() || !after.is_finite())
      return std::numeric_limits<double>::infinity();
    const Corners<dim> box    = obstacle.shape->bounding_box();
    double             result = 0;
    for (unsigned int corner = 0; corner < 1u << dim; ++corner)
      {
        dealii::Point<dim> start, in_grid;
        bool               ends = true;
        for (int d = 0; d < dim; ++d)
          {
            const bool upper = corner >> d & 1;
            start[d]         = upper ? box.second[d] : box.first[d];
            in_grid[d]       = upper ? grid.upper[d] : grid.lower[d];
            ends             = ends && std::isfinite(start[d]);
          }
        if (!ends)
          start = before.start_of(in_grid);
        result =
          std::max(result,
                   before.place_of(start).distance(after.place_of(start)));
      }
    return result;
  }



  template <int dim>
  double
  step_that_obstacles_allow(const Problem<dim> &problem,
                            const double        time,
                            double              step)
  {
    double edge = problem.grid.finest_edge(0);
    for (unsigned int d = 1; d < dim; ++d)
      edge = std::min(edge, problem.grid.finest_edge(d));
    const double most = std::min(0.5, problem.method.courant_number) * edge;
    for (const Obstacle<dim> &obstacle : problem.obstacles)
      for (unsigned int halvings = 0; halvings < 30; ++halvings)
        {
          const double way =
            way_of_obstacle(obstacle, problem.grid, time, step);
          if (!(way > most) || !std::isfinite(way))
            break;
          step *= std::max(0.5, 0.9 * most / way);
        }
    return step;
  }



  template double
  way_of_obstacle(const Obstacle<2> &,
                  const GridDescription<2> &,
                  double,
                  double);
  template double
  way_of_obstacle(const Obstacle<3> &,
                  const GridDescription<3> &,
                  double,
                  double);
  template double
  step_that_obstacles_allow(const Problem<2> &, double, double);
  template double
  step_that_obstacles_allow(const Problem<3> &, double, double);
} // namespace limber
