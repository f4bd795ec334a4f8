// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/records_of_ranks.h>
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
  {
    const auto &lattice = parts.grid.description;
    Key         stride  = 1;
    for (int d = 0; d < dim; ++d)
      {
        edges[d]   = (lattice.upper[d] - lattice.lower[d]) / lattice.cells[d];
        strides[d] = stride;
        stride *= Key(lattice.cells[d]) + 1;
      }
  }



  template <int dim>
  typename NumberedNodes<dim>::Key
  NumberedNodes<dim>::key_of(const std::uint32_t cell,
                             const unsigned int  corner) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    Key                      result   = 0;
    for (int d = 0; d < dim; ++d)
      result +=
        strides[d] *
        Key(std::lround((geometry.origin[d] - parts.grid.description.lower[d]) /
                        edges[d]) +
            (corner >> d & 1));
    return result;
  }



  template <int dim>
  std::array<unsigned int, dim>
  NumberedNodes<dim>::place_in_lattice(Key key) const
  {
    std::array<unsigned int, dim> result;
    for (int d = dim - 1; d >= 0; --d)
      {
        result[d] = key / strides[d];
        key %= strides[d];
      }
    return result;
  }



  // Those of all ranks, each once, sorted.
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
  std::uint32_t
  NumberedNodes<dim>::number_of(const Key key) const
  {
    const auto found = std::lower_bound(keys.begin(), keys.end(), key);
    return found != keys.end() && *found == key ? found - keys.begin() :
                                                  invalid_cell;
  }



  template <int dim>
  void
  NumberedNodes<dim>::update()
  {
    constexpr unsigned int     n = 1 << dim;
    std::vector<std::uint32_t> own_cells;
    std::vector<Key>           own;
    for (const auto &body : parts.bodies)
      for_each_batch(body->points.view(), [&](const CellBatch &batch) {
        own_cells.push_back(batch.cell);
        own.push_back(key_of(batch.cell, 0));
      });
    cell_keys = united(std::move(own));

    std::vector<Key> of_corners;
    const auto       corner_of = [&](const Key cell, const unsigned int i) {
      Key result = cell;
      for (int d = 0; d < dim; ++d)
        result += (i >> d & 1) * strides[d];
      return result;
    };
    for (const Key cell : cell_keys)
      for (unsigned int i = 0; i < n; ++i)
        of_corners.push_back(corner_of(cell, i));
    std::sort(of_corners.begin(), of_corners.end());
    of_corners.erase(std::unique(of_corners.begin(), of_corners.end()),
                     of_corners.end());
    keys = std::move(of_corners);

    corners.resize(cell_keys.size());
    for (std::size_t c = 0; c < cell_keys.size(); ++c)
      for (unsigned int i = 0; i < n; ++i)
        corners[c][i] = number_of(corner_of(cell_keys[c], i));

    of_lattice.resize(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
      {
        const auto place = place_in_lattice(keys[i]);
        for (int d = 0; d < dim; ++d)
          of_lattice[i][d] =
            parts.grid.description.lower[d] + place[d] * edges[d];
      }

    local.assign(keys.size(), invalid_cell);
    number_of_local.assign(parts.nodes.table.n(), invalid_cell);
    for (const std::uint32_t cell : own_cells)
      for (unsigned int i = 0; i < n; ++i)
        {
          const std::uint32_t number = number_of(key_of(cell, i));
          const std::uint32_t node =
            parts.grid.geometry[cell].node[i] / NodeLayout<dim>::stride;
          local[number]         = node;
          number_of_local[node] = number;
        }

    const int rank =
      dealii::Utilities::MPI::this_mpi_process(parts.grid.communicator);
    speakers.assign(keys.size(), std::numeric_limits<int>::max());
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (local[i] != invalid_cell)
        speakers[i] = rank;
    if (parallel)
      MPI_Allreduce(MPI_IN_PLACE,
                    speakers.data(),
                    speakers.size(),
                    MPI_INT,
                    MPI_MIN,
                    parts.grid.communicator);
    this_rank = rank;
  }



  template <int dim>
  std::uint8_t
  NumberedNodes<dim>::sides(const std::size_t number) const
  {
    const auto   place  = place_in_lattice(keys[number]);
    std::uint8_t result = 0;
    for (int d = 0; d < dim; ++d)
      {
        if (place[d] == 0)
          result |= 1 << (2 * d);
        if (place[d] == parts.grid.description.cells[d])
          result |= 1 << (2 * d + 1);
      }
    return result;
  }



  template <int dim>
  typename NumberedNodes<dim>::Corners
  NumberedNodes<dim>::numbers_in(const std::uint32_t cell) const
  {
    Corners result;
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] = number_of_local[parts.grid.geometry[cell].node[i] /
                                  NodeLayout<dim>::stride];
    return result;
  }



  template <int dim>
  typename NumberedNodes<dim>::Neighbour
  NumberedNodes<dim>::neighbour(const std::size_t  cell,
                                const unsigned int direction,
                                const int          step) const
  {
    const int place = int(place_in_lattice(cell_keys[cell])[direction]) + step;
    if (place < 0 || place >= int(parts.grid.description.cells[direction]))
      return {false, {}};
    const Key  key = cell_keys[cell] + step * std::int64_t(strides[direction]);
    const auto found =
      std::lower_bound(cell_keys.begin(), cell_keys.end(), key);
    if (found == cell_keys.end() || *found != key)
      return {true, {}};
    return {true, found - cell_keys.begin()};
  }



  // On one rank, and handed out: MPI_Allreduce may round differently here and
  // there.
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
