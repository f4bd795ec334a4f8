// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/array_view.h>

#include <limber/grid/node_vector.h>
#include <limber/interpolation/point_support.h>
#include <limber/problem/side_contact.h>
#include <limber/state/stretch.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/obstacle_contact.h>
#include <limber/transfer/meeting_bodies.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace limber
{
  namespace
  {
    // Jacobi iterations with cut cells: with four, water at rest starts with
    // .03 g, with these .002 g.
    constexpr unsigned int passes_of_surfaces = 16;

    // With friction and splines, accelerated. A spline sees several rows of
    // points, and short waves of the impulses along the surface decay slowly:
    // what four passes leave of them lets points slide that should stick, and
    // does work on the body.
    constexpr unsigned int passes_with_friction = 16;



    /** Distance of a place in the box from a side, m. */
    template <int dim>
    double
    distance_from_side(const GridDescription<dim> &box,
                       const unsigned int          side,
                       const dealii::Point<dim>   &place)
    {
      const unsigned int d = side / 2;
      return side % 2 == 0 ? place[d] - box.lower[d] : box.upper[d] - place[d];
    }



    // n . grad N = d . grad_X N with d = F^-1 n in the initial frame.
    template <int dim>
    dealii::Tensor<1, dim>
    against_gradients(const PointView<dim>         &points,
                      const std::size_t             p,
                      const dealii::Tensor<1, dim> &normal)
    {
      if (!points.in_initial_frame())
        return normal;
      dealii::Tensor<2, dim> F;
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          F[d][k] = points.deformation[d * dim + k][p];
      return invert(F) * normal;
    }
  } // namespace



  template <int dim>
  ObstacleContact<dim>::ObstacleContact(const RunParts<dim>     &parts,
                                        CutCells<dim> *const     cut_cells,
                                        const bool               leapfrogs,
                                        const CoveredSides<dim> *covered)
    : parts(parts)
    , cut_cells(cut_cells)
    , rigid(parts.problem.obstacles)
    , sides(parts.problem.sides, covered)
    , other_sides(sides_at_nodes<dim>(parts.problem.sides))
    , of_other_sides(other_sides, covered)
    , impulses(parts.nodes, leapfrogs)
    , sums(parts.problem.obstacles.size() * parts.nodes.n_fields())
  {
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (parts.problem.sides[side].meets_surfaces)
        {
          rigid.push_back(half_space_beyond(side, parts.problem));
          sides_that_meet.push_back(side);
        }
    cell_distance.resize(n_obstacles());
    parts.ledger.obstacles.resize(n_obstacles());
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points  = body->points.view();
        double               largest = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          largest = std::max(largest, points.mass[p]);
        edge.push_back(
          2 * half_edge_of<dim>(
                dealii::Utilities::MPI::max(largest, parts.grid.communicator) /
                body->stress->density()));
      }
    liquid_density.assign(parts.nodes.n_fields(), 0);
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid)
        {
          double &density = liquid_density[body->description.nodal_field];
          density         = std::max(density, body->stress->density());
        }
    check_start();
    reinit();
  }



  template <int dim>
  void
  ObstacleContact<dim>::reinit()
  {
    impulses.reinit();
    touches.clear();
    for (auto &distances : cell_distance)
      distances.reinit(std::size_t(parts.grid.n_cells()) * (1 + dim));
    room.assign(parts.bodies.size(), 0.);
    const bool any_liquid =
      std::any_of(parts.bodies.begin(), parts.bodies.end(), [](auto &body) {
        return body->description.is_liquid;
      });
    for (const auto &body : parts.bodies)
      if (body->description.is_liquid)
        for (unsigned int o = 0; o < n_obstacles(); ++o)
          sums[o * parts.nodes.n_fields() + body->description.nodal_field]
            .records.reinit(std::size_t(parts.nodes.table.n()) * Sums::stride);
    if (any_liquid && !parts.grid.has_own_nodes())
      {
        vertices.resize(parts.nodes.table.n());
        known_nodes.resize(rigid.size());
        for (auto &of_obstacle : known_nodes)
          of_obstacle.reinit(parts.nodes.table.n());
        for (const CellGeometry<dim> &cell : parts.grid.geometry)
          for (unsigned int a = 0; a < 1u << dim; ++a)
            for (unsigned int d = 0; d < dim; ++d)
              vertices[cell.node[a] / Layout::stride][d] =
                cell.origin[d] + (a >> d & 1) / cell.inverse_edge[d];
      }
  }



  // A body that is far from all sides is not searched until it may have come
  // near; on no rank, as points change ranks.
  template <int dim>
  void
  ObstacleContact<dim>::find_points_at_sides(const std::vector<Way> &ways,
                                             const double            step)
  {
    bool any_looks = false; // the same on all ranks
    for (unsigned int b = 0; b < parts.bodies.size(); ++b)
      {
        if (room[b] > 0)
          continue;
        room[b]   = find_points(b, ways, step);
        any_looks = true;
      }
    if (any_looks)
      dealii::Utilities::MPI::min(dealii::make_array_view(std::as_const(room)),
                                  parts.grid.communicator,
                                  dealii::make_array_view(room));
  }



  template <int dim>
  void
  ObstacleContact<dim>::find(const double time, const double step)
  {
    impulses.clear();
    touches.clear();
    surface_places.clear();
    nodes_held.clear();
    std::vector<Way> ways;
    for (unsigned int o = 0; o < rigid.size(); ++o)
      {
        check_way(o, time, step);
        ways.emplace_back(rigid[o], time, step);
      }
    clear_sums();
    if (n_obstacles() == 0)
      find_points_at_sides(ways, step);
    else
      for (unsigned int b = 0; b < parts.bodies.size(); ++b)
        find_points(b, ways, step);
    add_nodes(ways);
    if (!sides_that_meet.empty())
      for (unsigned int field = 0; field < parts.nodes.n_fields(); ++field)
        if (parts.problem.meets_sides(field))
          impulses.add_side_constraints(field,
                                        of_other_sides.at(parts.nodes,
                                                          time + step));
    if (cut_cells)
      {
        add_cut_cells(ways, step);
        for (unsigned int field = 0; field < parts.nodes.n_fields(); ++field)
          if (cut_cells->knows(field))
            impulses.add_side_constraints(field,
                                          sides.at(parts.nodes, time + step));
      }
    if (cut_cells && cut_cells->any())
      return impulses.finish_adding({}, passes_of_surfaces);
    const bool may_stick =
      is_spline(parts.problem.grid.kernel) &&
      std::any_of(rigid.begin(), rigid.end(), [](const auto &obstacle) {
        return obstacle.friction > 0 && std::isfinite(obstacle.friction);
      });
    if (may_stick)
      impulses.finish_adding({}, passes_with_friction, /*hurry=*/true);
    else
      impulses.finish_adding();
  }



  // Twice, as what bounds the way is the speed at one end of a step.
  template <int dim>
  void
  ObstacleContact<dim>::approach(const double way)
  {
    for (double &of_body : room)
      of_body -= 2 * way;
  }



  // Centre of the material in a cell, and how far any of it is from there, m.
  // In the initial frame it has left the cell.
  template <int dim>
  dealii::Point<dim>
  ObstacleContact<dim>::middle_of(const PointView<dim> &points,
                                  const CellBatch      &batch,
                                  double               &reach) const
  {
    dealii::Point<dim> middle;
    reach = 0;
    if (points.in_initial_frame())
      {
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          for (int d = 0; d < dim; ++d)
            middle[d] += points.position[d][p];
        middle /= batch.end - batch.begin;
        for (std::size_t p = batch.begin; p < batch.end; ++p)
          {
            double square = 0;
            for (int d = 0; d < dim; ++d)
              square += (points.position[d][p] - middle[d]) *
                        (points.position[d][p] - middle[d]);
            reach = std::max(reach, square);
          }
      }
    else
      {
        const CellGeometry<dim> &cell = parts.nodes.view().cells[batch.cell];
        for (int d = 0; d < dim; ++d)
          {
            const double half = 0.5 / cell.inverse_edge[d];
            middle[d]         = cell.origin[d] + half;
            reach += half * half;
          }
      }
    reach = std::sqrt(reach);
    return middle;
  }



  // Whether the material of a cell is farther than @p reach from an obstacle,
  // by a cached distance of its centre: where this has moved in the frame of
  // the obstacle since, the distance is less by no more than that, or by twice
  // as much if it is of first order. At rest each cell is evaluated once.
  template <int dim>
  bool
  ObstacleContact<dim>::is_beyond(const double              reach,
                                  const unsigned int        obstacle,
                                  const ObstaclePlace<dim> &place,
                                  const dealii::Point<dim> &middle,
                                  const std::uint32_t       cell)
  {
    const dealii::Point<dim> start = place.start_of(middle);
    double *const            asked =
      &cell_distance[obstacle][std::size_t(cell) * (1 + dim)];
    double way = 0; // squared
    for (int d = 0; d < dim; ++d)
      way += (start[d] - asked[1 + d]) * (start[d] - asked[1 + d]);
    if (asked[0] == 0 || (way > 0 && asked[0] - 2 * std::sqrt(way) <= reach))
      {
        asked[0] = place.distance(middle).value;
        if (asked[0] == 0)
          asked[0] = 1e-300; // zero means: not evaluated
        for (int d = 0; d < dim; ++d)
          asked[1 + d] = start[d];
        way = 0;
      }
    return asked[0] - 2 * std::sqrt(way) > reach;
  }



  // Finds the contacts of a body's points; returns how far the others are from
  // touching a side at least, m. Points are tested only in cells whose distance
  // is within the extent of their material and a point; twice that for
  // obstacles, as the distance of a formula is of first order.
  template <int dim>
  double
  ObstacleContact<dim>::find_points(const unsigned int      body,
                                    const std::vector<Way> &ways,
                                    const double            step)
  {
    const PointView<dim> points    = parts.bodies[body]->points.view();
    const bool           is_liquid = parts.bodies[body]->description.is_liquid;
    const double inverse_density   = 1 / parts.bodies[body]->stress->density();
    const unsigned int n_met =
      parts.problem.meets_sides(parts.bodies[body]->description.nodal_field) ?
        rigid.size() :
        n_obstacles();
    double nearest = std::numeric_limits<double>::max(); // to a side
    std::vector<unsigned int> asked;                     // obstacles
    for_each_batch(points, [&](const CellBatch &batch) {
      double                   reach;
      const dealii::Point<dim> middle = middle_of(points, batch, reach);
      asked.clear();
      for (unsigned int o = 0; o < n_obstacles(); ++o)
        if (!is_beyond(
              2 * (reach + edge[body]), o, ways[o].before, middle, batch.cell))
          asked.push_back(o);
      for (unsigned int o = n_obstacles(); o < n_met; ++o)
        {
          const double between =
            distance_from_side(parts.problem.grid,
                               sides_that_meet[o - n_obstacles()],
                               middle) -
            (reach + 2 * edge[body]);
          nearest = std::min(nearest, between);
          if (between <= 0)
            asked.push_back(o);
        }
      if (asked.empty())
        return;

      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          dealii::Point<dim> x;
          for (int d = 0; d < dim; ++d)
            x[d] = points.position[d][p];
          for (const unsigned int o : asked)
            {
              const SignedDistance<dim> distance = ways[o].before.distance(x);
              if (distance.value > 2 * edge[body])
                continue;
              if (is_liquid)
                add_to_nodes(body,
                             {p,
                              o,
                              x,
                              distance,
                              half_edge_of<dim>(points.mass[p] *
                                                inverse_density)});
              else
                add_surface(body,
                            {p,
                             o,
                             x,
                             distance,
                             reach_of(points,
                                      p,
                                      half_edge_of<dim>(points.mass[p] *
                                                        inverse_density)) *
                               stretch_along(*parts.bodies[body],
                                             points,
                                             p,
                                             distance.normal)},
                            ways[o],
                            step);
            }
        }
    });
    return nearest;
  }



  template <int dim>
  void
  ObstacleContact<dim>::add_surface(const unsigned int body,
                                    const Near        &near,
                                    const Way         &way,
                                    const double       step)
  {
    const PointView<dim> points   = parts.bodies[body]->points.view();
    const Obstacle<dim> &obstacle = rigid[near.obstacle];
    const Vector        &normal   = near.distance.normal;
    Vector               against, velocity;
    if (obstacle.moves())
      against = way.velocity(near.x);
    for (int d = 0; d < dim; ++d)
      velocity[d] = points.velocity[d][near.point];
    double       gap      = near.distance.value - near.reach;
    const double approach = std::max(0., (against - velocity) * normal);
    if (!may_press(gap, step * approach, near.reach))
      return;
    double reach = near.reach;
    if (parts.bodies[body]->description.is_plastic)
      reach *= share_left(gap, reach);

    Place &place           = impulses.add_place();
    place.normal           = normal;
    place.velocity         = against;
    place.least            = least_growth(gap, near.reach) / step;
    place.friction         = obstacle.friction;
    place.mass             = points.mass[near.point];
    const Vector direction = against_gradients(points, near.point, normal);
    const auto   support =
      support_of_point<dim>(parts.nodes.view(), points, near.point);
    for (int k = 0; k < support.n; ++k)
      {
        double slope = 0; // along the normal, 1/m
        for (int d = 0; d < dim; ++d)
          slope += direction[d] * support.gradient[k][d];
        impulses.add_share(parts.bodies[body]->description.nodal_field,
                           support.node[k],
                           support.value[k] - reach * slope);
      }
    touches.push_back(
      {near.obstacle, near.x - reach * normal - way.before.centre()});
  }



  template <int dim>
  void
  ObstacleContact<dim>::clear_sums()
  {
    for (Sums &some : sums)
      if (some.records.size() > 0)
        for (const std::uint32_t node : parts.nodes.active_nodes())
          std::fill_n(some.records.data() + std::size_t(node) * Sums::stride,
                      Sums::stride,
                      0.);
  }



  template <int dim>
  void
  ObstacleContact<dim>::add_to_nodes(const unsigned int body, const Near &near)
  {
    if (near.distance.value > near.reach)
      return;
    Sums                &some   = sums[near.obstacle * parts.nodes.n_fields() +
                      parts.bodies[body]->description.nodal_field];
    const PointView<dim> points = parts.bodies[body]->points.view();
    const double         mass   = points.mass[near.point];
    const auto           support =
      support_of_point<dim, false>(parts.nodes.view(), points, near.point);
    for (int k = 0; k < support.n; ++k)
      impulses.for_each_master(
        support.node[k], [&](const std::uint32_t node, const double share) {
          const double  weight = mass * share * support.value[k];
          double *const record =
            some.records.data() + std::size_t(node) * Sums::stride;
          for (int d = 0; d < dim; ++d)
            {
              record[Sums::normal + d] += weight * near.distance.normal[d];
              record[Sums::place + d] += weight * near.x[d];
              record[Sums::momentum + d] +=
                weight * points.velocity[d][near.point];
            }
          record[Sums::weight] += weight;
          record[Sums::own] += weight;
        });
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold(const unsigned int slot)
  {
    impulses.hold(slot);
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold_before(const unsigned int slot, const double step)
  {
    impulses.hold_before(slot, step, parts.problem.loads.gravity);
  }



  // To the balance of an obstacle or a side
  template <int dim>
  void
  ObstacleContact<dim>::add_impulse(const Touch &touch, const Vector &impulse)
  {
    if (touch.obstacle >= n_obstacles())
      {
        const unsigned int side =
          sides_that_meet[touch.obstacle - n_obstacles()];
        parts.ledger.side_impulse[side] += impulse;
        return;
      }
    ObstacleAction<dim> &action = parts.ledger.obstacles[touch.obstacle];
    action.impulse += impulse;
    action.moment += moment_of<dim>(touch.arm, impulse);
  }



  // In the frame of the box, impulses also do work with the velocity of the
  // obstacle, besides what points lose.
  template <int dim>
  void
  ObstacleContact<dim>::exchange()
  {
    parts.ledger.add(impulses.exchange());
    for (std::size_t p = 0; p < touches.size(); ++p)
      {
        const Place &place  = impulses.all()[p];
        const Touch &touch  = touches[p];
        const Vector beyond = touch.beyond * place.normal;
        add_impulse(touch, place.impulse + beyond);
        if (touch.obstacle >= n_obstacles())
          continue;
        parts.ledger.load_impulse -= beyond; // counted there as a load
        parts.ledger.boundary_work += place.impulse * place.velocity;
      }
    impulses.for_each_given_to_side([this](const unsigned int side,
                                           const int          component,
                                           const double       impulse) {
      parts.ledger.side_impulse[side][component] -= impulse;
    });
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold_filtered(const unsigned int slot)
  {
    impulses.hold_and_note(slot);
  }



  template <int dim>
  double
  ObstacleContact<dim>::account_filtered()
  {
    double work = 0;
    for (std::size_t p = 0; p < touches.size(); ++p)
      {
        const Place &place = impulses.all()[p];
        add_impulse(touches[p], place.held);
        work += place.held * place.velocity;
      }
    parts.ledger.boundary_work += work;
    return work;
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold_after(const unsigned int slot,
                                   const double       flip_share)
  {
    parts.ledger.add(impulses.hold_after(slot, flip_share));
  }



  template class ObstacleContact<2>;
  template class ObstacleContact<3>;
} // namespace limber
