// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/grid/node_vector.h>
#include <limber/time/contact_geometry.h>
#include <limber/time/obstacle_contact.h>

#include <algorithm>
#include <cmath>

/** @file Contact of liquids with obstacles at single nodes, where these cut no
 * cells. */
namespace limber
{
  namespace
  {
    // A node in a wall is full of liquid from this share of its nodal volume
    // on, and held whichever points touch.
    constexpr double least_of_full = 0.8;

    // Least normal component on a wall of the mean normal of touching points
    constexpr double least_part = 0.1;



    // Share of a node's mass that must be that of touching points for it to be
    // held. The wider support of splines contains more points beyond these.
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
  } // namespace



  // Whether a node is in an obstacle, or in its surface, to a thousandth of a
  // cell; or, in the wall of a cell that a moving obstacle closes, within
  // least_open_left(). Cached for obstacles at rest: with many facets distances
  // are expensive.
  template <int dim>
  bool
  ObstacleContact<dim>::is_in(const std::uint32_t node,
                              const unsigned int  obstacle,
                              const Way          &way,
                              const bool          in_wall)
  {
    if (vertices.empty())
      return false;
    const auto is_within = [&](const double edges) {
      return way.before.distance(vertices[node]).value <=
             edges * parts.grid.smallest_edge;
    };
    constexpr double surface = 1e-3;
    if (rigid[obstacle].changes_place())
      return is_within(in_wall ? cut_cells->least_open_left() : surface);
    std::uint8_t &known = known_nodes[obstacle][node];
    if (known == 0)
      known = is_within(surface) ? 2 : 1;
    return known == 2;
  }



  template <int dim>
  typename ObstacleContact<dim>::Walls
  ObstacleContact<dim>::walls_at(const unsigned int  field,
                                 const std::uint32_t node) const
  {
    Walls walls;
    if (cut_cells == nullptr || !cut_cells->knows(field) ||
        !(cut_cells->covered_corners()[node] > 0))
      return walls;
    // By cell k around the node, which is its corner k
    const unsigned int covered = cut_cells->covered_corners()[node];
    const unsigned int sides   = parts.nodes.table.sides[node];
    const auto         is_open = [&](const unsigned int k) {
      for (unsigned int d = 0; d < dim; ++d)
        if (sides >> (2 * d + (k >> d & 1 ? 0 : 1)) & 1)
          return false; // it would be beyond a side
      return !(covered >> k & 1);
    };
    unsigned int n_open = 0, n_at_walls = 0;
    for (unsigned int k = 0; k < 1u << dim; ++k)
      if (is_open(k))
        {
          bool any = false;
          for (unsigned int d = 0; d < dim; ++d)
            if (covered >> (k ^ 1u << d) & 1)
              {
                walls.across[d] = k >> d & 1 ? -1 : 1;
                any             = true;
              }
          ++n_open;
          n_at_walls += any;
        }
    if (n_at_walls > 0)
      walls.open_at_walls = double(n_at_walls) / n_open;
    return walls;
  }



  // Where faces of cells are walls, as of a box aligned with the grid, these
  // hold the nodes: in all of their directions at a corner of the obstacle, or
  // the liquid would flow through them there; and whether points touch or not
  // where it fills the nodal volume, as points inside a liquid are anywhere.
  template <int dim>
  void
  ObstacleContact<dim>::add_nodes(const std::vector<Way> &ways)
  {
    for (unsigned int s = 0; s < sums.size(); ++s)
      {
        if (sums[s].records.size() == 0)
          continue;
        double *const records = sums[s].records.data();
        sums[s].exchange.start(parts.nodes.node_plan(),
                               records,
                               0,
                               Sums::n_summed);
        sums[s].exchange.finish(records);
        const unsigned int obstacle = s / parts.nodes.n_fields(),
                           field    = s % parts.nodes.n_fields();
        for (const std::uint32_t node : parts.nodes.active_nodes())
          if (!is_met_by_surface(field, node))
            add_node(obstacle,
                     field,
                     node,
                     records + std::size_t(node) * Sums::stride,
                     ways[obstacle]);
      }
  }



  template <int dim>
  void
  ObstacleContact<dim>::add_node(const unsigned int  obstacle,
                                 const unsigned int  field,
                                 const std::uint32_t node,
                                 const double *const touching,
                                 const Way          &way)
  {
    const double mass    = parts.nodes.record(field, node)[Layout::mass];
    const double weight  = touching[Sums::weight];
    const Vector normal  = vector_in<dim>(touching + Sums::normal);
    const Walls  walls   = walls_at(field, node);
    const bool   is_full = walls.any() &&
                         mass >= least_of_full * liquid_density[field] *
                                   cut_cells->open_nodal_volumes()[node] &&
                         is_in(node, obstacle, way, true);
    const bool touches_somewhere = // and the normals do not cancel
      weight > 0 && normal.norm() > 1e-6 * weight;
    if (!is_full && !touches_somewhere)
      return;
    const double least_share =
      walls.open_at_walls * least_touching_share(parts.problem.grid.kernel);
    const bool is_held = is_full || weight >= least_share * mass;
    if (!is_held && !is_in(node, obstacle, way, walls.any()))
      return;

    const dealii::Point<dim> x =
      weight > 0 ?
        dealii::Point<dim>(vector_in<dim>(touching + Sums::place) / weight) :
        vertices[node];
    // this rank's share in the impulse of the node
    const double part = weight > 0 ? touching[Sums::own] / weight :
                                     double(parts.nodes.owns(node));
    Vector       velocity;
    if (parts.problem.obstacles[obstacle].moves())
      velocity = way.velocity(x);
    const Vector beside =
      (vector_in<dim>(parts.nodes.record(field, node) + Layout::momentum) -
       vector_in<dim>(touching + Sums::momentum)) /
        mass -
      (1 - weight / mass) * velocity;
    const auto hold = [&](const Vector &along) {
      const double least = is_held ? 0 : std::min(0., beside * along);
      nodes_held.push_back(
        {node, along, least + velocity * along, part, impulses.all().size()});
      if (!(part > 0))
        return;
      Place &place   = impulses.add_place();
      place.normal   = along;
      place.velocity = velocity;
      place.least    = least;
      place.friction = parts.problem.obstacles[obstacle].friction;
      place.mass     = mass * part;
      impulses.add_share(field, node, 1);
      touches.push_back({obstacle, x - way.before.centre()});
    };
    if (!walls.any())
      return hold(normal / normal.norm());
    for (unsigned int d = 0; d < dim; ++d)
      if (walls.across[d] != 0 &&
          (is_full || normal[d] * walls.across[d] > least_part * weight))
        {
          Vector along;
          along[d] = walls.across[d];
          hold(along);
        }
  }



  template void
  ObstacleContact<2>::add_nodes(const std::vector<Way> &);
  template void
  ObstacleContact<3>::add_nodes(const std::vector<Way> &);
} // namespace limber
