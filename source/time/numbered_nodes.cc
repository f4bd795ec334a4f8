// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/records_of_ranks.h>
#include <limber/interpolation/basis.h>
#include <limber/points/cell_batch.h>
#include <limber/time/numbered_nodes.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  template <int dim>
  NumberedNodes<dim>::NumberedNodes(const RunParts<dim> &parts)
    : parts(parts)
    , parallel(
        dealii::Utilities::MPI::n_mpi_processes(parts.grid.communicator) > 1)
    , along(parts.problem.grid.kernel == KernelKind::quadratic ? 3 : 2)
    , in_cell(dealii::Utilities::pow(along, dim))
  {
    const auto &lattice = parts.grid.description;
    for (int d = 0; d < dim; ++d)
      {
        edges[d] = (lattice.upper[d] - lattice.lower[d]) / lattice.cells[d];
        n_cells_along[d] = lattice.cells[d];
        // a cell begins with the node of its own number
        n_nodes[d] = lattice.cells[d] + along - 1;
      }
  }



  template <int dim>
  typename NumberedNodes<dim>::Place
  NumberedNodes<dim>::cell_at(const std::uint32_t cell) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    Place                    result;
    for (int d = 0; d < dim; ++d)
      result[d] = std::lround(
        (geometry.origin[d] - parts.grid.description.lower[d]) / edges[d]);
    return result;
  }



  template <int dim>
  typename NumberedNodes<dim>::Key
  NumberedNodes<dim>::key_of(const Place &place, const Place &extent)
  {
    Key result = 0;
    for (int d = dim - 1; d >= 0; --d)
      result = result * extent[d] + place[d];
    return result;
  }



  template <int dim>
  typename NumberedNodes<dim>::Place
  NumberedNodes<dim>::place_of(Key key, const Place &extent)
  {
    Place result;
    for (int d = 0; d < dim; ++d)
      {
        result[d] = key % extent[d];
        key /= extent[d];
      }
    return result;
  }



  // Keys of all ranks, sorted and unique.
  template <int dim>
  std::vector<typename NumberedNodes<dim>::Key>
  NumberedNodes<dim>::united(std::vector<Key> own) const
  {
    if (parallel)
      unite(own, parts.grid.communicator);
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    return own;
  }



  template <int dim>
  bool
  NumberedNodes<dim>::update()
  {
    std::vector<std::uint32_t> cells;
    for (const auto &body : parts.bodies)
      for_each_batch(body->points.view(), [&](const CellBatch &batch) {
        cells.push_back(batch.cell);
      });
    int differs = cell_keys.empty() || cells != own_cells;
    if (parallel)
      differs = dealii::Utilities::MPI::max(differs, parts.grid.communicator);
    if (!differs)
      return false;
    own_cells = std::move(cells);
    std::vector<Key> own;
    own.reserve(own_cells.size());
    for (const std::uint32_t cell : own_cells)
      own.push_back(key_of(cell_at(cell), n_cells_along));
    cell_keys = united(std::move(own));
    number_nodes();
    find_places();
    find_on_grid();
    return true;
  }



  template <int dim>
  void
  NumberedNodes<dim>::number_nodes()
  {
    std::vector<Key> of_cells;
    of_cells.reserve(cell_keys.size() * in_cell);
    for (const Key cell : cell_keys)
      {
        const Place first = place_of(cell, n_cells_along);
        for (unsigned int i = 0; i < in_cell; ++i)
          {
            Place        place = first;
            unsigned int rest  = i;
            for (int d = 0; d < dim; ++d, rest /= along)
              place[d] += rest % along;
            of_cells.push_back(key_of(place, n_nodes));
          }
      }
    keys = of_cells;
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    numbers.clear();
    numbers.reserve(of_cells.size());
    for (const Key key : of_cells)
      numbers.push_back(std::lower_bound(keys.begin(), keys.end(), key) -
                        keys.begin());
  }



  template <int dim>
  void
  NumberedNodes<dim>::find_places()
  {
    of_lattice.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
      {
        const Place place = place_of(keys[i], n_nodes);
        for (int d = 0; d < dim; ++d)
          {
            double steps = place[d];
            if (along == 3) // in a side or in the middle of a cell
              steps = place[d] == 0              ? 0. :
                      place[d] + 1 == n_nodes[d] ? n_cells_along[d] :
                                                   place[d] - 0.5;
            of_lattice[i][d] =
              parts.grid.description.lower[d] + steps * edges[d];
          }
      }
  }



  // Nodes on this rank's grid, and the owners of all
  template <int dim>
  void
  NumberedNodes<dim>::find_on_grid()
  {
    local.assign(keys.size(), invalid_cell);
    index_of_local.assign(parts.grid.n_cells(), invalid_cell);
    with_basis(parts.nodes.view(), [&](const auto basis) {
      using Basis = std::decay_t<decltype(basis)>;
      for (const std::uint32_t cell : own_cells)
        {
          const Key key = key_of(cell_at(cell), n_cells_along);
          index_of_local[cell] =
            std::lower_bound(cell_keys.begin(), cell_keys.end(), key) -
            cell_keys.begin();
          const Numbers of_this = numbers_in(cell);
          const auto   &node = Basis::nodes_of(parts.nodes.view(), cell).node;
          for (unsigned int i = 0; i < in_cell; ++i)
            local[of_this[i]] = node[i] / NodeLayout<dim>::stride;
        }
    });

    this_rank =
      dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator);
    speakers.assign(keys.size(), std::numeric_limits<int>::max());
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (local[i] != invalid_cell)
        speakers[i] = this_rank;
    if (parallel)
      MPI_Allreduce(MPI_IN_PLACE,
                    speakers.data(),
                    speakers.size(),
                    MPI_INT,
                    MPI_MIN,
                    parts.grid.communicator);
  }



  template <int dim>
  std::uint8_t
  NumberedNodes<dim>::sides(const std::size_t number) const
  {
    const Place  place  = place_of(keys[number], n_nodes);
    std::uint8_t result = 0;
    for (int d = 0; d < dim; ++d)
      {
        if (place[d] == 0)
          result |= 1 << (2 * d);
        if (place[d] + 1 == n_nodes[d])
          result |= 1 << (2 * d + 1);
      }
    return result;
  }



  template <int dim>
  std::array<bool, 2>
  NumberedNodes<dim>::at_sides(const std::size_t  cell,
                               const unsigned int direction) const
  {
    const unsigned int place =
      place_of(cell_keys[cell], n_cells_along)[direction];
    return {{place == 0, place + 1 == n_cells_along[direction]}};
  }



  template <int dim>
  typename NumberedNodes<dim>::Neighbour
  NumberedNodes<dim>::neighbour(const std::size_t  cell,
                                const unsigned int direction,
                                const int          step) const
  {
    if (at_sides(cell, direction)[step > 0])
      return {false, {}};
    Place place = place_of(cell_keys[cell], n_cells_along);
    place[direction] += step;
    const Key  key = key_of(place, n_cells_along);
    const auto found =
      std::lower_bound(cell_keys.begin(), cell_keys.end(), key);
    if (found == cell_keys.end() || *found != key)
      return {true, {}};
    return {true, found - cell_keys.begin()};
  }



  // Reduced on one rank and broadcast: MPI_Allreduce may round differently on
  // different ranks.
  template <int dim>
  void
  NumberedNodes<dim>::sum(double *const values, const std::size_t n) const
  {
    if (!parallel)
      return;
    const MPI_Comm communicator = parts.grid.communicator;
    const bool     here =
      dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    MPI_Reduce(here ? MPI_IN_PLACE : values,
               here ? values : nullptr,
               n,
               MPI_DOUBLE,
               MPI_SUM,
               0,
               communicator);
    MPI_Bcast(values, n, MPI_DOUBLE, 0, communicator);
  }



  template class NumberedNodes<2>;
  template class NumberedNodes<3>;
} // namespace limber
