// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/mean_gradients.h>
#include <limber/time/implicit_pressure.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Residual in the volume of a cell over this volume
    constexpr double accuracy = 1e-10;

    // Nodes may hold so much more than there is room for.
    constexpr double excess_allowed = 0.02;

    // Cells around the material that have equations too, so that the same
    // serve for some steps
    constexpr int margin = 3;



    /** The signs of places around a node multiplied over the directions in
     * @p pattern. */
    double
    sign(const unsigned int pattern, const unsigned int place)
    {
      return __builtin_parity(pattern & place) ? -1. : 1.;
    }



    /**
     * Call work(pattern, weight) for the sets of two and more directions in
     * which a pattern alternates. With the weights sum_d 1/h_d^2 over these
     * directions d all of them together are the difference between the compact
     * Laplacian of a cell's 2 dim neighbours and the wide one.
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



    /** The place of the second cell around the first one, which share a node:
     * corner a of the first and corner b of the second. */
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
  ImplicitPressure<dim>::ImplicitPressure(const RunParts<dim>     &parts,
                                          BoundaryConditions<dim> &boundaries)
    : parts(parts)
    , boundaries(boundaries)
    , solver(parts.grid.communicator)
  {
    reinit();
  }



  template <int dim>
  void
  ImplicitPressure<dim>::reinit()
  {
    shared_cells.emplace(parts.grid.shared_cells);
    liquids.clear();
    for (auto &body : parts.bodies)
      if (body->implicit)
        {
          Liquid liquid;
          liquid.body = body.get();
          liquid.records.reinit(std::size_t(parts.grid.n_cells()) *
                                Record::stride);
          liquid.around.reinit(std::size_t(parts.nodes.table.n()) * n_nodes);
          liquid.results.reinit(std::size_t(parts.grid.n_cells()) *
                                Result::stride);
          liquids.push_back(std::move(liquid));
        }
    mobility.reinit(std::size_t(parts.nodes.table.n()) * dim);
    velocity.reinit(std::size_t(parts.nodes.table.n()) * dim);
    force.reinit(std::size_t(parts.nodes.table.n()) * dim);
    has_cells = false;
  }



  template <int dim>
  double
  ImplicitPressure<dim>::time_of_sound() const
  {
    double fastest_squared = 0;
    for (const Liquid &liquid : liquids)
      {
        const StressUpdate<dim> &law = *liquid.body->stress;
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
    share_of_pace = share;
    if (!has_cells || !knows_all_cells())
      choose_cells();
    for (Liquid &liquid : liquids)
      {
        gather(liquid);
        exchange(liquid);
        look_around(liquid);
      }
    if (!has_cells)
      find_columns();
    hold_nodes(end);
    assemble(step);
    const double       volume = scale();
    const unsigned int iterations =
      solver.solve(equations, accuracy * volume, pressures);
    for (std::uint32_t row = 0; row < equations.n; ++row)
      pressures[row] *= scales[row];
    ++spent.steps;
    spent.iterations += iterations;
    spent.most_iterations = std::max(spent.most_iterations, iterations);

    for (Liquid &liquid : liquids)
      keep_result(liquid, step);
    push_nodes(step);
  }



  // Whether all cells that hold something have equations, on all ranks.
  template <int dim>
  bool
  ImplicitPressure<dim>::knows_all_cells() const
  {
    int known = 1;
    for (const Liquid &liquid : liquids)
      {
        const CellSums<dim> sums = liquid.body->cell_sums->view();
        for (const std::uint32_t cell : parts.nodes.owned_occupied_cells())
          if (sums.present_mass(cell) > 0 &&
              !(record(liquid, cell)[Record::number] > 0))
            known = 0;
      }
    return dealii::Utilities::MPI::min(known, parts.grid.communicator) > 0;
  }



  template <int dim>
  void
  ImplicitPressure<dim>::choose_cells()
  {
    has_cells   = false;
    equations.n = 0;
    for (Liquid &liquid : liquids)
      {
        for (const std::uint32_t cell : liquid.cells)
          record(liquid, cell)[Record::number] = 0;
        liquid.cells.clear();
        const CellSums<dim> sums = liquid.body->cell_sums->view();
        for (const auto *const occupied : {&parts.nodes.owned_occupied_cells(),
                                           &parts.nodes.ghost_occupied_cells()})
          for (const std::uint32_t cell : *occupied)
            if (sums.present_mass(cell) > 0)
              for_each_near(cell, margin, [&](unsigned int, const auto near) {
                if (near < parts.grid.n_owned_cells() &&
                    !(record(liquid, near)[Record::number] > 0))
                  {
                    record(liquid, near)[Record::number] = 1;
                    liquid.cells.push_back(near);
                  }
              });
        std::sort(liquid.cells.begin(), liquid.cells.end());
        liquid.first = equations.n;
        equations.n += liquid.cells.size();
      }

    const MPI_Comm communicator = parts.grid.communicator;
    MPI_Exscan(
      &equations.n, &equations.first, 1, MPI_UINT32_T, MPI_SUM, communicator);
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      equations.first = 0; // which MPI leaves undefined
    equations.n_all = dealii::Utilities::MPI::sum(equations.n, communicator);
    for (Liquid &liquid : liquids)
      for (std::size_t k = 0; k < liquid.cells.size(); ++k)
        record(liquid, liquid.cells[k])[Record::number] =
          1. + equations.first + liquid.first + k;
  }



  /** Call work(place, cell) for the cells at most @p n away, known here. */
  template <int dim>
  template <class Work>
  void
  ImplicitPressure<dim>::for_each_near(const std::uint32_t cell,
                                       const int           n,
                                       const Work         &work) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    const unsigned int       width    = 2 * n + 1,
                       all = dim == 2 ? width * width : width * width * width;
    for (unsigned int place = 0; place < all; ++place)
      {
        std::array<double, dim> x;
        for (unsigned int d = 0, rest = place; d < dim; ++d, rest /= width)
          x[d] = geometry.origin[d] +
                 (0.5 + int(rest % width) - n) / geometry.inverse_edge[d];
        if (const auto near = parts.grid.bins.cell_at(x); near != invalid_cell)
          work(place, near);
      }
  }



  template <int dim>
  void
  ImplicitPressure<dim>::find_columns()
  {
    equations.width        = row_width(dim) * liquids.size();
    const std::size_t size = std::size_t(equations.n) * equations.width;
    equations.columns.assign(size, PressureEquations::no_column);
    mates.assign(size, invalid_cell);
    for (const Liquid &liquid : liquids)
      for (std::size_t k = 0; k < liquid.cells.size(); ++k)
        for_each_near(liquid.cells[k],
                      1,
                      [&](const unsigned int place, const auto near) {
                        for (std::size_t l = 0; l < liquids.size(); ++l)
                          if (const double number =
                                record(liquids[l], near)[Record::number];
                              number > 0)
                            {
                              const std::size_t at =
                                (liquid.first + k) * equations.width +
                                l * row_width(dim) + place;
                              equations.columns[at] = number - 1;
                              mates[at]             = near;
                            }
                      });
    solver.set_pattern(equations);
    has_cells = true;
  }



  // What the cells of this rank hold, which know the points of all ranks, and
  // what each rank knows of the pressure of its points.
  template <int dim>
  void
  ImplicitPressure<dim>::gather(Liquid &liquid)
  {
    for (const auto &neighbour : parts.grid.shared_cells.neighbours)
      for (const std::uint32_t cell : neighbour.records)
        if (cell >= parts.grid.n_owned_cells())
          std::fill_n(record(liquid, cell), Record::stride, 0.);

    const CellSums<dim> sums            = liquid.body->cell_sums->view();
    const double        inverse_density = 1 / liquid.body->stress->density();
    for (const std::uint32_t cell : liquid.cells)
      {
        double *const of_cell = record(liquid, cell);
        const double  mass    = sums.present_mass(cell);
        of_cell[Record::mass] = mass;
        std::fill(of_cell + Record::moment, of_cell + Record::stride, 0.);
        if (!(mass > 0))
          continue;
        const auto gradients =
          mean_gradients<dim>(parts.grid.geometry[cell],
                              CellMeans<Linear<dim>>(&sums, cell));
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (int d = 0; d < dim; ++d)
            of_cell[Record::rows + a * dim + d] =
              mass * inverse_density * gradients[a][d];
      }

    const PointView<dim> points = liquid.body->points.view();
    for (std::size_t p = 0; p < points.size; ++p)
      record(liquid, points.cell[p])[Record::moment] +=
        points.mass[p] * points.pressure[p];
  }



  template <int dim>
  void
  ImplicitPressure<dim>::exchange(Liquid &liquid)
  {
    records_exchange.start(*shared_cells,
                           liquid.records.data(),
                           0,
                           Record::stride);
    records_exchange.finish(liquid.records.data());
  }



  // Of nodes at a cell of this rank all cells around are known here.
  template <int dim>
  void
  ImplicitPressure<dim>::look_around(Liquid &liquid)
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      std::fill_n(liquid.around.data() + std::size_t(node) * n_nodes,
                  n_nodes,
                  0);
    const auto enter = [&](const std::uint32_t cell) {
      if (record(liquid, cell)[Record::mass] > 0)
        for (unsigned int a = 0; a < n_nodes; ++a)
          liquid.around[std::size_t(node_of(cell, a)) * n_nodes + a] = cell + 1;
    };
    std::for_each(liquid.cells.begin(), liquid.cells.end(), enter);
    for (const auto &neighbour : parts.grid.shared_cells.neighbours)
      std::for_each(neighbour.records.begin(), neighbour.records.end(), enter);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::hold_nodes(const double end)
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
    boundaries.for_each_held(parts.nodes,
                             end,
                             [&](const std::uint32_t node,
                                 const unsigned int  d,
                                 const double        value) {
                               mobility[std::size_t(node) * dim + d] = 0;
                               velocity[std::size_t(node) * dim + d] = value;
                             });
  }



  template <int dim>
  bool
  ImplicitPressure<dim>::is_inside(const Liquid       &liquid,
                                   const std::uint32_t node) const
  {
    const std::uint32_t *const cells = around(liquid, node);
    return std::all_of(cells, cells + n_nodes, [](const std::uint32_t cell) {
      return cell > 0;
    });
  }



  // dt^2 <M> / (rho_0^2 4^(dim - 1)) of a node that is inside.
  template <int dim>
  double
  ImplicitPressure<dim>::pattern_scale(const Liquid       &liquid,
                                       const std::uint32_t node,
                                       const double        step) const
  {
    constexpr double all  = dim == 2 ? 4 : 16;
    double           mass = 0;
    for (unsigned int k = 0; k < n_nodes; ++k)
      mass += record(liquid, around(liquid, node)[k] - 1)[Record::mass];
    const double density = liquid.body->stress->density();
    return step * step * mass / n_nodes / (density * density * all);
  }



  // By how much of its room a node holds more than it may, at @p density now.
  template <int dim>
  double
  ImplicitPressure<dim>::excess(const std::uint32_t cell,
                                const std::uint32_t node,
                                const double        density) const
  {
    double room = 1;
    for (int d = 0; d < dim; ++d)
      room /= parts.grid.geometry[cell].inverse_edge[d];
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (parts.nodes.table.sides[node] >> side & 1)
        room *= 0.5;
    const double held = parts.nodes.record(node)[Layout::mass] / density;
    return std::max(0., held / room - 1 - excess_allowed);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::assemble(const double step)
  {
    equations.values.assign(equations.columns.size(), 0.);
    equations.right_side.assign(equations.n, 0.);
    former.assign(equations.n, {});
    growth.assign(equations.n, 0.);
    for (std::size_t l = 0; l < liquids.size(); ++l)
      for (std::size_t k = 0; k < liquids[l].cells.size(); ++k)
        assemble_row(l, liquids[l].cells[k], liquids[l].first + k, step);
  }



  // Rows and columns such that the diagonal is one, which makes the equations
  // of cells that hold little as large as others; and the pressures that points
  // bring, with which to start. Returns the size of the right side if all
  // volumes were to change by one.
  template <int dim>
  double
  ImplicitPressure<dim>::scale()
  {
    pressures.assign(equations.n, 0.);
    scales.assign(equations.n, 0.);
    double squares = 0;
    for (std::size_t l = 0; l < liquids.size(); ++l)
      {
        Liquid &liquid = liquids[l];
        for (std::size_t k = 0; k < liquid.cells.size(); ++k)
          {
            const std::uint32_t row = liquid.first + k;
            double             &diagonal =
              equations.values[std::size_t(row) * equations.width +
                               l * row_width(dim) + place_in_row<dim>(0, 0)];
            const double *const of_cell = record(liquid, liquid.cells[k]);
            if (!(of_cell[Record::mass] > 0))
              diagonal = 1;
            scales[row] = 1 / std::sqrt(diagonal);
            result(liquid, liquid.cells[k])[Result::scale] = scales[row];
            equations.right_side[row] *= scales[row];
            if (!(of_cell[Record::mass] > 0))
              continue;
            pressures[row] =
              of_cell[Record::moment] / of_cell[Record::mass] / scales[row];
            const double volume = of_cell[Record::mass] /
                                  liquid.body->stress->density() * scales[row];
            squares += volume * volume;
          }
        share(liquid, Result::scale);
      }
    for (std::uint32_t row = 0; row < equations.n; ++row)
      for (unsigned int place = 0; place < equations.width; ++place)
        if (const std::size_t at = std::size_t(row) * equations.width + place;
            mates[at] != invalid_cell)
          equations.values[at] *=
            scales[row] *
            result(liquids[place / row_width(dim)], mates[at])[Result::scale];
    return std::sqrt(
      dealii::Utilities::MPI::sum(squares, parts.grid.communicator));
  }



  template <int dim>
  void
  ImplicitPressure<dim>::assemble_row(const std::size_t   number,
                                      const std::uint32_t cell,
                                      const std::uint32_t row,
                                      const double        step)
  {
    const Liquid &liquid = liquids[number];
    if (!(record(liquid, cell)[Record::mass] > 0))
      return;
    const StressUpdate<dim> &law     = *liquid.body->stress;
    const double             density = law.density();
    const double *const      own     = record(liquid, cell);
    const double             volume  = own[Record::mass] / density;
    const double      gamma  = liquid.body->description.chequerboard_control;
    const std::size_t begin  = std::size_t(row) * equations.width;
    double *const     values = equations.values.data() + begin;
    constexpr unsigned int in_body = row_width(dim);
    double                &right   = equations.right_side[row];
    const double           control = liquid.body->description.density_control;

    const CellSums<dim> sums = liquid.body->cell_sums->view();
    const double        J =
      sums.now[std::size_t(cell) * sums.stride + sums.volumetric()] /
      own[Record::mass];
    const auto response = law.volumetric_response(J);
    former[row]         = {response.pressure, volume / response.stiffness};
    right               = volume * (response.pressure / response.stiffness);

    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const std::uint32_t node = node_of(cell, a);
        const double *const held = &velocity[std::size_t(node) * dim];
        double              scaled[dim];
        for (int d = 0; d < dim; ++d)
          {
            const double entry = own[Record::rows + a * dim + d];
            right -= step * entry * held[d];
            scaled[d] =
              step * step * entry * mobility[std::size_t(node) * dim + d];
          }
        if (control > 0)
          growth[row] +=
            share_of_pace * control / n_nodes * excess(cell, node, density / J);

        for (std::size_t l = 0; l < liquids.size(); ++l)
          for (unsigned int b = 0; b < n_nodes; ++b)
            {
              const std::uint32_t other = around(liquids[l], node)[b];
              if (other == 0)
                continue;
              const double *const mate  = record(liquids[l], other - 1);
              const unsigned int  place = l * in_body + place_in_row<dim>(a, b);
              for (int d = 0; d < dim; ++d)
                values[place] += scaled[d] * mate[Record::rows + b * dim + d];
            }
        if (gamma > 0 && is_inside(liquid, node))
          {
            const double scale = gamma * pattern_scale(liquid, node, step);
            for_each_pattern<dim>(
              parts.grid.geometry[cell],
              [&](const unsigned int pattern, const double weight) {
                for (unsigned int b = 0; b < n_nodes; ++b)
                  values[number * in_body + place_in_row<dim>(a, b)] +=
                    scale * weight * sign(pattern, a) * sign(pattern, b);
              });
          }
      }
    right += volume * growth[row];
    values[number * in_body + place_in_row<dim>(0, 0)] +=
      former[row].compliance;
  }



  // From the owners of cells to all who hold them.
  template <int dim>
  void
  ImplicitPressure<dim>::share(Liquid &liquid, const unsigned int slot)
  {
    for (const auto &neighbour : parts.grid.shared_cells.neighbours)
      for (const std::uint32_t cell : neighbour.records)
        if (cell >= parts.grid.n_owned_cells() ||
            !(record(liquid, cell)[Record::number] > 0))
          result(liquid, cell)[slot] = 0;
    result_exchange.start(*shared_cells, liquid.results.data(), slot, slot + 1);
    result_exchange.finish(liquid.results.data());
  }



  // For the sweep that strains the points, in all cells where they may be.
  template <int dim>
  void
  ImplicitPressure<dim>::keep_result(Liquid &liquid, const double step)
  {
    for (std::size_t k = 0; k < liquid.cells.size(); ++k)
      result(liquid, liquid.cells[k])[Result::pressure] =
        pressures[liquid.first + k];
    share(liquid, Result::pressure);

    const double gamma   = liquid.body->description.chequerboard_control;
    const double density = liquid.body->stress->density();
    double       lost    = 0;
    for (std::size_t k = 0; k < liquid.cells.size(); ++k)
      {
        const std::uint32_t cell = liquid.cells[k];
        const std::uint32_t row  = liquid.first + k;
        const double volume      = record(liquid, cell)[Record::mass] / density;
        if (!(volume > 0))
          continue;
        double flux = 0; // gamma T P
        if (gamma > 0)
          for (unsigned int a = 0; a < n_nodes; ++a)
            if (const std::uint32_t node = node_of(cell, a);
                is_inside(liquid, node))
              {
                const double scale = gamma * pattern_scale(liquid, node, step);
                for_each_pattern<dim>(
                  parts.grid.geometry[cell],
                  [&](const unsigned int pattern, const double weight) {
                    double sum = 0;
                    for (unsigned int b = 0; b < n_nodes; ++b)
                      sum += sign(pattern, b) * result(liquid,
                                                       around(liquid, node)[b] -
                                                         1)[Result::pressure];
                    flux += scale * weight * sign(pattern, a) * sum;
                  });
              }
        result(liquid, cell)[Result::dilation] = flux / volume - growth[row];
        const double change = pressures[row] - former[row].pressure;
        lost += 0.5 * former[row].compliance * change * change +
                pressures[row] * (flux - volume * growth[row]);
      }
    share(liquid, Result::dilation);
    parts.ledger.viscous += lost;

    auto      &kept = *liquid.body->implicit;
    const auto keep = [&](const std::uint32_t cell) {
      kept.pressure[cell] = result(liquid, cell)[Result::pressure];
      kept.dilation[cell] = result(liquid, cell)[Result::dilation];
    };
    std::for_each(liquid.cells.begin(), liquid.cells.end(), keep);
    for (const auto &neighbour : parts.grid.shared_cells.neighbours)
      std::for_each(neighbour.records.begin(), neighbour.records.end(), keep);
  }



  template <int dim>
  void
  ImplicitPressure<dim>::push_nodes(const double step)
  {
    NodalFields<dim> &nodes = parts.nodes;
    for (const std::uint32_t node : nodes.active_nodes())
      std::fill_n(nodes.record(node) + Layout::pressure_force, dim, 0.);
    for (const Liquid &liquid : liquids)
      for (std::size_t k = 0; k < liquid.cells.size(); ++k)
        {
          const std::uint32_t cell = liquid.cells[k];
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (int d = 0; d < dim; ++d)
              nodes.record(node_of(cell, a))[Layout::pressure_force + d] +=
                record(liquid, cell)[Record::rows + a * dim + d] *
                pressures[liquid.first + k];
        }
    nodes.start_sum(Layout::pressure_force, Layout::pressure_force + dim);
    nodes.finish_sum();

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



  // Forces do work on what is kinetic with the mean of the velocities before
  // and after the step, see account_loads(); pressures and gravity give it
  // along the way that points go, dt v1. What this is more is lost.
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
          if (mobility[std::size_t(node) * dim + d] > 0)
            {
              const double after  = of_node[Layout::velocity + d];
              const double before = after - of_node[Layout::increment + d];
              const double mean = 0.5 * (before + of_node[velocity_after + d]);
              parts.ledger.viscous += step *
                                      (force[std::size_t(node) * dim + d] +
                                       mass * parts.problem.loads.gravity[d]) *
                                      (after - mean);
            }
      }
  }



  template class ImplicitPressure<2>;
  template class ImplicitPressure<3>;
} // namespace limber
