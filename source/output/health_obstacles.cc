// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/health_figures.h>
#include <limber/points/cell_batch.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Share of the edge of a cell up to which a point counts as on the surface.
    constexpr double in_surface = 1e-3;



    /**
     * Penetration of the points of a batch into an obstacle. Cells at more than
     * twice their diagonal from it are skipped without a look at their points;
     * twice, as the distance of a formula is right to first order only.
     */
    template <int dim>
    void
    look_at_batch(const State<dim>         &state,
                  const ObstaclePlace<dim> &place,
                  const PointView<dim>     &points,
                  const CellBatch          &batch,
                  double                   &deepest,
                  unsigned long            &n)
    {
      if (batch.cell == invalid_cell)
        return;
      const CellGeometry<dim> &cell = state.grid.geometry[batch.cell];
      dealii::Point<dim>       middle;
      double                   square = 0;
      for (int d = 0; d < dim; ++d)
        {
          const double half = 0.5 / cell.inverse_edge[d];
          middle[d]         = cell.origin[d] + half;
          square += half * half;
        }
      if (place.distance(middle).value > 2 * std::sqrt(square))
        return;
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          dealii::Point<dim> x;
          for (int d = 0; d < dim; ++d)
            x[d] = points.position[d][p];
          const double depth =
            -place.distance(x).value * cell.inverse_edge[0]; // in cells
          if (depth > in_surface)
            ++n;
          deepest = std::max(deepest, depth);
        }
    }
  } // namespace



  template <int dim>
  std::vector<ObstacleFigures>
  look_at_obstacles(const State<dim> &state)
  {
    std::vector<ObstacleFigures> result;
    for (const Obstacle<dim> &obstacle : state.problem.obstacles)
      {
        const ObstaclePlace<dim> place(obstacle, state.time);
        double                   deepest = 0;
        unsigned long            n       = 0;
        for (const auto &body : state.bodies)
          {
            const PointView<dim> points = body->points.view();
            for_each_batch(points, [&](const CellBatch &batch) {
              look_at_batch(state, place, points, batch, deepest, n);
            });
          }
        ObstacleFigures figures;
        figures.name = obstacle.name;
        figures.depth =
          dealii::Utilities::MPI::max(deepest, state.grid.communicator);
        figures.points_inside =
          dealii::Utilities::MPI::sum(n, state.grid.communicator);
        result.push_back(figures);
      }
    return result;
  }



  template std::vector<ObstacleFigures>
  look_at_obstacles(const State<2> &);
  template std::vector<ObstacleFigures>
  look_at_obstacles(const State<3> &);
} // namespace limber
