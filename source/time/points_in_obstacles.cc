// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/contact_geometry.h>
#include <limber/time/obstacle_contact.h>

#include <algorithm>
#include <cmath>

/** @file Points of liquids that have penetrated an obstacle are put back. */
namespace limber
{
  namespace
  {
    // Most turns of alternating projections, out of each obstacle and into the
    // box, of a point that is in a corner between them.
    constexpr unsigned int most_turns = 8;

    // Where points are put: so far outside the surface or inside a side, in
    // cells
    constexpr double beyond_surface = 1e-6;
  } // namespace



  template <int dim>
  double
  ObstacleContact<dim>::put_out(const double time, const double step)
  {
    std::vector<Way> ways;
    for (const Obstacle<dim> &obstacle : parts.problem.obstacles)
      ways.emplace_back(obstacle, time, step);
    unsigned long             n       = 0;
    double                    longest = 0;
    std::vector<unsigned int> near; // obstacles
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        if (!body->description.is_liquid || points.in_initial_frame())
          continue;
        for_each_batch(points, [&](const CellBatch &batch) {
          if (batch.cell == invalid_cell)
            return;
          double                   reach;
          const dealii::Point<dim> middle = middle_of(points, batch, reach);
          near.clear();
          for (unsigned int o = 0; o < ways.size(); ++o)
            if (!is_beyond(2 * reach, o, ways[o].after, middle, batch.cell))
              near.push_back(o);
          for (std::size_t p = batch.begin; p < batch.end && !near.empty(); ++p)
            if (const double way = put_out(points, p, ways, near); way > 0)
              {
                ++n;
                longest = std::max(longest, way);
              }
        });
      }
    parts.ledger.put_out += n;
    return longest / parts.grid.smallest_edge;
  }



  // Projection onto the surface along the distance's gradient; where that
  // leaves the box or enters another obstacle, back from there in turn.
  template <int dim>
  bool
  ObstacleContact<dim>::find_outside(const std::vector<Way>          &ways,
                                     const std::vector<unsigned int> &near,
                                     dealii::Point<dim>              &x,
                                     std::vector<Wall>               &met) const
  {
    met.clear();
    const GridDescription<dim> &box = parts.problem.grid;
    const double beyond             = beyond_surface * parts.grid.smallest_edge;
    for (unsigned int turn = 0; turn < most_turns; ++turn)
      {
        bool is_outside = true;
        for (const unsigned int o : near)
          {
            const SignedDistance<dim> distance = ways[o].after.distance(x);
            if (distance.value >= 0)
              continue;
            is_outside = false;
            x += (beyond - distance.value) * distance.normal;
            const auto same = [&](const Wall &wall) {
              return wall.obstacle == o;
            };
            const auto wall = std::find_if(met.begin(), met.end(), same);
            if (wall == met.end())
              met.push_back({o, distance.normal});
            else
              wall->normal = distance.normal;
          }
        if (is_outside)
          return true;
        for (int d = 0; d < dim; ++d)
          x[d] = std::min(std::max(x[d], box.lower[d] + beyond),
                          box.upper[d] - beyond);
      }
    return false;
  }



  // Inelastic impact of a point on the surface: it loses its normal velocity
  // into the obstacle.
  template <int dim>
  double
  ObstacleContact<dim>::put_out(const PointView<dim>            &points,
                                const std::size_t                p,
                                const std::vector<Way>          &ways,
                                const std::vector<unsigned int> &near)
  {
    dealii::Point<dim> start;
    for (int d = 0; d < dim; ++d)
      start[d] = points.position[d][p];
    if (std::none_of(near.begin(), near.end(), [&](const unsigned int o) {
          return ways[o].after.distance(start).value < 0;
        }))
      return 0;
    dealii::Point<dim> x = start;
    if (!find_outside(ways, near, x, walls))
      return 0;
    std::array<double, dim> place;
    for (int d = 0; d < dim; ++d)
      place[d] = x[d];
    const GridView<dim> grid = parts.nodes.view();
    const std::uint32_t cell = grid.bins.cell_at(place);
    if (cell == invalid_cell)
      return 0;

    const double mass = points.mass[p];
    Vector       velocity, change;
    for (int d = 0; d < dim; ++d)
      velocity[d] = points.velocity[d][p];
    double given = 0; // by obstacles that move, J
    for (const Wall &wall : walls)
      {
        Vector of_wall;
        if (parts.problem.obstacles[wall.obstacle].moves())
          of_wall = ways[wall.obstacle].velocity(x);
        const double inward =
          (of_wall - velocity - change) * wall.normal; // m/s
        if (!(inward > 0))
          continue;
        change += inward * wall.normal;
        const Vector         impulse = mass * inward * wall.normal;
        ObstacleAction<dim> &action  = parts.ledger.obstacles[wall.obstacle];
        action.impulse += impulse;
        action.moment +=
          moment_of<dim>(x - ways[wall.obstacle].after.centre(), impulse);
        given += impulse * of_wall;
      }
    parts.ledger.boundary_work += given;
    parts.ledger.contact += given - mass * (velocity + 0.5 * change) * change +
                            mass * parts.problem.loads.gravity * (x - start);
    for (int d = 0; d < dim; ++d)
      {
        points.velocity[d][p] += change[d];
        points.position[d][p] = x[d];
      }
    points.cell[p] = cell;
    if (cell >= grid.n_owned_cells)
      *grid.is_in_ghosts = true;
    if (!grid.occupied[cell])
      {
        grid.occupied[cell] = 1;
        grid.entered->push_back(cell);
      }
    return x.distance(start);
  }



  template double
  ObstacleContact<2>::put_out(double, double);
  template double
  ObstacleContact<3>::put_out(double, double);
} // namespace limber
