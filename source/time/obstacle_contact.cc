// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/obstacle_contact.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Of the mass of a node, what has to touch. Held by whatever sees it, a
    // node a cell above the surface would be as rigid as the obstacle: the
    // impact of a ball of 10 cells would take 0.82 of its time. Splines see
    // more points beyond those that touch; with these shares the impact is the
    // same with them.
    double
    least_touching_share(const KernelKind kernel)
    {
      switch (kernel)
        {
          case KernelKind::quadratic:
            return 0.35;
          case KernelKind::cubic:
            return 0.2;
          default:
            return 0.5;
        }
    }



    template <int dim>
    dealii::Tensor<1, 3>
    moment_of(const dealii::Tensor<1, dim> &arm,
              const dealii::Tensor<1, dim> &impulse)
    {
      dealii::Tensor<1, 3> result;
      result[2] = arm[0] * impulse[1] - arm[1] * impulse[0];
      if constexpr (dim == 3)
        {
          result[0] = arm[1] * impulse[2] - arm[2] * impulse[1];
          result[1] = arm[2] * impulse[0] - arm[0] * impulse[2];
        }
      return result;
    }
  } // namespace



  template <int dim>
  ObstacleContact<dim>::ObstacleContact(const RunParts<dim> &parts)
    : parts(parts)
    , sums(parts.problem.obstacles.size() * n_nodal_fields(parts.problem))
    , cell_distance(parts.problem.obstacles.size())
  {
    parts.ledger.obstacles.resize(parts.problem.obstacles.size());
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points  = body->points.view();
        double               largest = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          largest = std::max(largest, points.mass[p]);
        half_edge.push_back(half_edge_of<dim>(
          dealii::Utilities::MPI::max(largest, parts.grid.communicator) /
          body->stress->density()));
      }
    check_start();
    reinit();
  }



  template <int dim>
  void
  ObstacleContact<dim>::reinit()
  {
    touches.clear();
    for (Sums &some : sums)
      some.records.reinit(std::size_t(parts.nodes.table.n()) * Sums::stride);
    for (auto &distances : cell_distance)
      distances.reinit(std::size_t(parts.grid.n_cells()) * (1 + dim));
    if (parts.grid.has_levels())
      find_places();
  }



  // The owner of a node has a cell around it; a master may be far from the
  // cells of others that know it.
  template <int dim>
  void
  ObstacleContact<dim>::find_places()
  {
    const NodeTable<dim> &table = parts.nodes.table;
    places.reinit(std::size_t(table.n()) * dim);
    for (const CellGeometry<dim> &cell : parts.grid.geometry)
      for (unsigned int k = 0; k < 1u << dim; ++k)
        {
          const std::uint32_t node = cell.node[k] / Layout::stride;
          if (node < table.n_owned)
            for (int d = 0; d < dim; ++d)
              places[node * dim + d] =
                cell.origin[d] + (k >> d & 1) / cell.inverse_edge[d];
        }
    const ExchangePlan plan(table.shared);
    RecordExchange     exchange(dim);
    exchange.start(plan, places.data(), 0, dim);
    exchange.finish(places.data());
  }



  // With the places of masters instead of its own.
  template <int dim>
  void
  ObstacleContact<dim>::give_to_masters(Sums &some) const
  {
    for (const HangingNode &hanging : parts.nodes.table.hanging)
      {
        double *const from =
          some.records.data() + std::size_t(hanging.node) * Sums::stride;
        if (!(from[Sums::weight] > 0))
          continue;
        for (const auto &[master, share] : hanging.masters)
          {
            double *const to =
              some.records.data() + std::size_t(master) * Sums::stride;
            const double weight = share * from[Sums::weight];
            for (int d = 0; d < dim; ++d)
              {
                to[Sums::normal + d] += share * from[Sums::normal + d];
                to[Sums::place + d] += weight * places[master * dim + d];
              }
            to[Sums::weight] += weight;
          }
        std::fill_n(from, Sums::stride, 0.);
      }
  }



  template <int dim>
  void
  ObstacleContact<dim>::find(const double time, const double step)
  {
    const unsigned int n_fields = parts.nodes.n_fields();
    touches.clear();
    for (unsigned int o = 0; o < parts.problem.obstacles.size(); ++o)
      {
        check_way(o, time, step);
        const ObstaclePlace<dim> place(parts.problem.obstacles[o], time);
        for (unsigned int field = 0; field < n_fields; ++field)
          {
            Sums &some = sums[o * n_fields + field];
            for (const std::uint32_t node : parts.nodes.active_nodes())
              std::fill_n(some.records.data() +
                            std::size_t(node) * Sums::stride,
                          Sums::stride,
                          0.);
            for (unsigned int b = 0; b < parts.bodies.size(); ++b)
              if (parts.bodies[b]->description.nodal_field == field)
                add_points(b, o, place, some);
            give_to_masters(some);
            some.exchange.start(parts.nodes.node_plan(),
                                some.records.data(),
                                0,
                                Sums::stride);
            some.exchange.finish(some.records.data());
            add_touches(field, o, time, step, some);
          }
      }
  }



  // Where the middle of the cell has come nearer in the frame of the obstacle
  // since it asked, the distance is less by no more than that, or by twice as
  // much if it is of first order. At rest each cell asks once.
  template <int dim>
  bool
  ObstacleContact<dim>::is_beyond(const double              reach,
                                  const unsigned int        obstacle,
                                  const ObstaclePlace<dim> &place,
                                  const std::uint32_t       cell)
  {
    const CellGeometry<dim> &geometry = parts.nodes.view().cells[cell];
    dealii::Point<dim>       middle;
    for (int d = 0; d < dim; ++d)
      middle[d] = geometry.origin[d] + 0.5 / geometry.inverse_edge[d];
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
          asked[0] = 1e-300; // zero is what nobody has asked for
        for (int d = 0; d < dim; ++d)
          asked[1 + d] = start[d];
        way = 0;
      }
    return asked[0] - 2 * std::sqrt(way) > reach;
  }



  // Only points in cells that are as near as a half of their diagonal and a
  // point are asked; twice as far, as the distance from what a formula tells
  // is of first order.
  template <int dim>
  void
  ObstacleContact<dim>::add_points(const unsigned int        body,
                                   const unsigned int        obstacle,
                                   const ObstaclePlace<dim> &place,
                                   Sums                     &some)
  {
    with_degree(parts.nodes.view(), [&](const auto degree) {
      add_points_of_degree<decltype(degree)::value>(body,
                                                    obstacle,
                                                    place,
                                                    some);
    });
  }



  template <int dim>
  template <int degree>
  void
  ObstacleContact<dim>::add_points_of_degree(const unsigned int        body,
                                             const unsigned int        obstacle,
                                             const ObstaclePlace<dim> &place,
                                             Sums                     &some)
  {
    const GridView<dim>  grid    = parts.nodes.view();
    const PointView<dim> points  = parts.bodies[body]->points.view();
    const double inverse_density = 1 / parts.bodies[body]->stress->density();
    for_each_batch(points, [&](const CellBatch &batch) {
      const CellGeometry<dim> &cell   = grid.cells[batch.cell];
      double                   square = 0;
      for (int d = 0; d < dim; ++d)
        square += 0.25 / (cell.inverse_edge[d] * cell.inverse_edge[d]);
      if (is_beyond(2 * (std::sqrt(square) + half_edge[body]),
                    obstacle,
                    place,
                    batch.cell))
        return;
      CellFunctions<dim, degree> functions(grid, batch.cell);
      for (std::size_t p = batch.begin; p < batch.end; ++p)
        {
          dealii::Point<dim> x;
          for (int d = 0; d < dim; ++d)
            x[d] = points.position[d][p];
          const SignedDistance<dim> distance = place.distance(x);
          if (distance.value >
              half_edge_of<dim>(points.mass[p] * inverse_density))
            continue;
          functions.go_to(points, p);
          for (int k = 0; k < functions.n; ++k)
            {
              const double  weight = points.mass[p] * functions.value(k);
              double *const record =
                some.records.data() +
                std::size_t(functions.node(k)) * Sums::stride;
              for (int d = 0; d < dim; ++d)
                {
                  record[Sums::normal + d] += weight * distance.normal[d];
                  record[Sums::place + d] += weight * functions.place(k, d);
                }
              record[Sums::weight] += weight;
            }
        }
    });
  }



  template <int dim>
  void
  ObstacleContact<dim>::add_touches(const unsigned int field,
                                    const unsigned int obstacle,
                                    const double       time,
                                    const double       step,
                                    const Sums        &some)
  {
    const Obstacle<dim>     &one = parts.problem.obstacles[obstacle];
    const ObstaclePlace<dim> before(one, time), after(one, time + step);
    const double least_share = least_touching_share(parts.problem.grid.kernel);
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        const double *const record =
          some.records.data() + std::size_t(node) * Sums::stride;
        if (!(record[Sums::weight] > 0) ||
            record[Sums::weight] <
              least_share * parts.nodes.record(field, node)[Layout::mass])
          continue;
        Touch touch;
        touch.normal        = vector_in<dim>(record + Sums::normal);
        const double length = touch.normal.norm();
        if (!(length > 1e-6 * record[Sums::weight]))
          continue; // it is met from all sides alike
        touch.normal /= length;
        touch.node     = node;
        touch.field    = field;
        touch.obstacle = obstacle;
        const dealii::Point<dim> place(vector_in<dim>(record + Sums::place) /
                                       record[Sums::weight]);
        touch.arm = place - before.centre();
        if (one.moves())
          touch.velocity =
            (after.place_of(before.start_of(place)) - place) / step;
        touches.push_back(touch);
      }
  }



  template <int dim>
  typename ObstacleContact<dim>::State
  ObstacleContact<dim>::decide(const Touch &touch, const Vector &velocity) const
  {
    const Vector relative = velocity - touch.velocity;
    const double approach = -(relative * touch.normal);
    if (!(approach > 0))
      return State::free;
    return along_surface(relative, touch.normal).norm() <=
               obstacle(touch).friction * approach ?
             State::sticking :
             State::sliding;
  }



  // work(touch, relative velocity, mass) before it is changed.
  template <int dim>
  template <class Work>
  void
  ObstacleContact<dim>::for_each_held(const unsigned int slot, const Work &work)
  {
    for (const Touch &touch : touches)
      if (touch.state != State::free)
        {
          double *const record   = parts.nodes.record(touch.field, touch.node);
          const Vector  velocity = vector_in<dim>(record + slot),
                       relative  = velocity - touch.velocity;
          work(touch, relative, record[Layout::mass]);
          store_vector<dim>(touch.state == State::sticking ?
                              touch.velocity :
                              velocity -
                                (relative * touch.normal) * touch.normal,
                            record + slot);
        }
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold(const unsigned int slot)
  {
    for_each_held(slot, [](const Touch &, const Vector &, double) {});
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold_before(const unsigned int slot, const double step)
  {
    for (Touch &touch : touches)
      {
        const double *const record =
          parts.nodes.record(touch.field, touch.node);
        touch.state = decide(touch,
                             (vector_in<dim>(record + Layout::momentum) +
                              step * vector_in<dim>(record + Layout::force)) /
                               record[Layout::mass]);
      }
    hold(slot);
  }



  template <int dim>
  void
  ObstacleContact<dim>::exchange()
  {
    for (Touch &touch : touches)
      exchange(touch);
  }



  // Losses are those of Contact<dim>::exchange(), seen from the obstacle; seen
  // from the box, its impulse has worked with its velocity besides.
  template <int dim>
  void
  ObstacleContact<dim>::exchange(Touch &touch)
  {
    double *const record   = parts.nodes.record(touch.field, touch.node);
    const double  mass     = record[Layout::mass];
    const Vector  velocity = vector_in<dim>(record + Layout::velocity),
                 increment = vector_in<dim>(record + Layout::increment);
    touch.state            = decide(touch, velocity);
    if (touch.state == State::free)
      return;

    const Vector relative = velocity - touch.velocity;
    const Vector sliding  = along_surface(relative, touch.normal);
    const double pressing = -mass * (relative * touch.normal); // kg m/s
    touch.brought         = relative - increment;
    touch.rubbing =
      touch.state == State::sticking ?
        mass * sliding :
        obstacle(touch).friction * pressing * sliding / sliding.norm();
    touch.slides = sliding - touch.rubbing / mass;

    const Vector impulse = pressing * touch.normal - touch.rubbing;
    store_vector<dim>(velocity + impulse / mass, record + Layout::velocity);
    store_vector<dim>(increment + impulse / mass, record + Layout::increment);

    if (!parts.nodes.owns(touch.node))
      return;
    ObstacleAction<dim> &action = parts.ledger.obstacles[touch.obstacle];
    action.impulse += impulse;
    action.moment += moment_of<dim>(touch.arm, impulse);
    parts.ledger.boundary_work += impulse * touch.velocity;
    const double normal = touch.brought * touch.normal;
    const Vector along  = along_surface(touch.brought, touch.normal);
    parts.ledger.contact += 0.5 * mass * normal * normal;
    parts.ledger.friction += touch.state == State::sticking ?
                               0.5 * mass * along.norm_square() :
                               0.5 * touch.rubbing * (along + touch.slides);
  }



  template <int dim>
  void
  ObstacleContact<dim>::hold_after(const unsigned int slot,
                                   const double       flip_share)
  {
    for_each_held(
      slot, [&](const Touch &touch, const Vector &relative, const double mass) {
        if (!parts.nodes.owns(touch.node))
          return;
        const double share = 0.5 * flip_share;
        const Vector along = along_surface(relative, touch.normal);
        parts.ledger.contact += share * mass * (touch.brought * touch.normal) *
                                (relative * touch.normal);
        parts.ledger.friction +=
          share * (touch.state == State::sticking ?
                     mass * (touch.brought * along) :
                     touch.rubbing * (along - touch.slides));
      });
  }



  template class ObstacleContact<2>;
  template class ObstacleContact<3>;
} // namespace limber
