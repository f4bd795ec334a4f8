// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/adaptation/criteria.h>
#include <limber/adaptation/joining.h>
#include <limber/adaptation/stretched_points.h>
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/problem/side_contact.h>

#include <algorithm>
#include <sstream>

namespace limber
{
  namespace
  {
    // Displacement in the margin, in fine cells, until criteria are evaluated
    // again: the width of the margin less half a cell. The distance of
    // neighbouring points changes by less than that.
    template <int dim>
    double
    way_between(const Problem<dim> &problem)
    {
      return problem.grid.levels > 0 ? 2 * rim_pairs(problem) - 0.5 : 0.5;
    }

    // Criteria that depend on time or fields may change while points rest, and
    // points are stretched by others that move: evaluate at least every so many
    // steps of the finest cells. With coarse cells only, steps are longer.
    constexpr std::uint64_t steps_at_rest = 50;
  } // namespace



  template <int dim>
  Adaptation<dim>::Adaptation(const Problem<dim>  &problem,
                              BackgroundGrid<dim> &grid,
                              Bodies              &bodies)
    : problem(problem)
    , grid(grid)
    , bodies(bodies)
    , longest_way(way_between(problem))
  {
    if (!problem.adapts())
      return;
    set_mesh(grid.divided_cells());
    memory.wanted = memory.mesh;
    for (const auto &body : bodies)
      memory.next_id.push_back(body->points.n_global());
  }



  template <int dim>
  void
  Adaptation<dim>::set_mesh(const RefinedCells<dim> &mesh)
  {
    memory.mesh       = mesh.numbers();
    finest_level      = std::max(finest_level, mesh.finest_level());
    fine_steps_in_one = std::uint64_t(1)
                        << (mesh.levels() - mesh.finest_level());
  }



  template <int dim>
  bool
  Adaptation<dim>::is_due(const double displacement)
  {
    if (!problem.adapts())
      return false;
    if (points_cross_cells())
      memory.way += displacement;
    ++memory.steps;
    if (memory.times_asked == 0 && looks_ahead())
      return true;
    // however rarely one wants to ask: no coarse point shall enter fine cells
    if (points_cross_cells() && memory.way + displacement > longest_way)
      return true;
    if (grid.description.adapt_every > 0)
      return memory.steps >= grid.description.adapt_every;
    return (memory.steps * fine_steps_in_one >= steps_at_rest &&
            (grid.description.may_change_at_rest() ||
             problem.splits_stretched_points()));
  }



