// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/nodal_volumes.h>
#include <limber/time/pressure_system.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Dead band of the density control, relative to the nodal volume: the
    // positions of points do not give the volume more exactly.
    constexpr double excess_allowed = 0.02;



    /** Sign of a checkerboard mode in the cell at @p place around a node; it
     * alternates in the directions (bits) of @p pattern. */
    double
    sign(const unsigned int pattern, const unsigned int place)
    {
      return __builtin_parity(pattern & place) ? -1. : 1.;
    }



    /**
     * Call work(pattern, weight) for the sets of two and more directions in
     * which a checkerboard mode alternates. With the weights sum_d 1/h_d^2 over
     * these directions d all of them together are the difference between the
     * compact Laplacian of a cell's 2 dim neighbours and the wide one.
     */
    template <int dim, class Work>
    void
    for_each_pattern(const CellGeometry<dim> &cell, const Work &work)
    {
      for (unsigned int s = 3; s < 1 << dim; ++s)
        if (s & (s - 1))
          {
            double weight = 0;
            for (int d = 0; d < dim; ++d)
              if (s >> d & 1)
                weight += cell.inverse_edge[d] * cell.inverse_edge[d];
            work(s, weight);
          }
    }



    /** Index of the second cell in the 3^dim stencil of the first one; the node
     * they share is corner a of the first and corner b of the second. */
    template <int dim>
    unsigned int
    place_in_row(const unsigned int a, const unsigned int b)
    {
      unsigned int place = 0;
      for (int d = dim - 1; d >= 0; --d)
        place = 3 * place + 1 + (a >> d & 1) - (b >> d & 1);
      return place;
    }



    constexpr unsigned int
    row_width(const int dim)
    {
      return dim == 2 ? 9 : 27;
    }
  } // namespace



  template <int dim>
  PressureSystem<dim>::PressureSystem(const RunParts<dim>     &parts,
                                      BoundaryConditions<dim> &boundaries,
                                      PressureCells<dim>      &cells)
    : parts(parts)
    , boundaries(boundaries)
    , cells(cells)
    , controls_density(std::any_of(parts.bodies.begin(),
                                   parts.bodies.end(),
                                   [](const auto &body) {
                                     return body->description.density_control >
                                            0;
                                   }))
    , levels_weights(parts.problem.loads.gravity.norm() > 0 &&
                     std::all_of(parts.bodies.begin(),
                                 parts.bodies.end(),
                                 [](const auto &body) {
                                   return body->description.is_liquid;
                                 }))
    , looks_at_nodes(controls_density || levels_weights)
    , surroundings(parts.grid)
  {
    reinit();
  }



  template <int dim>
  void
  PressureSystem<dim>::reinit()
  {
    mobility.reinit(std::size_t(parts.nodes.table.n()) * dim);
    velocity.reinit(std::size_t(parts.nodes.table.n()) * dim);
    held_as.reinit(parts.nodes.table.n());
    held.clear();
    to_hold = nullptr;
    at_sides.clear();
    if (looks_at_nodes)
      {
        missing_mass.reinit(parts.nodes.table.n());
        volumes.reinit(parts.nodes.table.n());
        surroundings.reinit();
        at_surface.reinit(parts.nodes.table.n());
      }
    pattern_scales.resize(cells.media.size());
    for (auto &of_medium : pattern_scales)
      of_medium.reinit(parts.nodes.table.n());
  }



  template <int dim>
  void
  PressureSystem<dim>::find_columns()
  {
    equations.n     = cells.n;
    equations.first = cells.first;
    equations.n_all = cells.n_all;
    if (cells.corners.empty())
      find_columns_of_lattice();
    else
      find_columns_over_levels();
  }



  template <int dim>
  void
  PressureSystem<dim>::find_columns_of_lattice()
  {
    auto &media            = cells.media;
    in_body                = row_width(dim);
    of_cells               = in_body * media.size();
    equations.width        = of_cells + most_surfaces_near();
    const std::size_t size = std::size_t(equations.n) * equations.width;
    equations.columns.assign(size, PressureEquations::no_column);
    mates.assign(size, invalid_cell);
    for_each_row([&](const std::uint32_t row, const std::uint32_t cell) {
      const std::size_t begin   = std::size_t(row) * equations.width;
      std::size_t       surface = begin + of_cells;
      cells.for_each_near(
        cell, 1, [&](const unsigned int place, const auto near) {
          for (std::size_t l = 0; l < media.size(); ++l)
            if (const double number = media[l].record(near)[Record::number];
                number > 0)
              {
                const std::size_t at  = begin + l * in_body + place;
                equations.columns[at] = number - 1;
                mates[at]             = near;
              }
          if (cells.surfaces.any())
            cells.surfaces.for_each_in(near, [&](const std::uint32_t k) {
              equations.columns[surface] = cells.surfaces.pieces[k].row;
              mates[surface++]           = k;
            });
        });
    });
  }



  template <int dim>
  void
  PressureSystem<dim>::hold_nodes(const double end)
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        const double *const of_node = parts.nodes.record(node);
        const double        mass    = of_node[Layout::mass];
        for (int d = 0; d < dim; ++d)
          {
            mobility[std::size_t(node) * dim + d] = mass > 0 ? 1 / mass : 0;
            velocity[std::size_t(node) * dim + d] =
              mass > 0 ? of_node[Layout::velocity + d] : 0;
          }
      }
    hold_by_sides(end);
    if (to_hold != nullptr)
      hold_by_obstacles();
  }



  template <int dim>
  void
  PressureSystem<dim>::find_pattern_scales(const double step)
  {
    constexpr double all = dim == 2 ? 4 : 16;
    for (std::size_t l = 0; l < cells.media.size(); ++l)
      {
        const Medium &medium = cells.media[l];
        for (const std::uint32_t node : parts.nodes.active_nodes())
          {
            double sum = 0;
            if (is_inside(medium, node) && !is_at_obstacle(node))
              for (unsigned int k = 0; k < n_nodes; ++k)
                sum += medium.record(medium.cells_around(node)[k] -
                                     1)[Record::pattern];
            pattern_scales[l][node] = step * step / (n_nodes * all) * sum;
          }
      }
  }



  template <int dim>
  double
  PressureSystem<dim>::nodal_volume(const std::uint32_t node) const
  {
    if (!cells.corners.empty())
      return nodal_volume_over_levels(node);
    double result = 1; // cells of one size
    for (int d = 0; d < dim; ++d)
      result /= parts.grid.geometry[0].inverse_edge[d];
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (parts.nodes.table.sides[node] >> side & 1)
        result *= 0.5;
    return result;
  }



  // Relative overfill of a node, V_material/V_node - 1 beyond the dead band;
  // negative where it is underfilled.
  template <int dim>
  double
  PressureSystem<dim>::excess(const std::uint32_t node) const
  {
    double room = nodal_volume(node);
    if (is_at_obstacle(node))
      {
        room = NodalVolumes<dim>::beside_obstacle(
          cells.surfaces.cells()->open_nodal_volumes()[node], room);
        if (room == 0)
          return 0;
      }
    const double excess = volumes[node] / room - 1;
    if (excess < 0 && at_surface[node] > 0)
      return 0; // partly filled: at the free surface
    return std::copysign(std::max(0., std::abs(excess) - excess_allowed),
                         excess);
  }



  // At corners of cells at the free surface the points tell what is there.
  template <int dim>
  void
  PressureSystem<dim>::weigh(const double step)
  {
    if (!looks_at_nodes)
      return;
    sum_volumes();
    find_surface();
    if (!levels_weights)
      return;
    const auto &gravity = parts.problem.loads.gravity;
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const record = parts.nodes.record(node);
        const double  mass   = record[Layout::mass];
        missing_mass[node]   = 0;
        if (!(mass > 0) || at_surface[node] > 0)
          continue;
        const double room =
          is_at_obstacle(node) ?
            cells.surfaces.cells()->open_nodal_volumes()[node] :
            nodal_volume(node);
        const double share = room / volumes[node] - 1;
        missing_mass[node] = share * mass;
        for (int d = 0; d < dim; ++d)
          {
            const double change = step * share * gravity[d];
            record[Layout::velocity + d] += change;
            record[Layout::increment + d] += change;
            if (parts.nodes.owns(node))
              parts.ledger.gravity_impulse[d] += mass * change;
          }
      }
  }



  // A cell is at the free surface if any cell around its corners is empty.
  template <int dim>
  void
  PressureSystem<dim>::find_surface()
  {
    const Medium &liquids = cells.media.front();
    const auto    holds   = [&](const std::uint32_t cell) {
      return liquids.record(cell)[Record::volume] > 0;
    };
    surroundings.find(parts.nodes, holds, covered_corners());
    for (const std::uint32_t node : parts.nodes.active_nodes())
      at_surface[node] = 0;
    for (const std::uint32_t cell : liquids.cells)
      if (holds(cell) && !surroundings.is_inside(cell))
        for (unsigned int a = 0; a < n_nodes; ++a)
          {
            const std::uint32_t node = cells.node_of(cell, a);
            if (cells.corners.empty())
              at_surface[node] += 1;
            else
              cells.corners.for_each_master(node, [&](const auto &master) {
                at_surface[master.node] += 1;
              });
          }
    node_exchange.start(parts.nodes.node_plan(), at_surface.data(), 0, 1);
    node_exchange.finish(at_surface.data());
  }



  // P2G of the current volumes J m/rho0: the mass of a node that several
  // liquids share does not give their volume.
  template <int dim>
  void
  PressureSystem<dim>::sum_volumes()
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      volumes[node] = 0;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points          = body->points.view();
        const double         inverse_density = 1 / body->stress->density();
        const CellSums<dim>  sums            = body->cell_sums->view();
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double *const of_cell =
              sums.now + std::size_t(points.cell[p]) * sums.stride;
            const double J =
              of_cell[sums.volumetric()] / of_cell[CellSums<dim>::mass];
            const CellGeometry<dim> &cell = parts.grid.geometry[points.cell[p]];
            std::array<double, n_nodes> shares;
            shares[0] = J * points.mass[p] * inverse_density;
            for (int d = 0; d < dim; ++d)
              {
                const double xi = (points.position[d][p] - cell.origin[d]) *
                                  cell.inverse_edge[d];
                for (int a = 0; a < 1 << d; ++a)
                  {
                    shares[a | 1 << d] = xi * shares[a];
                    shares[a] -= shares[a | 1 << d];
                  }
              }
            for (unsigned int a = 0; a < n_nodes; ++a)
              volumes[cells.node_of(points.cell[p], a)] += shares[a];
          }
      }
    parts.nodes.table.give_to_masters(volumes.data(), 1, 0, 1);
    node_exchange.start(parts.nodes.node_plan(), volumes.data(), 0, 1);
    node_exchange.finish(volumes.data());
  }



  template <int dim>
  void
  PressureSystem<dim>::assemble(const double end,
                                const double step,
                                const double share)
  {
    hold_nodes(end);
    find_pattern_scales(step);
    const auto &media = cells.media;
    equations.values.assign(equations.columns.size(), 0.);
    equations.right_side.assign(equations.n, 0.);
    former.assign(equations.n, {});
    growth.assign(equations.n, 0.);
    may_be_cut.assign(equations.n, 0);
    for (std::size_t l = 0; l < media.size(); ++l)
      for (std::size_t k = 0; k < media[l].cells.size(); ++k)
        assemble_row(l, media[l].cells[k], media[l].first + k, step, share);
    if (cells.surfaces.any())
      assemble_surfaces(step);
  }



  template <int dim>
  double
  PressureSystem<dim>::scale()
  {
    auto &media = cells.media;
    is_cut.clear();
    pressures.assign(equations.n, 0.);
    scales.assign(equations.n, 0.);
    double squares = 0;
    for (std::size_t l = 0; l < media.size(); ++l)
      {
        Medium &medium = media[l];
        for (std::size_t k = 0; k < medium.cells.size(); ++k)
          {
            const std::uint32_t row = medium.first + k;
            double             &diagonal =
              equations.values[cells.corners.empty() ?
                                 std::size_t(row) * equations.width +
                                   l * in_body + place_in_row<dim>(0, 0) :
                                 entry_of(row, l, medium.cells[k])];
            const double *const of_cell = medium.record(medium.cells[k]);
            if (!(of_cell[Record::volume] > 0))
              diagonal = 1;
            scales[row] = 1 / std::sqrt(diagonal);
            medium.result(medium.cells[k])[Result::scale] = scales[row];
            equations.right_side[row] *= scales[row];
            if (!(of_cell[Record::volume] > 0))
              continue;
            pressures[row] =
              of_cell[Record::moment] / of_cell[Record::volume] / scales[row];
            const double volume = of_cell[Record::volume] * scales[row];
            squares += volume * volume;
          }
        cells.share(medium, Result::scale);
      }
    if (cells.surfaces.any())
      squares += scale_surfaces();
    for (std::uint32_t row = 0; row < equations.n; ++row)
      for (unsigned int place = 0; place < equations.width; ++place)
        if (const std::size_t at = std::size_t(row) * equations.width + place;
            mates[at] != invalid_cell)
          equations.values[at] *= scales[row] * scale_of(at, place);
    return std::sqrt(
      dealii::Utilities::MPI::sum(squares, parts.grid.communicator));
  }



  template <int dim>
  void
  PressureSystem<dim>::assemble_row(const std::size_t   number,
                                    const std::uint32_t cell,
                                    const std::uint32_t row,
                                    const double        step,
                                    const double        share)
  {
    const auto       &media  = cells.media;
    const Medium     &medium = media[number];
    const double      volume = medium.record(cell)[Record::volume];
    const std::size_t begin  = std::size_t(row) * equations.width;
    if (!(volume > 0))
      return;

    // The bodies of a medium have one pressure in a cell: compliances add up.
    double control  = 0;
    may_be_cut[row] = 1;
    medium.for_each_in(cell, [&](const auto &body, const double mass) {
      const Part part = part_of(medium, body, cell, mass);
      control += body.description.density_control * part.volume / volume;
      equations.right_side[row] += part.compliance * part.pressure;
      former[row].compliance += part.compliance;
      if (!body.description.cuts_tension)
        may_be_cut[row] = 0;
    });
    former[row].pressure = equations.right_side[row] / former[row].compliance;

    const auto entry_at = [&](const std::uint32_t node,
                              const unsigned int  a,
                              const unsigned int  b) {
      return cells.corners.empty() ?
               begin + number * in_body + place_in_row<dim>(a, b) :
               entry_of(row, number, medium.cells_around(node)[b] - 1);
    };
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const std::uint32_t node = cells.node_of(cell, a);
        if (control > 0)
          cells.corners.for_each_master(node, [&](const auto &master) {
            growth[row] +=
              share * control / n_nodes * master.share * excess(master.node);
          });
        if (const double scale = pattern_scales[number][node]; scale > 0)
          for_each_pattern<dim>(parts.grid.geometry[cell],
                                [&](const unsigned int pattern,
                                    const double       weight) {
                                  for (unsigned int b = 0; b < n_nodes; ++b)
                                    equations.values[entry_at(node, a, b)] +=
                                      scale * weight * sign(pattern, a) *
                                      sign(pattern, b);
                                });
      }
    couple(medium.record(cell) + Record::rows, cell, row, step);
    equations.values[cells.corners.empty() ?
                       begin + number * in_body + place_in_row<dim>(0, 0) :
                       entry_of(row, number, cell)] += former[row].compliance;
  }



  template <int dim>
  bool
  PressureSystem<dim>::set_density_source()
  {
    equations.right_side.assign(equations.n, 0.);
    int any = 0;
    for (const Medium &medium : cells.media)
      for (std::size_t k = 0; k < medium.cells.size(); ++k)
        {
          const std::uint32_t row = medium.first + k;
          if (growth[row] == 0 || (!is_cut.empty() && is_cut[row]))
            continue;
          any = 1;
          equations.right_side[row] =
            scales[row] * medium.record(medium.cells[k])[Record::volume] *
            growth[row];
        }
    return dealii::Utilities::MPI::max(any, parts.grid.communicator) > 0;
  }



  template <int dim>
  void
  PressureSystem<dim>::push(const std::uint32_t node,
                            const double        step,
                            double *const       force) const
  {
    for (int d = 0; d < dim; ++d)
      force[d] *= step * mobility_of(node, d);
    if (to_hold != nullptr && held_as[node] > 0)
      move(node, force);
  }



  template <int dim>
  typename PressureSystem<dim>::Part
  PressureSystem<dim>::part_of(const Medium            &medium,
                               const MaterialBody<dim> &body,
                               const std::uint32_t      cell,
                               const double             mass) const
  {
    const double *const sums     = body.cell_sums->record(cell);
    const double        J        = sums[(1 << dim) - 1] / mass;
    const double        V        = mass / body.stress->density();
    auto                response = body.stress->volumetric_response(J);
    if (!medium.is_liquid())
      {
        const double *const own = medium.record(cell);
        response.pressure       = own[Record::moment] / own[Record::volume];
      }
    return {V, response.pressure, V / response.stiffness, J};
  }



  template <int dim>
  void
  PressureSystem<dim>::couple(const double *const entries,
                              const std::uint32_t cell,
                              const std::uint32_t row,
                              const double        step)
  {
    if (cells.corners.empty())
      couple_on_lattice(entries, cell, row, step);
    else
      couple_over_levels(entries, cell, row, step);
  }



  // dt^2 B M^-1 B^T (Schur complement of the lumped mass), and - dt B v* on the
  // right-hand side.
  template <int dim>
  void
  PressureSystem<dim>::couple_on_lattice(const double *const own,
                                         const std::uint32_t cell,
                                         const std::uint32_t row,
                                         const double        step)
  {
    const auto   &media = cells.media;
    double *const values =
      equations.values.data() + std::size_t(row) * equations.width;
    double &right = equations.right_side[row];
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const std::uint32_t node = cells.node_of(cell, a);
        const double *const held = &velocity[std::size_t(node) * dim];
        double              scaled[dim];
        for (int d = 0; d < dim; ++d)
          {
            const double entry = own[a * dim + d];
            right -= step * entry * held[d];
            scaled[d] =
              step * step * entry * mobility[std::size_t(node) * dim + d];
          }
        if (to_hold != nullptr && held_as[node] > 0)
          move(node, scaled);
        for (std::size_t l = 0; l < media.size(); ++l)
          for (unsigned int b = 0; b < n_nodes; ++b)
            {
              const std::uint32_t other = media[l].cells_around(node)[b];
              if (other == 0)
                continue;
              const double *const mate = media[l].record(other - 1);
              const unsigned int  place =
                l * row_width(dim) + place_in_row<dim>(a, b);
              for (int d = 0; d < dim; ++d)
                values[place] += scaled[d] * mate[Record::rows + b * dim + d];
            }
        if (cells.surfaces.any())
          couple_surfaces(node, scaled, row);
      }
  }



  template <int dim>
  double
  PressureSystem<dim>::flux(const std::size_t   number,
                            const std::uint32_t cell) const
  {
    const Medium &medium = cells.media[number];
    double        flux   = 0;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const std::uint32_t node  = cells.node_of(cell, a);
        const double        scale = pattern_scales[number][node];
        if (scale > 0)
          for_each_pattern<dim>(
            parts.grid.geometry[cell],
            [&](const unsigned int pattern, const double weight) {
              double sum = 0;
              for (unsigned int b = 0; b < n_nodes; ++b)
                sum += sign(pattern, b) *
                       medium.result(medium.cells_around(node)[b] -
                                     1)[Result::pressure];
              flux += scale * weight * sign(pattern, a) * sum;
            });
      }
    return flux;
  }



  template class PressureSystem<2>;
  template class PressureSystem<3>;
} // namespace limber
