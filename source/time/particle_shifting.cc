// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/particle_shifting.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace limber
{
  namespace
  {
    // Way of the fastest point between two shifts, in cells: so short that few
    // points clump meanwhile, so long that it costs little.
    constexpr double interval = 0.2;

    // Limit of C s. An excess that alternates from node to node along one axis
    // is multiplied by 1 - 4.5 C s, and grows from 0.44 on.
    constexpr double largest_factor = 0.42;

    // Limit of each shift along an axis, in cells.
    constexpr double largest_shift = 0.1;

    // alpha: with C = 2, a fifth of an overfill that is uniform over many cells
    // goes with each shift.
    constexpr double share_of_room = 0.5;

    // Limit of |g|. What flies apart leaves nodes nearly empty, and shall not
    // be drawn together.
    constexpr double largest_excess = 0.5;

    // Of the difference of the fillings of two cells: what rows of points that
    // pass a face, or points that press on an obstacle, make of it. If it
    // counted, volumes that move to and fro would be noise of the pressure: the
    // force on prm/verification/closed_piston.prm in explicit steps errs by 2 %
    // then, by 0.6 % with any threshold from 0.1 to 0.3.
    constexpr double noise_of_filling = 0.12;

    // How near to a side of the box points are shifted, in cells: closer ones
    // leave the next nodes hardly any mass, but all of their force. To a side
    // that moves, a cell: when it comes back it takes along what is in between.
    constexpr double least_distance = 0.05;

    // Padding: arrays of points are written a SIMD pack at a time.
    constexpr std::size_t room_for_pack = 16;



    template <int dim>
    double
    volume_of(const CellGeometry<dim> &cell)
    {
      double result = 1;
      for (const double inverse : cell.inverse_edge)
        result /= inverse;
      return result;
    }



    /** The edge of a square or cube of this content. */
    template <int dim>
    double
    root(const double content)
    {
      return dim == 2 ? std::sqrt(content) : std::cbrt(content);
    }



    /** Of what holds @p filling times its room. */
    double
    excess_of(const double filling)
    {
      return std::clamp(filling - 1, -largest_excess, largest_excess);
    }



    double
    beyond_noise(const double difference)
    {
      return std::copysign(std::max(0.,
                                    std::abs(difference) - noise_of_filling),
                           difference);
    }



    /** Natural coordinates of a point in its cell. */
    template <int dim>
    std::array<double, dim>
    natural(const PointView<dim>    &points,
            const std::size_t        p,
            const CellGeometry<dim> &cell)
    {
      std::array<double, dim> xi;
      for (int d = 0; d < dim; ++d)
        xi[d] = (points.position[d][p] - cell.origin[d]) * cell.inverse_edge[d];
      return xi;
    }
  } // namespace



  template <int dim>
  ParticleShifting<dim>::ParticleShifting(const RunParts<dim>       &parts,
                                          const CutCells<dim> *const cut_cells)
    : parts(parts)
    , cut_cells(cut_cells)
    , controls_density(
        std::any_of(parts.bodies.begin(),
                    parts.bodies.end(),
                    [](const auto &body) {
                      return body->description.implicit_pressure &&
                             body->description.density_control > 0;
                    }))
    , surroundings(parts.grid)
    , nodal_volumes(parts.grid, cut_cells)
    , potential(parts.grid)
  {
    std::map<unsigned int, Group> by_field;
    for (auto &body : parts.bodies)
      if (body->description.particle_shifting > 0)
        by_field[body->description.nodal_field].liquids.push_back(body.get());
    for (auto &[field, group] : by_field)
      {
        for (auto &body : parts.bodies)
          if (std::find(group.liquids.begin(),
                        group.liquids.end(),
                        body.get()) == group.liquids.end())
            (body->description.nodal_field == field ? group.neighbours :
                                                      group.others)
              .push_back(body.get());
        groups.push_back(std::move(group));
      }
    reinit();
  }



  template <int dim>
  void
  ParticleShifting<dim>::reinit()
  {
    if (groups.empty())
      return;
    surroundings.reinit();
    potential.reinit();
    records.reinit(std::size_t(parts.grid.vertices.n()) * Record::stride);
    holders.reinit(parts.grid.n_cells());
    at_change_of_size.reinit(parts.grid.vertices.n());
    for (const std::uint32_t master : parts.grid.vertices.masters)
      at_change_of_size[master] = true;
    for (const HangingNode &hanging : parts.grid.vertices.hanging)
      at_change_of_size[hanging.node] = true;
    nodal_volumes.reinit();
  }



  template <int dim>
  bool
  ParticleShifting<dim>::is_due() const
  {
    return !groups.empty() && travelled >= interval;
  }



  template <int dim>
  void
  ParticleShifting<dim>::shift()
  {
    for (const Group &group : groups)
      {
        find_excess(group);
        for (MaterialBody *const body : group.liquids)
          move_points(*body);
      }
    travelled = way_left();
  }



  // What largest_factor has cut off counts for the next shift; in long steps,
  // of which each shifts, it never ends.
  template <int dim>
  double
  ParticleShifting<dim>::way_left() const
  {
    double largest = 0; // C
    for (const Group &group : groups)
      for (const MaterialBody *const body : group.liquids)
        largest = std::max(largest, body->description.particle_shifting);
    return std::clamp(travelled - largest_factor / largest, 0., interval);
  }



  template <int dim>
  void
  ParticleShifting<dim>::find_holders(const Group &group)
  {
    for (const std::uint32_t cell :
         parts.nodes.vertices().owned_occupied_cells())
      holders[cell] = 0;
    const auto mark = [&](const std::vector<MaterialBody *> &bodies,
                          const Holder                       holder) {
      for (const MaterialBody *const body : bodies)
        {
          const PointView<dim> points = body->points.view();
          for (std::size_t p = 0; p < points.size; ++p)
            holders[points.cell[p]] |= holder;
        }
    };
    mark(group.liquids, of_liquids);
    mark(group.neighbours, of_neighbours);
    mark(group.others, of_others);
  }



  // Nodal volume, m^3; 0 where the node does not count: in cut cells the
  // density control of semi-implicit steps alone keeps the volume better.
  template <int dim>
  double
  ParticleShifting<dim>::nodal_volume_at(const std::uint32_t node) const
  {
    return controls_density && nodal_volumes.is_at_obstacle(node) ?
             0 :
             nodal_volumes.at(node);
  }



  template <int dim>
  void
  ParticleShifting<dim>::find_excess(const Group &group)
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    const NodeTable<dim>   &table    = parts.grid.vertices;
    find_holders(group);
    surroundings.find(
      vertices,
      [&](const std::uint32_t cell) { return holders[cell] != 0; },
      cut_cells ? cut_cells->covered_corners() : nullptr);

    for (const auto *const all : {&vertices.active_nodes(), &table.masters})
      for (const std::uint32_t node : *all)
        std::fill_n(record(node), Record::stride, 0.);
    for (const HangingNode &hanging : table.hanging)
      std::fill_n(record(hanging.node), Record::stride, 0.);
    for (const auto *const bodies : {&group.liquids, &group.neighbours})
      for (MaterialBody *const body : *bodies)
        add_volumes(*body);
    mark_nodes();
    table.give_to_masters(records.data(), Record::stride, 0, Record::parts);
    exchange.start(vertices.node_plan(), records.data(), 0, Record::fillings);
    exchange.finish(records.data());
    find_fillings();

    for (const std::uint32_t node : vertices.active_nodes())
      {
        double *const of_node      = record(node);
        const double  nodal_volume = nodal_volume_at(node);
        double excess = excess_of(of_node[Record::excess] / nodal_volume);
        if (of_node[Record::at_surface] > 0)
          excess = std::max(excess, 0.);
        if (of_node[Record::shared] > 0 || !(nodal_volume > 0))
          excess = 0;
        of_node[Record::excess] = excess;
      }
    add_potential();
    table.take_from_masters(records.data(),
                            Record::stride,
                            Record::excess,
                            Record::excess + 1);
  }



  // The volume of a point that covers parts of the cells around the nearest
  // node: of each its share, as if the point were a box, which no side cuts,
  // nor a change of the size of cells.
  template <int dim>
  void
  ParticleShifting<dim>::add_parts(const std::uint32_t            cell,
                                   const std::array<double, dim> &xi,
                                   const double                   volume)
  {
    const double edge =
      std::min(1., root<dim>(volume / volume_of(parts.grid.geometry[cell])));
    unsigned int corner = 0;
    for (int d = 0; d < dim; ++d)
      corner |= (xi[d] > 0.5) << d;
    const std::uint32_t           node  = surroundings.node_of(cell, corner);
    const std::uint8_t            sides = parts.grid.vertices.sides[node];
    std::array<double, n_corners> shares;
    shares.fill(volume);
    for (int d = 0; d < dim; ++d)
      {
        const unsigned int end      = corner >> d & 1;
        const double       distance = end == 1 ? 1 - xi[d] : xi[d];
        const bool         is_whole =
          at_change_of_size[node] || (sides >> (2 * d + end) & 1);
        const double own = is_whole ? 1. : std::min(1., 0.5 + distance / edge);
        for (unsigned int a = 0; a < n_corners; ++a)
          shares[a] *= (a >> d & 1) == end ? own : 1 - own;
      }
    for (unsigned int a = 0; a < n_corners; ++a)
      record(node)[Record::parts + a] += shares[a];
  }



  // How far each cell is filled, at all of its corners.
  template <int dim>
  void
  ParticleShifting<dim>::find_fillings()
  {
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    for (const std::uint32_t cell : vertices.owned_occupied_cells())
      {
        double volume = 0;
        for (unsigned int a = 0; a < n_corners; ++a)
          volume += record(surroundings.node_of(cell, a))[Record::parts + a];
        const double filling = volume / volume_of(parts.grid.geometry[cell]);
        for (unsigned int a = 0; a < n_corners; ++a)
          record(surroundings.node_of(cell, a))[Record::fillings + a] = filling;
      }
    exchange.start(vertices.node_plan(),
                   records.data(),
                   Record::fillings,
                   Record::stride);
    exchange.finish(records.data());
  }



  // Add alpha phi to g. Next to a free surface it is not known what nodes
  // should hold, and an excess that alone counted would be noise that only
  // grows: no source there. On adaptive meshes noise is not even where cell
  // sizes differ: a dam break with coarse cells inside rose.
  template <int dim>
  void
  ParticleShifting<dim>::add_potential()
  {
    if (parts.grid.has_levels())
      return;
    const NodalFields<dim> &vertices = parts.nodes.vertices();
    potential.clear(vertices);
    for (const std::uint32_t cell : vertices.owned_occupied_cells())
      if (holders[cell] & of_liquids)
        {
          const auto *const cut = cut_cells ? cut_cells->cell(cell) : nullptr;
          potential.add_cell(cell,
                             volume_of(parts.grid.geometry[cell]) *
                               (cut ? cut->open : 1));
        }
    for (const std::uint32_t node : vertices.active_nodes())
      {
        const double *const of_node = record(node);
        potential.set_source(node,
                             of_node[Record::at_surface] > 0 ?
                               0. :
                               of_node[Record::excess] * nodal_volume_at(node),
                             !surroundings.is_surrounded(node));
      }
    potential.solve(vertices);
    for (const std::uint32_t node : vertices.active_nodes())
      record(node)[Record::excess] += share_of_room * potential.at(node);
  }



  template <int dim>
  void
  ParticleShifting<dim>::add_volumes(MaterialBody &body)
  {
    const PointView<dim> points          = body.points.view();
    const double         inverse_density = 1 / body.stress->density();
    volume_ratios.resize(points.size + room_for_pack);
    body.stress->volume_ratio(points, volume_ratios.data());
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const std::uint32_t cell = points.cell[p];
        const auto          xi = natural(points, p, parts.grid.geometry[cell]);
        const double        volume =
          inverse_density * points.mass[p] * volume_ratios[p];
        for (unsigned int a = 0; a < n_corners; ++a)
          {
            double part = volume;
            for (int d = 0; d < dim; ++d)
              part *= a >> d & 1 ? xi[d] : 1 - xi[d];
            record(surroundings.node_of(cell, a))[Record::excess] += part;
          }
        add_parts(cell, xi, volume);
      }
  }



  template <int dim>
  void
  ParticleShifting<dim>::mark_nodes()
  {
    const auto mark = [&](const std::uint32_t cell, const unsigned int slot) {
      for (unsigned int a = 0; a < n_corners; ++a)
        record(surroundings.node_of(cell, a))[slot] += 1;
    };
    for (const std::uint32_t cell :
         parts.nodes.vertices().owned_occupied_cells())
      {
        if (holders[cell] & of_liquids && !surroundings.is_inside(cell))
          mark(cell, Record::at_surface);
        if (holders[cell] & of_others)
          mark(cell, Record::shared);
      }
  }



  // Displacements at the faces of a cell towards the upper end of each
  // direction, in cells: finite volume fluxes of diffusion between cells.
  template <int dim>
  typename ParticleShifting<dim>::Faces
  ParticleShifting<dim>::shifts_at_faces(const std::uint32_t cell,
                                         const double        factor)
  {
    Faces result{};
    for (unsigned int d = 0; d < dim; ++d)
      for (const unsigned int end : {0u, 1u})
        {
          bool is_inside = true;
          for (unsigned int a = 0; a < n_corners; ++a)
            if ((a >> d & 1) == end)
              {
                const std::uint32_t node    = surroundings.node_of(cell, a);
                const double *const of_node = record(node);
                is_inside =
                  is_inside && !(of_node[Record::at_surface] > 0) &&
                  !(of_node[Record::shared] > 0) &&
                  !nodal_volumes.is_at_obstacle(node) &&
                  !at_change_of_size[node] &&
                  !(parts.grid.vertices.sides[node] >> (2 * d + end) & 1);
              }
          if (!is_inside)
            continue;
          const unsigned int  a = end << d;
          const double *const seen =
            record(surroundings.node_of(cell, a)) + Record::fillings;
          const double own  = excess_of(seen[a]),
                       next = excess_of(seen[a ^ 1u << d]);
          result[d][end]    = (end == 1 ? 1 : -1) * factor / (4. * dim) *
                           beyond_noise(own - next);
        }
    return result;
  }



  template <int dim>
  void
  ParticleShifting<dim>::move_points(MaterialBody &body)
  {
    const double factor =
      std::min(body.description.particle_shifting * travelled, largest_factor);
    const PointView<dim>      points  = body.points.view();
    const BinView<dim>        bins    = parts.nodes.view().bins;
    const auto               &box     = parts.problem.grid;
    const auto               &gravity = parts.problem.loads.gravity;
    std::array<bool, 2 * dim> may_shift_to;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      may_shift_to[side] = parts.problem.sides[side].velocity.empty();
    std::array<double, n_corners> excess;
    Faces                         through;
    std::uint32_t                 last = invalid_cell;
    bool                          any  = false;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const std::uint32_t      number = points.cell[p];
        const CellGeometry<dim> &cell   = parts.grid.geometry[number];
        if (number != last)
          {
            last    = number;
            through = shifts_at_faces(number, factor);
            any     = through != Faces{};
            for (unsigned int a = 0; a < n_corners; ++a)
              {
                excess[a] =
                  record(surroundings.node_of(number, a))[Record::excess];
                any = any || excess[a] != 0;
              }
          }
        if (!any)
          continue;
        const auto xi   = natural(points, p, cell);
        double     work = 0;
        for (int d = 0; d < dim; ++d)
          {
            double slope = 0; // over natural coordinates
            for (unsigned int a = 0; a < n_corners; ++a)
              {
                double weight = a >> d & 1 ? 1 : -1;
                for (int e = 0; e < dim; ++e)
                  if (e != d)
                    weight *= a >> e & 1 ? xi[e] : 1 - xi[e];
                slope += weight * excess[a];
              }
            const double edge = 1 / cell.inverse_edge[d];
            const double shift =
              std::clamp((1 - xi[d]) * through[d][0] + xi[d] * through[d][1] -
                           factor * slope,
                         -largest_shift,
                         largest_shift) *
              edge;
            const double       place = points.position[d][p] + shift;
            const unsigned int side  = 2 * d + (shift > 0);
            const double       distance =
              shift > 0 ? box.upper[d] - place : place - box.lower[d];
            if (distance < (may_shift_to[side] ? least_distance : 1) * edge)
              continue;
            points.position[d][p] = place;
            work += gravity[d] * shift;
          }
        parts.ledger.history += points.mass[p] * work;
        std::array<double, dim> x;
        for (int d = 0; d < dim; ++d)
          x[d] = points.position[d][p];
        points.cell[p] = bins.nearest_cell(x);
      }
  }



  template class ParticleShifting<2>;
  template class ParticleShifting<3>;
} // namespace limber
