// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/cell_functions.h>
#include <limber/time/contact.h>
#include <limber/time/contact_geometry.h>

#include <algorithm>

/**
 * @file Where bodies touch, in which direction, and whether their points do; as
 * all ranks that hold a node agree.
 */
namespace limber
{
  namespace
  {
    /** Its direction; zero of zero. */
    template <int dim>
    dealii::Tensor<1, dim>
    unit(const dealii::Tensor<1, dim> &vector)
    {
      const double length = vector.norm();
      return length > 0 ? vector / length : vector;
    }
  } // namespace



  template <int dim>
  void
  Contact<dim>::find()
  {
    find_nodes();
    find_neighbours();
    find_gradients();
    find_normals();
  }



  template <int dim>
  void
  Contact<dim>::reinit()
  {
    touches.clear();
    first_of.reinit(parts.nodes.table.n());
    if (!parts.grid.has_levels())
      return;
    hanging_of.reinit(parts.nodes.table.n());
    std::uint32_t n = 0;
    for (const HangingNode &hanging : parts.nodes.table.hanging)
      hanging_of[hanging.node] = ++n;
  }



  template <int dim>
  void
  Contact<dim>::find_nodes()
  {
    for (const Touch &touch : touches)
      first_of[touch.node] = 0;
    touches.clear();
    for (const std::uint32_t node : parts.nodes.active_nodes())
      for (unsigned int a = 0; a + 1 < n_fields; ++a)
        {
          if (!(parts.nodes.record(a, node)[Layout::mass] > 0))
            continue;
          for (unsigned int b = a + 1; b < n_fields; ++b)
            if (parts.nodes.record(b, node)[Layout::mass] > 0)
              {
                Touch touch;
                touch.node = node;
                touch.a    = a;
                touch.b    = b;
                touches.push_back(touch);
                if (first_of[node] == 0)
                  first_of[node] = static_cast<std::uint32_t>(touches.size());
              }
        }
  }



  // Batches with a node at which their body may part from another one. Most
  // points are met by nothing but the look at the nodes of their cell.
  template <int dim>
  void
  Contact<dim>::find_neighbours()
  {
    neighbours.clear();
    corners.clear();
    if (touches.empty())
      return;
    const GridView<dim> grid = parts.nodes.view();
    with_degree(grid, [&](const auto degree) {
      for (unsigned int b = 0; b < parts.bodies.size(); ++b)
        for_each_batch(
          parts.bodies[b]->points.view(), [&](const CellBatch &batch) {
            const std::size_t first = corners.size();
            add_corners(b,
                        CellFunctions<dim, decltype(degree)::value>::nodes_of(
                          grid, batch.cell));
            if (corners.size() > first)
              neighbours.push_back({b, batch, first, corners.size()});
          });
    });
  }



  template <int dim>
  template <std::size_t n>
  void
  Contact<dim>::add_corners(const unsigned int                  body,
                            const std::array<std::uint32_t, n> &nodes)
  {
    const unsigned int field = parts.bodies[body]->description.nodal_field;
    for (unsigned int k = 0; k < n; ++k)
      {
        const std::uint32_t node = nodes[k] / Layout::stride;
        add_corner(field, node, k, 1);
        if (hanging_of.size() > 0 && hanging_of[node] > 0)
          for (const auto &[master, share] :
               parts.nodes.table.hanging[hanging_of[node] - 1].masters)
            add_corner(field, master, k, share);
      }
  }



  template <int dim>
  void
  Contact<dim>::add_corner(const unsigned int  field,
                           const std::uint32_t node,
                           const unsigned int  k,
                           const double        share)
  {
    if (first_of[node] == 0)
      return;
    for (std::size_t t = first_of[node] - 1;
         t < touches.size() && touches[t].node == node;
         ++t)
      if ((touches[t].a == field || touches[t].b == field) &&
          law(touches[t].a, touches[t].b).law == ContactLaw::separate)
        corners.push_back({static_cast<std::uint32_t>(t), k, share});
  }



  // begin(neighbours, field, points) gives what is done to each point of the
  // batch, as work(p, volume).
  template <int dim>
  template <class Begin>
  void
  Contact<dim>::for_each_neighbour(const Begin &begin)
  {
    for (const Neighbours &some : neighbours)
      {
        MaterialBody<dim>   &body            = *parts.bodies[some.body];
        const PointView<dim> points          = body.points.view();
        const double         inverse_density = 1 / body.stress->density();
        auto work = begin(some, body.description.nodal_field, points);
        for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
          work(p, points.mass[p] * inverse_density);
      }
  }



