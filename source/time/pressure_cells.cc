// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/mean_gradients.h>
#include <limber/time/pressure_cells.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    // Layers of empty cells around the material that get unknowns too, so that
    // the sparsity pattern serves for some steps
    constexpr int margin = 3;
  } // namespace



  template <int dim>
  PressureCells<dim>::PressureCells(const RunParts<dim> &parts,
                                    CutCells<dim> *const cut_cells)
    : surfaces(parts, cut_cells)
    , parts(parts)
  {
    reinit();
  }



  template <int dim>
  void
  PressureCells<dim>::reinit()
  {
    corners.reinit(parts);
    surfaces.reinit(corners);
    shared_cells.emplace(parts.grid.shared_cells);
    shared_cells->add(corners.far_exchange());
    const std::size_t n_known = parts.grid.n_cells() + corners.n_far_cells();
    media.clear();
    for (auto &body : parts.bodies)
      if (body->implicit)
        {
          body->implicit.emplace(parts.grid.n_cells());
          body->implicit->is_whole = !body->description.is_liquid;
          if (body->description.is_liquid && !media.empty() &&
              media.front().is_liquid())
            {
              media.front().bodies.push_back(body.get());
              continue;
            }
          Medium medium;
          medium.bodies.push_back(body.get());
          medium.records.reinit(n_known * Record::stride);
          medium.around.reinit(std::size_t(parts.nodes.table.n()) * n_nodes);
          medium.results.reinit(n_known * Result::stride);
          media.insert(body->description.is_liquid ? media.begin() :
                                                     media.end(),
                       std::move(medium));
        }
    has_cells = false;
  }



  template <int dim>
  bool
  PressureCells<dim>::update()
  {
    const bool are_new = !has_cells || surfaces.are_old() || !knows_all_cells();
    if (are_new)
      choose_cells();
    has_cells = true;
    for (Medium &medium : media)
      {
        gather(medium);
        exchange(medium);
        look_around(medium);
      }
    if (are_new && !media.empty() && media.front().is_liquid())
      surfaces.number(first + first_of_surfaces());
    return are_new;
  }



  // Whether all occupied cells have unknowns, on all ranks.
  template <int dim>
  bool
  PressureCells<dim>::knows_all_cells() const
  {
    int known = 1;
    for (const Medium &medium : media)
      for (const std::uint32_t cell : parts.nodes.owned_occupied_cells())
        if (medium.is_in(cell) && !(medium.record(cell)[Record::number] > 0))
          known = 0;
    return dealii::Utilities::MPI::min(known, parts.grid.communicator) > 0;
  }



  template <int dim>
  void
  PressureCells<dim>::choose_cells()
  {
    n = 0;
    for (Medium &medium : media)
      {
        for (const std::uint32_t cell : medium.cells)
          medium.record(cell)[Record::number] = 0;
        medium.cells.clear();
        for (const auto *const occupied : {&parts.nodes.owned_occupied_cells(),
                                           &parts.nodes.ghost_occupied_cells()})
          for (const std::uint32_t cell : *occupied)
            if (medium.is_in(cell))
              for_each_near(cell, margin, [&](unsigned int, const auto near) {
                if (near < parts.grid.n_owned_cells() &&
                    !(medium.record(near)[Record::number] > 0))
                  {
                    medium.record(near)[Record::number] = 1;
                    medium.cells.push_back(near);
                  }
              });
        std::sort(medium.cells.begin(), medium.cells.end());
        medium.first = n;
        n += medium.cells.size();
      }
    if (!media.empty() && media.front().is_liquid())
      {
        surfaces.choose([this](const std::uint32_t cell) {
          return media.front().record(cell)[Record::number] > 0;
        });
        n += surfaces.n_of_rank();
      }

    const MPI_Comm communicator = parts.grid.communicator;
    MPI_Exscan(&n, &first, 1, MPI_UINT32_T, MPI_SUM, communicator);
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      first = 0; // which MPI leaves undefined
    n_all = dealii::Utilities::MPI::sum(n, communicator);
    for (Medium &medium : media)
      for (std::size_t k = 0; k < medium.cells.size(); ++k)
        medium.record(medium.cells[k])[Record::number] =
          1. + first + medium.first + k;
  }



  // Cells of other ranks that are received from their owners.
  template <int dim>
  template <class Work>
  void
  PressureCells<dim>::for_each_of_others(const Work &work) const
  {
    for (const std::uint32_t cell : shared_cells->received)
      if (cell >= parts.grid.n_owned_cells())
        work(cell);
  }



  // Records of the cells of this rank, whose sums contain the points of all
  // ranks; and this rank's part of the pressure moments, before exchange().
  template <int dim>
  void
  PressureCells<dim>::gather(Medium &medium)
  {
    for_each_of_others([&](const std::uint32_t cell) {
      std::fill_n(medium.record(cell), Record::stride, 0.);
    });

    for (const std::uint32_t cell : medium.cells)
      {
        double *const of_cell = medium.record(cell);
        std::fill(of_cell + Record::volume, of_cell + Record::stride, 0.);
        double             mass = 0, controlled = 0;
        MaterialBody<dim> *any = nullptr;
        medium.for_each_in(cell, [&](auto &body, const double of_body) {
          const double volume = of_body / body.stress->density();
          any                 = &body;
          mass += of_body;
          of_cell[Record::volume] += volume;
          controlled += body.description.checkerboard_control * volume;
        });
        if (any == nullptr)
          continue;
        if (surfaces.cells() != nullptr && surfaces.cells()->is_covered(cell))
          {
            // material in covered cells has no pressure, or thin remains would
            // lock
            of_cell[Record::volume] = 0;
            continue;
          }
        // volume fraction of all liquids together, see LiquidMeans
        const double filling =
          any->volume_shares.size() > 0 ? any->volume_shares[cell] : 1;
        of_cell[Record::pattern] =
          filling * filling * controlled * of_cell[Record::volume] / mass;
        const CellSums<dim> sums = any->cell_sums->view();
        const auto          gradients =
          mean_gradients<dim>(parts.grid.geometry[cell],
                              CellMeans<Linear<dim>>(&sums, cell));
        for (unsigned int a = 0; a < n_nodes; ++a)
          for (int d = 0; d < dim; ++d)
            of_cell[Record::rows + a * dim + d] =
              filling * of_cell[Record::volume] * gradients[a][d];
      }

    for (const MaterialBody<dim> *const body : medium.bodies)
      {
        const PointView<dim> points          = body->points.view();
        const double         inverse_density = 1 / body->stress->density();
        for (std::size_t p = 0; p < points.size; ++p)
          medium.record(points.cell[p])[Record::moment] +=
            inverse_density * points.mass[p] * points.pressure[p];
      }
  }



  template <int dim>
  void
  PressureCells<dim>::exchange(Medium &medium)
  {
    records_exchange.start(*shared_cells,
                           medium.records.data(),
                           0,
                           Record::stride);
    records_exchange.finish(medium.records.data());
  }



  // The cells of the medium around each node, complete for nodes of cells of
  // this rank.
  template <int dim>
  void
  PressureCells<dim>::look_around(Medium &medium)
  {
    for (const std::uint32_t node : parts.nodes.active_nodes())
      std::fill_n(medium.around.data() + std::size_t(node) * n_nodes,
                  n_nodes,
                  0);
    const auto enter = [&](const std::uint32_t cell) {
      if (medium.record(cell)[Record::volume] > 0)
        for (unsigned int a = 0; a < n_nodes; ++a)
          medium.around[std::size_t(node_of(cell, a)) * n_nodes + a] = cell + 1;
    };
    for_each_known(medium, enter);
  }



  template <int dim>
  void
  PressureCells<dim>::share(Medium &medium, const unsigned int slot)
  {
    for (const std::uint32_t cell : shared_cells->received)
      if (cell >= parts.grid.n_owned_cells() ||
          !(medium.record(cell)[Record::number] > 0))
        medium.result(cell)[slot] = 0;
    result_exchange.start(*shared_cells, medium.results.data(), slot, slot + 1);
    result_exchange.finish(medium.results.data());
  }



  template class PressureCells<2>;
  template class PressureCells<3>;
} // namespace limber
