// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/cell_values.h>
#include <limber/adaptation/criteria.h>
#include <limber/adaptation/occupancy.h>
#include <limber/base/exceptions.h>
#include <limber/base/floating_point_traps.h>
#include <limber/base/text.h>
#include <limber/problem/read_parts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace limber
{
  namespace
  {
    /**
     * Whether a formula is positive at any sample of a part of a cell, with @p
     * per_edge samples along each edge.
     */
    template <int dim>
    bool
    reaches_into(const Refinement<dim> &refinement,
                 const Corners<dim>    &part,
                 const double           time,
                 const unsigned int     per_edge)
    {
      const HeldFloatingPointTraps held;
      const unsigned int           n =
        dim == 2 ? per_edge * per_edge : per_edge * per_edge * per_edge;
      for (unsigned int i = 0; i < n; ++i)
        {
          dealii::Point<dim> place;
          unsigned int       rest = i;
          for (int d = 0; d < dim; ++d, rest /= per_edge)
            place[d] = part.first[d] + (part.second[d] - part.first[d]) *
                                         (rest % per_edge) / (per_edge - 1);
          const double value = refinement.where.value(place, time);
          if (!std::isfinite(value))
            throw InputError(
              "The formula " + in_quotes(refinement.where.expression()) +
              " in 'Grid/Refine " + refinement.name +
              "/Where' is not finite at " + to_text(place) + ", time " +
              brief(time) +
              ". Usually something is divided by zero. Guard it, as in 'if(x "
              "> 0, 1/x, 0)'.");
          if (value > 0)
            return true;
        }
      return false;
    }



    /**
     * Whether a cell overlaps a refinement. The finest cells are only asked
     * whether they remain, with three samples per edge: together with their
     * siblings these are the five per edge of their parent.
     */
    template <int dim>
    bool
    is_in(const Refinement<dim>                    &refinement,
          const typename BackgroundGrid<dim>::Cell &cell,
          const double                              time,
          const bool                                is_finest)
    {
      const dealii::Point<dim> lower = cell->vertex(0),
                               upper = cell->vertex((1 << dim) - 1);
      Corners<dim> part(lower, upper);
      for (int d = 0; d < dim; ++d)
        {
          // A box that ends where the cell begins does not overlap it.
          const double tolerance = 1e-6 * (upper[d] - lower[d]);
          part.first[d]          = std::max(lower[d], refinement.box.first[d]);
          part.second[d]         = std::min(upper[d], refinement.box.second[d]);
          if (part.second[d] - part.first[d] < tolerance)
            return false;
        }
      return refinement.where.empty() ||
             reaches_into(refinement, part, time, is_finest ? 3 : 5);
    }
  } // namespace



  namespace
  {
    /** Evaluates the refinement criteria of the scene, cell by cell. */
    template <int dim>
    class Criteria
    {
    public:
      using Cell   = typename BackgroundGrid<dim>::Cell;
      using Place  = typename RefinedCells<dim>::Place;
      using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

      Criteria(const Problem<dim>        &problem,
               const BackgroundGrid<dim> &grid,
               const Bodies              &bodies,
               const double               time)
        : problem(problem)
        , grid(grid)
        , time(time)
        , occupancy(grid, bodies)
      {
        for (const Obstacle<dim> &obstacle : problem.obstacles)
          obstacles.emplace_back(obstacle, time);
        if (std::any_of(grid.description.refinements.begin(),
                        grid.description.refinements.end(),
                        [](const auto &refinement) {
                          return refinement.criterion ==
                                 RefinementCriterion::contact;
                        }))
          find_fields(bodies);
        double most = 1;
        for (const auto &body : bodies)
          {
            double n = 1;
            for (const unsigned int per_edge :
                 body->description.points_per_cell_edge)
              n *= 2 * per_edge;
            most = std::max(most, n);
          }
        most_points = static_cast<std::uint64_t>(most);
        for (const Refinement<dim> &refinement : grid.description.refinements)
          {
            of_bodies.push_back(
              refinement.criterion == RefinementCriterion::body ?
                std::make_unique<Occupancy<dim>>(grid,
                                                 bodies,
                                                 refinement.bodies) :
                nullptr);
            values.push_back(has_scale(refinement.criterion) ?
                               cell_values(refinement, grid, bodies) :
                               std::vector<double>());
          }
      }

      /** The level wanted in a cell, at most one above its own. */
      unsigned int
      wanted_level(const Cell &cell) const
      {
        const unsigned int own    = grid.level_of(cell);
        unsigned int       result = 0;
        for (std::size_t r = 0; r < of_bodies.size(); ++r)
          {
            const Refinement<dim> &refinement = grid.description.refinements[r];
            if (refinement.level <= result ||
                !is_in<dim>(
                  refinement, cell, time, own == grid.description.levels))
              continue;
            unsigned int level = 0;
            switch (refinement.criterion)
              {
                case RefinementCriterion::region:
                  level = refinement.level;
                  break;
                case RefinementCriterion::body:
                  level =
                    of_bodies[r]->points_in(own, grid.place_of(cell)) > 0 ?
                      refinement.level :
                      0;
                  break;
                case RefinementCriterion::surface:
                  if (occupancy.points_in(own, grid.place_of(cell)) > 0)
                    level = level_of_wish(
                      refinement,
                      cell,
                      [&](const auto at, const Place &place, const int far) {
                        return occupancy.is_near_empty(at, place, far);
                      });
                  break;
                case RefinementCriterion::contact:
                  level = level_of_wish(
                    refinement,
                    cell,
                    [&](const auto at, const Place &place, const int far) {
                      return is_near_another(at, place, far);
                    });
                  break;
                case RefinementCriterion::obstacle:
                  level = level_by_obstacle(refinement, cell);
                  break;
                case RefinementCriterion::stress:
                case RefinementCriterion::rate:
                case RefinementCriterion::plastic_strain:
                  level =
                    std::min(refinement.level,
                             level_by_value(values[r][grid.cell_number(cell)] /
                                              refinement.scale,
                                            own));
                  break;
              }
            result = std::max(result, level);
          }
        return std::min(result, own + 1);
      }

      // The level necessary for no more than 4^dim points per cell, or as many
      // as 'Points per cell edge' gives on one level finer.
      unsigned int
      level_by_points(const Cell &cell) const
      {
        const unsigned int own   = grid.level_of(cell);
        const Place        place = grid.place_of(cell);
        for (unsigned int level = own; level-- > 0;)
          {
            Place ancestor = place;
            for (auto &step : ancestor)
              step >>= own - level;
            if (occupancy.points_in(level, ancestor) > most_points)
              return level + 1;
          }
        return 0;
      }

    private:
      // Bodies in the same nodal field count as one.
      void
      find_fields(const Bodies &bodies)
      {
        std::map<unsigned int, std::vector<std::string>> names;
        for (const auto &body : bodies)
          names[body->description.nodal_field].push_back(
            body->description.name);
        for (const auto &[field, of_field] : names)
          fields.push_back(
            std::make_unique<Occupancy<dim>>(grid, bodies, of_field));
      }

      bool
      is_near_another(const unsigned int level,
                      const Place       &place,
                      const int          distance) const
      {
        for (const auto &one : fields)
          if (one->points_in(level, place) > 0)
            for (const auto &other : fields)
              if (other != one && other->is_near_filled(level, place, distance))
                return true;
        return false;
      }

      // The level up to which is_near(level, place, distance) holds for the
      // cell and all its ancestors. For ancestors the distance is one cell
      // larger, so that divided cells stay divided (hysteresis).
      template <class IsNear>
      unsigned int
      level_of_wish(const Refinement<dim> &refinement,
                    const Cell            &cell,
                    const IsNear          &is_near) const
      {
        const unsigned int own   = grid.level_of(cell);
        const Place        place = grid.place_of(cell);
        unsigned int       level = 0;
        for (; level < refinement.level && level <= own; ++level)
          {
            Place ancestor = place;
            for (auto &step : ancestor)
              step >>= own - level;
            if (!is_near(level,
                         ancestor,
                         refinement.distance + (level < own ? 1 : 0)))
              break;
          }
        return level;
      }

      // Signed distance at the centre, less half the diagonal: a lower bound
      // for all parts of the cell. Cells entirely inside an obstacle are empty
      // and not refined.
      unsigned int
      level_by_obstacle(const Refinement<dim> &refinement,
                        const Cell            &cell) const
      {
        unsigned int level = 0;
        for (std::size_t o = 0; o < obstacles.size(); ++o)
          if (refinement.looks_at(problem.obstacles[o].name))
            level = std::max(
              level,
              level_of_wish(
                refinement, cell, [&](const auto at, const Place &place, int) {
                  dealii::Point<dim> middle;
                  double             square = 0, longest = 0;
                  for (int d = 0; d < dim; ++d)
                    {
                      const double edge = grid.description.edge(d) / (1u << at);
                      middle[d] =
                        grid.description.lower[d] + (place[d] + 0.5) * edge;
                      square += 0.25 * edge * edge;
                      longest = std::max(longest, edge);
                    }
                  const double distance = obstacles[o].distance(middle).value,
                               half     = std::sqrt(square);
                  return distance <= half + refinement.distance * longest &&
                         distance >= -half;
                }));
        return level;
      }

      // Hysteresis: jumps of stress and rate are half as large on half the
      // size, so a cell that has just been refined is not coarsened at once, or
      // vice versa.
      static unsigned int
      level_by_value(const double share, const unsigned int own)
      {
        constexpr double share_to_join = 0.25;
        return share > 1             ? own + 1 :
               share > share_to_join ? own :
               own > 0 && share > 0  ? own - 1 :
                                       0;
      }

      const Problem<dim>             &problem;
      const BackgroundGrid<dim>      &grid;
      const double                    time;
      const Occupancy<dim>            occupancy; // by all bodies
      std::vector<ObstaclePlace<dim>> obstacles;
      // By nodal field, for the criterion 'contact'
      std::vector<std::unique_ptr<Occupancy<dim>>> fields;
      // By refinement, for the criterion 'body'
      std::vector<std::unique_ptr<Occupancy<dim>>> of_bodies;
      // By refinement and cell, for criteria with a scale
      std::vector<std::vector<double>> values;
      std::uint64_t                    most_points = 0;
    };
  } // namespace



  template <int dim>
  unsigned int
  rim_pairs(const Problem<dim> &problem)
  {
    const GridDescription<dim> &grid = problem.grid;
    std::set<std::string>       fine;
    for (const Refinement<dim> &refinement : grid.refinements)
      {
        if (refinement.criterion != RefinementCriterion::body ||
            refinement.level != grid.levels || !refinement.where.empty() ||
            refinement.box != corners(grid))
          return 1;
        fine.insert(refinement.bodies.begin(), refinement.bodies.end());
      }
    for (const Body<dim> &body : problem.bodies)
      if (fine.count(body.name) == 0)
        return 1;
    return dim == 2 ? 6 : 3;
  }



  template <int dim>
  RefinedCells<dim>
  wanted_mesh(const Problem<dim>                                    &problem,
              const BackgroundGrid<dim>                             &grid,
              const std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
              const double                                           time)
  {
    const Criteria<dim> criteria(problem, grid, bodies, time);
    RefinedCells<dim>   result = grid.no_divided_cells(), for_points = result;
    const auto          wish = [&](const auto        &cell,
                          const unsigned int wanted,
                          RefinedCells<dim> &mesh) {
      if (wanted == 0)
        return;
      auto place = grid.place_of(cell);
      for (auto &step : place)
        step >>= grid.level_of(cell) + 1 - wanted;
      mesh.divide(wanted - 1, place);
    };
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          wish(cell, criteria.wanted_level(cell), result);
          wish(cell, criteria.level_by_points(cell), for_points);
        }
    result.sum_over_ranks(grid.communicator);
    for_points.sum_over_ranks(grid.communicator);
    const auto &refinements = grid.description.refinements;
    const bool  moving      = std::any_of(refinements.begin(),
                                    refinements.end(),
                                    [](const auto &refinement) {
                                      return refinement.is_moving();
                                    });
    result.grade(moving ? rim_pairs(problem) : 0);
    // No margin around these: points in it would be split in turn, and so on.
    result.join(for_points);
    result.grade(0);
    return result;
  }



  template unsigned int
  rim_pairs(const Problem<2> &);
  template unsigned int
  rim_pairs(const Problem<3> &);
  template RefinedCells<2>
  wanted_mesh(const Problem<2> &,
              const BackgroundGrid<2> &,
              const std::vector<std::unique_ptr<MaterialBody<2>>> &,
              double);
  template RefinedCells<3>
  wanted_mesh(const Problem<3> &,
              const BackgroundGrid<3> &,
              const std::vector<std::unique_ptr<MaterialBody<3>>> &,
              double);
} // namespace limber