  // Each rank has gathered over its points at the touches; all that hold the
  // node get the same. Without other ranks there is nothing to do.
  template <int dim>
  template <class SlotsOf>
  void
  Contact<dim>::share(SharedSlots &slots, const SlotsOf &slots_of)
  {
    const ExchangePlan &plan = parts.nodes.node_plan();
    if (plan.neighbours.empty())
      return;
    const unsigned int n = slots.n;
    if (slots.records.size() != std::size_t(parts.nodes.table.n()) * n)
      slots.records.reinit(std::size_t(parts.nodes.table.n()) * n);
    double *const records = slots.records.data();
    const auto    clear   = [&](const std::vector<std::uint32_t> &nodes) {
      for (const std::uint32_t node : nodes)
        std::fill_n(records + std::size_t(node) * n, n, slots.nothing);
    };
    // work(slot of the touch, slot of the record)
    const auto for_each_slot = [&](const auto &pair, const auto &work) {
      for (std::size_t t = 0; t < touches.size(); ++t)
        if (touches[t].a == pair[0] && touches[t].b == pair[1])
          {
            double *record = records + std::size_t(touches[t].node) * n;
            for (double *const slot : slots_of(t))
              work(*slot, *record++);
          }
    };
    for (const auto &pair : parting)
      {
        for (const auto &neighbour : plan.neighbours)
          {
            clear(neighbour.send);
            clear(neighbour.receive);
          }
        for_each_slot(pair, [](double &own, double &shared) { shared = own; });
        slots.exchange.start(plan, records, 0, n);
        if (slots.of_largest)
          slots.exchange.finish_largest(records);
        else
          slots.exchange.finish(records);
        for_each_slot(pair, [](double &own, double &shared) { own = shared; });
      }
  }



  template <int dim>
  void
  Contact<dim>::find_gradients()
  {
    const GridView<dim> grid = parts.nodes.view();
    with_degree(grid, [&](const auto degree) {
      for_each_neighbour([&](const Neighbours     &some,
                             const unsigned int    field,
                             const PointView<dim> &points) {
        CellFunctions<dim, decltype(degree)::value> functions(grid,
                                                              some.batch.cell);
        return [&, functions, field](const std::size_t p,
                                     const double      volume) mutable {
          functions.go_to(points, p);
          for (std::size_t c = some.first; c < some.last; ++c)
            {
              Touch  &touch = touches[corners[c].touch];
              Vector &gradient =
                field == touch.a ? touch.gradient_a : touch.gradient_b;
              for (int d = 0; d < dim; ++d)
                gradient[d] +=
                  volume * corners[c].share * functions.slope(corners[c].k, d);
            }
        };
      });
    });
    share(gradients, [this](const std::size_t t) {
      std::array<double *, 2 * dim> slots;
      for (int d = 0; d < dim; ++d)
        {
          slots[d]       = &touches[t].gradient_a[d];
          slots[dim + d] = &touches[t].gradient_b[d];
        }
      return slots;
    });
    // As if the material went on behind a side that holds it.
    for (Touch &touch : touches)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if ((parts.nodes.table.sides[touch.node] >> side & 1) &&
            parts.problem.sides[side].held != HeldComponents::none)
          touch.gradient_a[side / 2] = touch.gradient_b[side / 2] = 0;
  }



  // Of convex bodies the largest separation over all directions is their
  // distance. At the end of the face of one of them, its own gradient points
  // past the corner; that of the other is right, and the points are further
  // apart along it.
  template <int dim>
  void
  Contact<dim>::find_normals()
  {
    separations.assign(touches.size(), {});
    for (std::size_t t = 0; t < touches.size(); ++t)
      {
        const Vector of_a        = unit(touches[t].gradient_a),
                     of_b        = unit(touches[t].gradient_b);
        separations[t].direction = {{of_a, -1. * of_b, unit(of_a - of_b)}};
      }
    for_each_neighbour([&](const Neighbours     &some,
                           const unsigned int    field,
                           const PointView<dim> &points) {
      return [&, field](const std::size_t p, const double volume) {
        const double half_edge = half_edge_of<dim>(volume);
        for (std::size_t c = some.first; c < some.last; ++c)
          {
            Separation &separation = separations[corners[c].touch];
            const bool  is_a       = field == touches[corners[c].touch].a;
            for (unsigned int k = 0; k < separation.direction.size(); ++k)
              {
                double along = 0;
                for (int d = 0; d < dim; ++d)
                  along += points.place[d][p] * separation.direction[k][d];
                double &furthest =
                  is_a ? separation.furthest_a[k] : separation.furthest_b[k];
                furthest =
                  std::max(furthest, (is_a ? along : -along) + half_edge);
              }
          }
      };
    });
    share(extents, [this](const std::size_t t) {
      std::array<double *, 6> slots;
      for (unsigned int k = 0; k < 3; ++k)
        {
          slots[k]     = &separations[t].furthest_a[k];
          slots[3 + k] = &separations[t].furthest_b[k];
        }
      return slots;
    });
    for (std::size_t t = 0; t < touches.size(); ++t)
      {
        const Separation &separation = separations[t];
        double            largest    = -1e300;
        for (unsigned int k = 0; k < separation.direction.size(); ++k)
          if (const double distance =
                -separation.furthest_b[k] - separation.furthest_a[k];
              distance > largest && separation.direction[k] != Vector())
            {
              largest           = distance;
              touches[t].normal = separation.direction[k];
            }
        touches[t].points_touch = largest <= 0;
      }
  }



  template void
  Contact<2>::reinit();
  template void
  Contact<3>::reinit();
  template void
  Contact<2>::find();
  template void
  Contact<3>::find();
} // namespace limber
