// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/obstacle_way.h>
#include <limber/time/obstacle_contact.h>

#include <algorithm>
#include <cmath>

/** @file Checks of obstacles: no material in them at the start, no jumps. */
namespace limber
{
  template <int dim>
  void
  ObstacleContact<dim>::check_start() const
  {
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      {
        const ObstaclePlace<dim> place(obstacle, 0.);
        for (const auto &body : parts.bodies)
          {
            const PointView<dim> points  = body->points.view();
            double               deepest = 0;
            for (std::size_t p = 0; p < points.size; ++p)
              {
                dealii::Point<dim> x;
                for (int d = 0; d < dim; ++d)
                  x[d] = points.position[d][p];
                deepest = std::max(deepest, -place.distance(x).value);
              }
            deepest =
              dealii::Utilities::MPI::max(deepest, parts.grid.communicator);
            if (deepest > 1e-9 * parts.grid.smallest_edge)
              throw InputError(
                "Body " + in_quotes(body->description.name) +
                " reaches into obstacle " + in_quotes(obstacle.name) +
                " at the start, its points by up to " + brief(deepest) +
                " m. Usually one of them is misplaced. Move the body or the "
                "obstacle.");
          }
      }
  }



  template <int dim>
  void
  ObstacleContact<dim>::check_way(const unsigned int obstacle,
                                  const double       time,
                                  const double       step) const
  {
    const Obstacle<dim> &one = rigid[obstacle];
    if (!one.moves())
      return;
    const double way = way_of_obstacle(one, parts.problem.grid, time, step);
    if (!std::isfinite(way))
      throw ComputationError("Obstacle " + in_quotes(one.name) +
                               " has no finite place at time " +
                               brief(time + step) +
                               " s. Usually its formulas divide by zero. "
                               "Correct its 'Displacement' or 'Rotation'.",
                             FailureKind::not_finite);
    if (way > 0.5 * parts.grid.smallest_edge)
      throw ComputationError(
        "Obstacle " + in_quotes(one.name) + " moves by " +
        brief(way / parts.grid.smallest_edge) + " cells in one step of " +
        brief(step) + " s, at time " + brief(time) +
        " s; more than half a cell may pass through a body. Usually its "
        "formula jumps. Let it move more slowly, or lower "
        "'Method/Time step'.");
  }



  template void
  ObstacleContact<2>::check_start() const;
  template void
  ObstacleContact<3>::check_start() const;
  template void
  ObstacleContact<2>::check_way(unsigned int, double, double) const;
  template void
  ObstacleContact<3>::check_way(unsigned int, double, double) const;
} // namespace limber