  template <int dim>
  bool
  Adaptation<dim>::adapt(const double time, const KeptPoints &kept)
  {
    const double before = wall_time();
    memory.way          = 0;
    memory.steps        = 0;
    ++memory.times_asked;

    removed      = 0;
    bool changed = grid.has_levels() && adapt_mesh(time, kept);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b]->description.splits_stretched_points)
        changed |= divide_points(b, kept[b]);
    if (changed)
      for (auto &body : bodies)
        body->points.hand_over();
    changed |= grid.description.joins_points && join_points(kept);
    seconds_spent += wall_time() - before;
    return changed;
  }



  template <int dim>
  bool
  Adaptation<dim>::adapt_mesh(const double time, const KeptPoints &kept)
  {
    // Hysteresis: a cell is coarsened only if no criterion wanted it in two
    // evaluations in a row; with a wide margin (empty cells only), at once.
    RefinedCells<dim>       mesh    = wanted_mesh(problem, grid, bodies, time);
    const RefinedCells<dim> present = grid.divided_cells();
    RefinedCells<dim>       held    = grid.no_divided_cells();
    held.set(memory.wanted);
    held.keep_common(present);
    memory.wanted = mesh.numbers();
    if (rim_pairs(problem) == 1)
      mesh.join(held);
    mesh.grade(0);

    const bool split   = split_points(mesh, kept, time);
    const bool changed = change_mesh(grid, bodies, mesh);
    if (changed)
      {
        set_mesh(mesh);
        ++memory.mesh_changes;
      }
    return split || changed;
  }



  // Ids are given to the ranks in their order (exclusive prefix sum).
  template <int dim>
  std::uint64_t
  Adaptation<dim>::take_numbers(const std::size_t   body,
                                const unsigned long own,
                                std::uint64_t      &first)
  {
    const unsigned long all =
      dealii::Utilities::MPI::sum(own, grid.communicator);
    unsigned long before = 0;
    const int     ierr   = MPI_Exscan(
      &own, &before, 1, MPI_UNSIGNED_LONG, MPI_SUM, grid.communicator);
    AssertThrowMPI(ierr);
    if (dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0)
      before = 0;
    first = memory.next_id[body] + before;
    memory.next_id[body] += all;
    memory.points_added += all;
    return all;
  }



  // Repeated, as a part may still be too long, or long along another axis.
  template <int dim>
  bool
  Adaptation<dim>::divide_points(const std::size_t                        b,
                                 const std::unordered_set<std::uint64_t> &kept)
  {
    for (bool any = false;; any = true)
      {
        bodies[b]->points.hand_over();
        const auto    long_ones = stretched_points(grid, *bodies[b], kept);
        unsigned long n_new     = 0;
        for (const Division<dim> &division : long_ones)
          n_new += division.parts - 1;
        std::uint64_t first;
        if (take_numbers(b, n_new, first) == 0)
          return any;
        removed -= bodies[b]->points.divide(long_ones, first);
        memory.points_split +=
          dealii::Utilities::MPI::sum(long_ones.size(), grid.communicator);
      }
  }



  // Outward normals at surface points of a body towards obstacles and the sides
  // that meet surfaces; zero if none is within the distance of the surface plus
  // one cell.
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  Adaptation<dim>::normals_to_obstacles(const MaterialBody<dim>        &body,
                                        const std::vector<std::size_t> &which,
                                        const double time) const
  {
    const PointView<dim> view = body.points.view();
    if (view.reach == nullptr)
      return {};
    std::vector<Obstacle<dim>> rigid = problem.obstacles;
    if (body.description.meets_sides)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if (problem.sides[side].meets_surfaces)
          rigid.push_back(half_space_beyond(side, problem));
    if (rigid.empty())
      return {};
    std::vector<ObstaclePlace<dim>> obstacles;
    for (const Obstacle<dim> &obstacle : rigid)
      obstacles.emplace_back(obstacle, time);
    std::vector<dealii::Tensor<1, dim>> normals(which.size());
    for (std::size_t k = 0; k < which.size(); ++k)
      {
        const std::size_t  p = which[k];
        dealii::Point<dim> place;
        for (int d = 0; d < dim; ++d)
          place[d] = view.position[d][p];
        double nearest =
          view.reach[p] + 1 / grid.geometry[view.cell[p]].inverse_edge[0];
        for (const ObstaclePlace<dim> &obstacle : obstacles)
          if (const auto distance = obstacle.distance(place);
              distance.value < nearest)
            {
              nearest    = distance.value;
              normals[k] = -distance.normal;
            }
      }
    return normals;
  }



  template <int dim>
  bool
  Adaptation<dim>::points_cross_cells() const
  {
    return std::any_of(bodies.begin(), bodies.end(), [](const auto &body) {
      return body->description.frame == Frame::current;
    });
  }



  // Moving refinements have a margin instead.
  template <int dim>
  bool
  Adaptation<dim>::looks_ahead() const
  {
    const auto &refinements = grid.description.refinements;
    return grid.has_levels() && points_cross_cells() &&
           std::none_of(refinements.begin(),
                        refinements.end(),
                        [](const auto &one) { return one.is_moving(); });
  }



  // The fastest point may move that far into fine cells until criteria are
  // evaluated again.
  template <int dim>
  double
  Adaptation<dim>::seconds_to_look_ahead() const
  {
    if (!looks_ahead())
      return 0;
    const GridDescription<dim> &box     = grid.description;
    double                      fastest = 0; // in fine cells, 1/s
    for (const auto &body : bodies)
      {
        const PointView<dim> view = body->points.view();
        for (int d = 0; d < dim; ++d)
          for (std::size_t p = 0; p < view.size; ++p)
            fastest =
              std::max(fastest,
                       std::abs(view.velocity[d][p]) / box.finest_edge(d));
      }
    fastest = dealii::Utilities::MPI::max(fastest, grid.communicator);
    return fastest > 0 ? longest_way / fastest : 0;
  }



  template <int dim>
  bool
  Adaptation<dim>::split_points(const RefinedCells<dim> &mesh,
                                const KeptPoints        &kept,
                                const double             time)
  {
    const GridDescription<dim> &box   = grid.description;
    const double                ahead = seconds_to_look_ahead();
    bool                        any   = false;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      {
        MaterialPoints<dim>    &points = bodies[b]->points;
        std::array<double, dim> spacing;
        for (int d = 0; d < dim; ++d)
          spacing[d] =
            box.edge(d) / bodies[b]->description.points_per_cell_edge[d];
        // Points made in one pass may have to be split again in the next.
        for (unsigned int pass = 0; pass < box.levels; ++pass)
          {
            std::array<std::vector<std::size_t>, 2> large; // in 2, in 3
            const PointView<dim>                    view = points.view();
            for (std::size_t p = 0; p < view.size; ++p)
              {
                const unsigned int size       = points.size_class(p);
                const auto         is_to_part = [&](const double way) {
                  std::array<double, dim> x;
                  for (int d = 0; d < dim; ++d)
                    x[d] = view.place[d][p] + way * view.velocity[d][p];
                  return mesh.is_divided(size, grid.place_at(x, size));
                };
                if (is_to_part(0) || (ahead > 0 && (is_to_part(0.5 * ahead) ||
                                                    is_to_part(ahead))))
                  large[kept[b].count(points.id(p))].push_back(p);
              }
            bool any_here = false;
            for (unsigned int k = 0; k < large.size(); ++k)
              {
                const unsigned int parts = 2 + k;
                const unsigned int n_new =
                  dealii::Utilities::fixed_power<dim>(parts) - 1; // of each
                std::uint64_t       first;
                const std::uint64_t all =
                  take_numbers(b, large[k].size() * n_new, first);
                if (all == 0)
                  continue;
                points.split(large[k],
                             parts,
                             spacing,
                             first,
                             normals_to_obstacles(*bodies[b], large[k], time));
                memory.points_split += all / n_new;
                any_here = any = true;
              }
            if (!any_here)
              break;
            points.hand_over(); // parts of domains may lie in the next cell
          }
      }
    return any;
  }



  template <int dim>
  bool
  Adaptation<dim>::join_points(const KeptPoints &kept)
  {
    if (!any_finer_than_cells(grid, bodies))
      return false;
    for (auto &body : bodies)
      body->points.hand_over();
    const Occupancy<dim> occupancy(grid, bodies);
    unsigned long        gone = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      {
        const auto sets = sets_to_join(grid, occupancy, *bodies[b], kept[b]);
        for (const auto &set : sets)
          gone += set.size() - 1;
        removed += join(sets, *bodies[b]);
      }
    memory.points_joined +=
      dealii::Utilities::MPI::sum(gone, grid.communicator);
    return true;
  }



  template <int dim>
  void
  Adaptation<dim>::restore(const AdaptationState &former)
  {
    if (!problem.adapts())
      return;
    memory = former;
    if (!grid.has_levels())
      return;
    RefinedCells<dim> mesh = grid.no_divided_cells();
    mesh.set(former.mesh);
    set_mesh(mesh);
    for (auto &body : bodies)
      body->points.clear();
    change_mesh(grid, bodies, mesh);
  }



  template <int dim>
  std::string
  Adaptation<dim>::report() const
  {
    const unsigned int  n = grid.description.levels + 1;
    std::vector<double> cells(n, 0.), points(n, 0.);
    for (std::uint32_t c = 0; c < grid.n_owned_cells(); ++c)
      ++cells[grid.level_of(c)];
    for (const auto &body : bodies)
      {
        const PointView<dim> view = body->points.view();
        for (std::size_t p = 0; p < view.size; ++p)
          if (view.cell[p] != invalid_cell)
            ++points[grid.level_of(view.cell[p])];
      }
    dealii::Utilities::MPI::sum(cells, grid.communicator, cells);
    dealii::Utilities::MPI::sum(points, grid.communicator, points);
    std::ostringstream text;
    for (unsigned int level = 0; level < n; ++level)
      text << "  level " << level << ": " << brief(cells[level]) << " cells of "
           << brief(grid.description.edge(0) / (1u << level)) << " m, "
           << brief(points[level]) << " points\n";
    if (finest_level < grid.description.levels)
      text << "  levels above " << finest_level
           << ": never used, no 'Grid/Refine' has asked for them\n";
    return text.str();
  }



  template class Adaptation<2>;
  template class Adaptation<3>;
} // namespace limber
