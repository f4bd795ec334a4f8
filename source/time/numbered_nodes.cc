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
        n_cells_along[d] = lattice.cells[d] << lattice.levels;
        edges[d] = (lattice.upper[d] - lattice.lower[d]) / n_cells_along[d];
        // a cell begins with the node of its own number
        n_nodes[d] = n_cells_along[d] + along - 1;
      }
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



  template <int dim>
  typename NumberedNodes<dim>::HangingVertices
  NumberedNodes<dim>::hanging_vertices() const
  {
    HangingVertices result;
    if (parts.grid.has_levels())
      result.resize(parts.grid.vertices.n());
    for (const HangingNode &vertex : parts.grid.vertices.hanging)
      result[vertex.node] = &vertex;
    return result;
  }



  template <int dim>
  typename NumberedNodes<dim>::CellInLattice
  NumberedNodes<dim>::in_lattice(const std::uint32_t    cell,
                                 const HangingVertices &hanging) const
  {
    const CellGeometry<dim> &geometry = parts.grid.geometry[cell];
    const unsigned int       level    = parts.grid.level_of(cell);
    CellInLattice            result;
    result.coarser = parts.grid.description.levels - level;
    Place place;
    for (int d = 0; d < dim; ++d)
      {
        place[d] = std::lround(
          (geometry.origin[d] - parts.grid.description.lower[d]) / edges[d]);
        if (level > 0)
          result.corners.shared |= (place[d] >> result.coarser & 1) << d;
      }
    result.key = key_of(place, n_cells_along);
    if (!hanging.empty())
      for (unsigned int i = 0; i < geometry.node.size(); ++i)
        if (hanging[geometry.node[i] / NodeLayout<dim>::stride] != nullptr)
          result.corners.hanging |= 1 << i;
    return result;
  }



  template <int dim>
  bool
  NumberedNodes<dim>::update()
  {
    std::vector<std::uint32_t> with_points;
    for (const auto &body : parts.bodies)
      for_each_batch(body->points.view(), [&](const CellBatch &batch) {
        with_points.push_back(batch.cell);
      });
    int differs = cells.empty() || with_points != own_cells;
    if (parallel)
      differs = dealii::Utilities::MPI::max(differs, parts.grid.communicator);
    if (!differs)
      return false;
    own_cells                     = std::move(with_points);
    const HangingVertices hanging = hanging_vertices();
    cells.clear();
    cells.reserve(own_cells.size());
    for (const std::uint32_t cell : own_cells)
      cells.push_back(in_lattice(cell, hanging));
    const std::vector<CellInLattice> own = cells;
    if (parallel)
      unite(cells, parts.grid.communicator);
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    number_nodes();
    find_places();
    find_on_grid(own);
    find_masters(hanging);
    find_owners();
    return true;
  }



  template <int dim>
  void
  NumberedNodes<dim>::number_nodes()
  {
    std::vector<Key> of_cells;
    of_cells.reserve(cells.size() * in_cell);
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        const Place                first   = place_of_cell(c);
        const unsigned int         size    = size_of_cell(c);
        const HangingCorners<dim> &corners = hanging_corners(c);
        for (unsigned int i = 0; i < in_cell; ++i)
          {
            Place        place = first;
            unsigned int rest  = i;
            for (int d = 0; d < dim; ++d, rest /= along)
              {
                place[d] += rest % along * size;
                // from the middle of an edge or face to the parent's corner
                if (corners.hangs(i) && ((i ^ corners.shared) >> d & 1) != 0)
                  place[d] += rest % along == 1 ? size : -size;
              }
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



  // Nodes on this rank's grid but for the masters of hanging vertices. @p own:
  // places of the cells of this rank.
  template <int dim>
  void
  NumberedNodes<dim>::find_on_grid(const std::vector<CellInLattice> &own)
  {
    local.assign(keys.size(), invalid_cell);
    index_of_local.assign(parts.grid.n_cells(), invalid_cell);
    with_basis(parts.nodes.view(), [&](const auto basis) {
      using Basis = std::decay_t<decltype(basis)>;
      for (std::size_t k = 0; k < own.size(); ++k)
        {
          const std::uint32_t cell = own_cells[k];
          index_of_local[cell] =
            std::lower_bound(cells.begin(), cells.end(), own[k]) -
            cells.begin();
          const Numbers of_this = numbers_in(cell);
          const auto   &node = Basis::nodes_of(parts.nodes.view(), cell).node;
          for (unsigned int i = 0; i < in_cell; ++i)
            if (!own[k].corners.hangs(i))
              local[of_this[i]] = node[i] / NodeLayout<dim>::stride;
        }
    });
  }



  // Of the masters of a hanging corner the node in its place is the one that is
  // not in the place of another corner; in a face these come after its edges.
  template <int dim>
  void
  NumberedNodes<dim>::find_masters(const HangingVertices &hanging)
  {
    if (hanging.empty())
      return;
    for (const std::uint32_t cell : own_cells)
      {
        const HangingCorners<dim> &corners = hanging_corners(number_of(cell));
        const Numbers              of_this = numbers_in(cell);
        const auto                &node    = parts.grid.geometry[cell].node;
        corners.for_each_hanging([&](const unsigned int i) {
          const HangingNode &vertex =
            *hanging[node[i] / NodeLayout<dim>::stride];
          for (const auto &[master, weight] : vertex.masters)
            {
              bool is_of_other = false;
              corners.for_each_other_master(i, [&](const unsigned int j) {
                is_of_other |= local[of_this[j]] == master;
              });
              if (!is_of_other)
                local[of_this[i]] = master;
            }
        });
      }
  }



  template <int dim>
  void
  NumberedNodes<dim>::find_owners()
  {
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
    const unsigned int place = place_of_cell(cell)[direction];
    return {
      {place == 0, place + size_of_cell(cell) == n_cells_along[direction]}};
  }



  // The cell with points of that lower corner and size, if there is one
  template <int dim>
  std::optional<std::size_t>
  NumberedNodes<dim>::find(const Place &place, const unsigned int coarser) const
  {
    CellInLattice sought;
    sought.key       = key_of(place, n_cells_along);
    const auto found = std::lower_bound(cells.begin(), cells.end(), sought);
    if (found == cells.end() || !(*found == sought) ||
        found->coarser != coarser)
      return {};
    return found - cells.begin();
  }



  template <int dim>
  typename NumberedNodes<dim>::Neighbours
  NumberedNodes<dim>::neighbours(const std::size_t  cell,
                                 const unsigned int direction,
                                 const int          step) const
  {
    if (at_sides(cell, direction)[step > 0])
      return {{}, false};
    const unsigned int coarser = cells[cell].coarser, size = size_of_cell(cell);
    Place              place = place_of_cell(cell);
    place[direction] += step * int(size);
    if (const auto alike = find(place, coarser))
      return {{*alike}, false};
    Place of_larger = place;
    for (unsigned int &along_axis : of_larger)
      along_axis -= along_axis % (2 * size);
    if (const auto larger = find(of_larger, coarser + 1))
      return {{*larger}, false};
    Neighbours result{{}, true};
    if (size == 1)
      return result;
    if (step < 0)
      place[direction] += size / 2;
    constexpr unsigned int n_in_face = 1 << (dim - 1);
    for (unsigned int k = 0; k < n_in_face; ++k)
      {
        Place of_smaller = place;
        for (unsigned int d = 0, bit = 0; d < dim; ++d)
          if (d != direction)
            of_smaller[d] += (k >> bit++ & 1) * size / 2;
        if (const auto smaller = find(of_smaller, coarser - 1))
          result.cells.push_back(*smaller);
      }
    result.any_is_empty = result.cells.size() < n_in_face;
    return result;
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
