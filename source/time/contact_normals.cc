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
  Contact<dim>::find(const double step)
  {
    find_nodes();
    find_neighbours();
    find_gradients();
    find_normals();
    find_places(step);
  }



  template <int dim>
  void
  Contact<dim>::reinit()
  {
    touches.clear();
    impulses.reinit();
    of_pair_at.reinit(parts.grid.vertices.n());
    marked.clear();
    ranks_of_vertex.clear();
    for (const auto &neighbour : parts.grid.vertices.shared.neighbours)
      for (const std::uint32_t vertex : neighbour.records)
        ranks_of_vertex[vertex].push_back(neighbour.rank);
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
            const auto &nodes =
              CellFunctions<dim, decltype(degree)::value>::nodes_of(grid,
                                                                    batch.cell);
            if (!may_touch(nodes))
              return;
            const std::size_t first = corners.size();
            add_corners(b, nodes);
            if (corners.size() > first)
              neighbours.push_back({b, batch, first, corners.size()});
          });
    });
  }



  // One look without a branch per node, which nearly all batches end with.
  template <int dim>
  template <std::size_t n>
  bool
  Contact<dim>::may_touch(const std::array<std::uint32_t, n> &nodes) const
  {
    std::uint32_t found = 0;
    for (const std::uint32_t node : nodes)
      found |= first_of[node / Layout::stride];
    if (hanging_of.size() > 0)
      for (const std::uint32_t node : nodes)
        found |= hanging_of[node / Layout::stride];
    return found != 0;
  }



  template <int dim>
  template <std::size_t n>
  void
  Contact<dim>::add_corners(const unsigned int                  body,
                            const std::array<std::uint32_t, n> &nodes)
  {
    const unsigned int field = field_of(body);
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
      using Functions = CellFunctions<dim, decltype(degree)::value>;
      for_each_neighbour([&](const Neighbours     &some,
                             const PointView<dim> &points,
                             const double          inverse_density) {
        Functions                        functions(grid, some.batch.cell);
        std::array<Vector, Functions::n> of_nodes; // of the cell
        for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
          {
            const double volume = points.mass[p] * inverse_density;
            functions.go_to(points, p);
            for (int k = 0; k < Functions::n; ++k)
              for (int d = 0; d < dim; ++d)
                of_nodes[k][d] += volume * functions.slope(k, d);
          }
        for (std::size_t c = some.first; c < some.last; ++c)
          {
            Touch &touch = touches[corners[c].touch];
            (field_of(some.body) == touch.a ? touch.gradient_a :
                                              touch.gradient_b) +=
              corners[c].share * of_nodes[corners[c].k];
          }
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
                           const PointView<dim> &points,
                           const double          inverse_density) {
      half_edges.clear();
      for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
        half_edges.push_back(
          half_edge_of<dim>(points.mass[p] * inverse_density));
      for (std::size_t c = some.first; c < some.last; ++c)
        extend(some, points, corners[c]);
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



  // How far the points of a batch go along the directions of a touch.
  template <int dim>
  void
  Contact<dim>::extend(const Neighbours     &some,
                       const PointView<dim> &points,
                       const Corner         &corner)
  {
    Separation &separation = separations[corner.touch];
    const bool  is_a       = field_of(some.body) == touches[corner.touch].a;
    auto       &furthest = is_a ? separation.furthest_a : separation.furthest_b;
    auto        extent   = furthest;
    auto        direction = separation.direction;
    if (!is_a)
      for (Vector &n : direction)
        n *= -1;
    for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
      for (unsigned int k = 0; k < direction.size(); ++k)
        {
          double along = half_edges[p - some.batch.begin];
          for (int d = 0; d < dim; ++d)
            along += points.place[d][p] * direction[k][d];
          extent[k] = std::max(extent[k], along);
        }
    furthest = extent;
  }



  template void
  Contact<2>::reinit();
  template void
  Contact<3>::reinit();
  template void
  Contact<2>::find(double);
  template void
  Contact<3>::find(double);
} // namespace limber
