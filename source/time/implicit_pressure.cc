// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/time/implicit_pressure.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Tolerance: residual in the volume of a cell over this volume
    constexpr double accuracy = 1e-10;

    // Active set of the tension cutoff and of surfaces: rounds in which rows
    // may return; then rows are only removed, so that it terminates.
    constexpr unsigned int most_returns = 20;

    // Rounds in which nodes that an obstacle would pull are released and those
    // that approach it are held again; then at most so many in which they are
    // only released. What still approaches is held in the next step.
    constexpr unsigned int most_changes = 4, most_releases = 6;

    // Rounds in which one-sided sides release nodes that they would have to
    // pull, and further ones in which held nodes and friction are updated.
    constexpr unsigned int most_releases_by_sides = 10, most_more = 10;

    // Largest displacement of density control in a step, in cells along an axis
    constexpr double max_density_displacement = 0.25;
  } // namespace



  template <int dim>
  ImplicitPressure<dim>::ImplicitPressure(const RunParts<dim>     &parts,
                                          BoundaryConditions<dim> &boundaries,
                                          CutCells<dim> *const     cut_cells,
                                          ObstacleContact<dim> *const obstacles)
    : parts(parts)
    , obstacles(obstacles)
    , with_one_sided(boundaries.any_one_sided())
    , cells(parts, cut_cells)
    , system(parts, boundaries, cells)
    , solver(parts.grid.communicator)
  {
    reinit();
  }



  template <int dim>
  void
  ImplicitPressure<dim>::reinit()
  {
    cells.reinit();
    system.reinit();
    force.reinit(std::size_t(parts.nodes.table.n()) * dim);
    way.reinit(std::size_t(parts.nodes.table.n()) * dim);
    has_density_displacement = false;
  }



  template <int dim>
  double
  ImplicitPressure<dim>::time_of_sound() const
  {
    double fastest_squared = 0;
    for (const Medium &medium : cells.media)
      for (const auto *const body : medium.bodies)
        {
          const StressUpdate<dim> &law = *body->stress;
          fastest_squared =
            std::max(fastest_squared,
                     law.volumetric_response(1).stiffness / law.density());
        }
    return parts.grid.smallest_edge / std::sqrt(fastest_squared);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::solve(const double end,
                               const double step,
                               const double share)
  {
    if (cells.update())
      {
        // 1e-14 where moving obstacles leave small-cut cells of a hundredth of
        // the size: with 1e-10 the error there came to 1e-6 of the strain
        // energy
        if (cells.surfaces.cells() && cells.surfaces.cells()->in_motion())
          system.equations.share_of_accuracy = 1e-4;
        system.find_columns();
        solver.set_pattern(system.equations);
      }
    if (obstacles != nullptr)
      meet_obstacles();
    system.weigh(step);
    if (with_one_sided)
      {
        sum_forces(former_pressures(), false);
        system.expect_at_sides(end, step);
      }
    const auto before   = spent.iterations;
    double     residual = solve_equations(end, step, share);
    for (unsigned int k = 1; is_held_otherwise(end, step, k); ++k)
      residual = solve_equations(end, step, share);
    std::vector<double> impulses; // of nodes that obstacles hold
    if (obstacles != nullptr)
      impulses = system.impulses_on_nodes(step);
    sum_forces(system.pressures, false);
    ++spent.steps;
    spent.most_iterations =
      std::max<unsigned int>(spent.most_iterations, spent.iterations - before);

    for (std::size_t l = 0; l < cells.media.size(); ++l)
      keep_result(l);
    push_nodes(step);
    if (obstacles != nullptr)
      press_on_obstacles(step, impulses);
    find_density_displacement(step, residual);
  }



  // Whether the pressures of the k-th solution change the set of nodes held by
  // sides and obstacles, so that the system has to be solved again.
  template <int dim>
  bool
  ImplicitPressure<dim>::is_held_otherwise(const double       end,
                                           const double       step,
                                           const unsigned int k)
  {
    if (obstacles == nullptr && !with_one_sided)
      return false;
    sum_forces(system.pressures, obstacles != nullptr);
    bool result = false;
    if (obstacles != nullptr && k < most_changes + most_releases)
      result |= system.release_nodes(step, k < most_changes);
    if (with_one_sided && k < most_releases_by_sides + most_more)
      result |= system.meet_sides(end, step, k < most_releases_by_sides);
    return result;
  }



  // P0: mean pressures of the points, by rows of cells; not of surfaces.
  template <int dim>
  std::vector<double>
  ImplicitPressure<dim>::former_pressures() const
  {
    std::vector<double> result(cells.n, 0.);
    for (const Medium &medium : cells.media)
      for (std::size_t k = 0; k < medium.cells.size(); ++k)
        if (const double *const of_cell = medium.record(medium.cells[k]);
            of_cell[Record::volume] > 0)
          result[medium.first + k] =
            of_cell[Record::moment] / of_cell[Record::volume];
    return result;
  }



  template <int dim>
  void
  ImplicitPressure<dim>::meet_obstacles()
  {
    auto &surfaces = cells.surfaces;
    surfaces.dry();
    obstacles->for_each_surface(
      [&](const std::uint32_t cell,
          const unsigned int  surface,
          const double        least,
          std::size_t) { surfaces.wet(cell, surface, least); });
    surfaces.finish_wetting();
    system.meet_nodes(&obstacles->held_nodes());
  }



  template <int dim>
  void
  ImplicitPressure<dim>::press_on_obstacles(
    const double               step,
    const std::vector<double> &impulses_on_nodes)
  {
    auto &surfaces = cells.surfaces;
    for (std::uint32_t k = 0; k < surfaces.n_of_rank(); ++k)
      surfaces.pieces[k].pressure =
        system.pressures[cells.first_of_surfaces() + k];
    obstacles->expect_given();
    const auto &nodes = obstacles->held_nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (nodes[k].share > 0)
        obstacles->give(nodes[k].place, nodes[k].share * impulses_on_nodes[k]);
    obstacles->for_each_surface([&](const std::uint32_t cell,
                                    const unsigned int  surface,
                                    double,
                                    const std::size_t number) {
      const auto &piece = surfaces.pieces[surfaces.piece_of(cell, surface)];
      obstacles->give(number,
                      step * piece.pressure * surfaces.area_of(cell, surface));
    });
  }



  template <int dim>
  double
  ImplicitPressure<dim>::solve_equations(const double end,
                                         const double step,
                                         const double share)
  {
    system.assemble(end, step, share);
    const double residual = accuracy * system.scale();
    unsigned int solved   = 0;
    do
      {
        spent.iterations +=
          solver.solve(system.equations, residual, system.pressures);
        ++solved;
      }
    while (system.cuts_tension() && system.cut_tension(solved < most_returns));
    for (std::uint32_t row = 0; row < cells.n; ++row)
      system.pressures[row] *= system.scales[row];
    spent.solutions += solved;
    return residual;
  }



  // Displacement w of the density control, with the active set of this step.
  template <int dim>
  void
  ImplicitPressure<dim>::find_density_displacement(const double step,
                                                   const double residual)
  {
    has_density_displacement = system.set_density_source();
    if (!has_density_displacement)
      return;
    std::vector<double> pressures;
    spent.for_density +=
      solver.solve_again(system.equations, residual, pressures);
    for (std::uint32_t row = 0; row < cells.n; ++row)
      pressures[row] *= system.scales[row];
    sum_forces(pressures, obstacles != nullptr);

    const double longest = max_density_displacement * parts.grid.smallest_edge;
    const NodeTable<dim> &table = parts.nodes.table;
    for (const std::uint32_t node : table.masters)
      std::fill_n(&way[std::size_t(node) * dim], dim, 0.);
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        double *const of_node = &way[std::size_t(node) * dim];
        std::copy_n(parts.nodes.record(node) + Layout::pressure_force,
                    dim,
                    of_node);
        system.push(node, step * step, of_node);
        for (int d = 0; d < dim; ++d)
          of_node[d] = std::min(std::max(of_node[d], -longest), longest);
      }
    table.take_from_masters(way.data(), dim, 0, dim);
  }



  // Elastic energy that a body releases as its part of a cell dilates, J: the
  // integral of J p over ln J, by Gauss quadrature. If J p is linear in J, this
  // is exact with the mean J of the points, however much they differ.
  template <int dim>
  double
  ImplicitPressure<dim>::elastic_work(const MaterialBody<dim> &body,
                                      const Part              &part,
                                      const double             pressure) const
  {
    const double dilation =
      part.compliance * (part.pressure - pressure) / part.volume;
    if (!body.description.is_liquid)
      return 0.5 * (part.pressure + pressure) * part.volume * dilation;
    static const dealii::QGauss<1> rule(3);
    double                         result = 0;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const double growth = 1 + rule.point(q)[0] * dilation;
        result +=
          rule.weight(q) / growth *
          body.stress->volumetric_response(part.volume_ratio * growth).pressure;
      }
    return part.volume * dilation * result;
  }



  // Store pressures for the sweep that strains the points, in all cells known
  // to this rank.
  template <int dim>
  void
  ImplicitPressure<dim>::keep_result(const std::size_t number)
  {
    Medium &medium = cells.media[number];
    for (std::size_t k = 0; k < medium.cells.size(); ++k)
      medium.result(medium.cells[k])[Result::pressure] =
        system.pressures[medium.first + k];
    cells.share(medium, Result::pressure);

    for (auto *const body : medium.bodies)
      {
        const auto keep = [&](const std::uint32_t cell) {
          body->implicit->pressure[cell] =
            medium.result(cell)[Result::pressure];
        };
        cells.for_each_known(medium, keep);
      }
    find_dilations(number);
  }



  // Dilations of bodies in a cell: the whole one for solids, for liquids what
  // is added to the mean divergence of the cell. Liquids that share a pressure
  // dilate according to their stiffness.
  template <int dim>
  void
  ImplicitPressure<dim>::find_dilations(const std::size_t number)
  {
    Medium &medium = cells.media[number];
    double  lost   = 0;
    for (auto *const body : medium.bodies)
      {
        for (std::size_t k = 0; k < medium.cells.size(); ++k)
          {
            const std::uint32_t cell = medium.cells[k];
            const std::uint32_t row  = medium.first + k;
            const double        mass = body->cell_sums->present_mass(cell);
            double             &kept = medium.result(cell)[Result::dilation];
            kept                     = 0;
            const double volume      = medium.record(cell)[Record::volume];
            // tension cutoff: points lose their volumetric strain there
            if (!(mass > 0) || !(volume > 0) ||
                (!system.is_cut.empty() && system.is_cut[row]))
              continue;
            const double pressure = system.pressures[row];
            const Part   part     = system.part_of(medium, *body, cell, mass);
            const double dilation =
              part.compliance * (part.pressure - pressure) / part.volume;
            const double of_cell = system.former[row].compliance *
                                   (system.former[row].pressure - pressure) /
                                   volume;
            const double beyond = system.flux(number, cell) / volume;
            kept                = !medium.is_liquid()       ? dilation :
                                  medium.bodies.size() == 1 ? beyond :
                                                              beyond + dilation - of_cell;
            // less its part of the work of the cell on nodes
            lost += elastic_work(*body, part, pressure) -
                    pressure * part.volume * (of_cell - beyond);
          }
        keep_dilation(medium, *body);
      }
    parts.ledger.lose_by_steps(lost);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::keep_dilation(Medium &medium, MaterialBody<dim> &body)
  {
    cells.share(medium, Result::dilation);
    const auto keep = [&](const std::uint32_t cell) {
      body.implicit->dilation[cell] = medium.result(cell)[Result::dilation];
    };
    cells.for_each_known(medium, keep);
  }



  // Add to the dilations of a body the mean divergence of a nodal field, times
  // a factor.
  template <int dim>
  template <class Field>
  void
  ImplicitPressure<dim>::add_flow_to_dilations(Medium            &medium,
                                               MaterialBody<dim> &body,
                                               const double       factor,
                                               const Field       &field)
  {
    for (const std::uint32_t cell : medium.cells)
      {
        const double *const own      = medium.record(cell);
        double             &dilation = medium.result(cell)[Result::dilation];
        dilation                     = body.implicit->dilation[cell];
        if (!(own[Record::volume] > 0))
          continue;
        double flow = 0;
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (int d = 0; d < dim; ++d)
            flow += own[Record::rows + a * dim + d] *
                    field(cells.node_of(cell, a), d);
        dilation += factor * flow / own[Record::volume];
      }
    keep_dilation(medium, body);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::complete_dilations(const double step)
  {
    const auto velocity = [this](const std::uint32_t node, const int d) {
      return parts.nodes.record(node)[Layout::velocity + d];
    };
    for (Medium &medium : cells.media)
      if (medium.is_liquid())
        for (auto *const body : medium.bodies)
          {
            add_flow_to_dilations(medium, *body, step, velocity);
            body->implicit->is_whole = true;
          }
  }



  template <int dim>
  void
  ImplicitPressure<dim>::correct_density(const double step)
  {
    if (!has_density_displacement)
      return;
    for (const std::uint32_t node : parts.nodes.active_nodes())
      for (int d = 0; d < dim; ++d)
        parts.nodes.record(node)[Layout::velocity + d] +=
          density_displacement(node, d) / step;
    const auto of_node = [this](const std::uint32_t node, const int d) {
      return density_displacement(node, d);
    };
    for (Medium &medium : cells.media)
      for (auto *const body : medium.bodies)
        if (!body->implicit->is_whole)
          add_flow_to_dilations(medium, *body, -1, of_node);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::sum_forces(const std::vector<double> &pressures,
                                    const bool                 with_surfaces)
  {
    NodalFields<dim> &nodes = parts.nodes;
    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(nodes.record(node) + Layout::pressure_force, dim, 0.);
    for (const Medium &medium : cells.media)
      for (std::size_t k = 0; k < medium.cells.size(); ++k)
        {
          const std::uint32_t cell = medium.cells[k];
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (int d = 0; d < dim; ++d)
              nodes.record(
                cells.node_of(cell, a))[Layout::pressure_force + d] +=
                medium.record(cell)[Record::rows + a * dim + d] *
                pressures[medium.first + k];
        }
    if (with_surfaces)
      for (std::uint32_t k = 0; k < cells.surfaces.n_of_rank(); ++k)
        {
          const auto  &piece = cells.surfaces.pieces[k];
          const double q     = pressures[cells.first_of_surfaces() + k];
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (int d = 0; d < dim; ++d)
              nodes.record(
                cells.node_of(piece.cell, a))[Layout::pressure_force + d] +=
                piece.entries[a * dim + d] * q;
        }
    nodes.start_sum(Layout::pressure_force, Layout::pressure_force + dim);
    nodes.finish_sum();
  }



  template <int dim>
  void
  ImplicitPressure<dim>::push_nodes(const double step)
  {
    NodalFields<dim> &nodes = parts.nodes;
    for (const std::uint32_t node : nodes.active_nodes())
      {
        double *const of_node = nodes.record(node);
        const double  mass    = of_node[Layout::mass];
        if (!(mass > 0))
          continue;
        for (int d = 0; d < dim; ++d)
          {
            force[std::size_t(node) * dim + d] =
              of_node[Layout::pressure_force + d];
            const double change =
              step * of_node[Layout::pressure_force + d] / mass;
            of_node[Layout::increment + d] += change;
            of_node[Layout::velocity + d] += change;
          }
      }
  }



  // Forces change the kinetic energy by their work on the mean of the
  // velocities before and after the step, see account_loads(); the energies of
  // pressures and gravity change by the work along the displacement of points,
  // dt v1. The difference is lost. What levels weights takes no energy from
  // that of gravity.
  template <int dim>
  void
  ImplicitPressure<dim>::account(const double       step,
                                 const unsigned int velocity_after)
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      {
        const double *const of_node = parts.nodes.record(node);
        const double        mass    = of_node[Layout::mass];
        if (!parts.nodes.owns(node) || !(mass > 0))
          continue;
        for (int d = 0; d < dim; ++d)
          if (system.mobility_of(node, d) > 0)
            {
              const double after  = of_node[Layout::velocity + d];
              const double before = after - of_node[Layout::increment + d];
              const double mean = 0.5 * (before + of_node[velocity_after + d]);
              parts.ledger.lose_by_steps(
                step *
                (force[std::size_t(node) * dim + d] +
                 mass * parts.problem.loads.gravity[d]) *
                (after - mean));
              parts.ledger.history -= step * system.missing_mass_of(node) *
                                      parts.problem.loads.gravity[d] * mean;
            }
      }
  }



  template class ImplicitPressure<2>;
  template class ImplicitPressure<3>;
} // namespace limber
