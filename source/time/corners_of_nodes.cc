// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/time/corners_of_nodes.h>

#include <algorithm>
#include <map>

namespace limber
{
  namespace
  {
    constexpr std::uint32_t unknown = invalid_cell;



    /** Index in the list shared with a neighbour, by local number. */
    std::map<std::uint32_t, std::uint32_t>
    places_of(const std::vector<std::uint32_t> &records)
    {
      std::map<std::uint32_t, std::uint32_t> places;
      for (std::uint32_t k = 0; k < records.size(); ++k)
        places[records[k]] = k;
      return places;
    }



    /** The records that this rank shares with another one. */
    const std::vector<std::uint32_t> &
    shared_with(const SharedRecords &shared, const unsigned int rank)
    {
      static const std::vector<std::uint32_t> none;
      for (const auto &neighbour : shared.neighbours)
        if (neighbour.rank == rank)
          return neighbour.records;
      return none;
    }
  } // namespace



  template <int dim>
  void
  CornersOfNodes<dim>::reinit(const RunParts<dim> &parts)
  {
    const NodeTable<dim> &table = parts.nodes.table;
    corners.clear();
    neighbours.clear();
    far_cells = 0;
    first.assign(table.n() + 1, 0);
    hanging.assign(table.n(), nullptr);
    const int any = !table.hanging.empty();
    has_hanging   = dealii::Utilities::MPI::max(any, parts.grid.communicator);
    if (!has_hanging)
      return;
    for (const HangingNode &node : table.hanging)
      hanging[node.node] = &node;

    Followers followers = find_own(parts);
    add_those_of_others(parts, followers);
    sort(followers);
  }



  // The corners of the cells of this rank, with the nodes that they follow.
  template <int dim>
  typename CornersOfNodes<dim>::Followers
  CornersOfNodes<dim>::find_own(const RunParts<dim> &parts) const
  {
    Followers followers;
    for (std::uint32_t cell = 0; cell < parts.grid.n_owned_cells(); ++cell)
      {
        const CellGeometry<dim> &geometry     = parts.grid.geometry[cell];
        double                   nodal_volume = 1. / (1 << dim);
        for (int d = 0; d < dim; ++d)
          nodal_volume /= geometry.inverse_edge[d];
        for (std::uint32_t a = 0; a < 1 << dim; ++a)
          for_each_master(geometry.node[a] / NodeLayout<dim>::stride,
                          [&](const Master &master) {
                            followers.emplace_back(master.node,
                                                   Corner{cell,
                                                          a,
                                                          master.share,
                                                          master.share *
                                                            nodal_volume});
                          });
      }
    return followers;
  }



  // The owner of a cell tells all ranks that hold a node that its corners
  // follow.
  template <int dim>
  void
  CornersOfNodes<dim>::add_those_of_others(const RunParts<dim> &parts,
                                           Followers           &followers)
  {
    const SharedRecords &shared_nodes = parts.nodes.table.shared;
    const SharedRecords &shared_cells = parts.grid.shared_cells;

    std::map<unsigned int, std::vector<Follower>>   news;
    std::map<unsigned int, ExchangePlan::Neighbour> exchange;
    for (const auto &[rank, records] : shared_nodes.neighbours)
      {
        const auto nodes    = places_of(records);
        const auto cells    = places_of(shared_with(shared_cells, rank));
        exchange[rank].rank = rank;
        std::vector<std::uint32_t> &send = exchange[rank].send;
        for (const auto &[node, corner] : followers)
          if (const auto at = nodes.find(node); at != nodes.end())
            {
              const auto known  = cells.find(corner.cell);
              const bool is_far = known == cells.end();
              news[rank].push_back(
                {at->second, corner, is_far ? unknown : known->second});
              if (is_far && (send.empty() || send.back() != corner.cell))
                send.push_back(corner.cell); // they come in order
            }
      }

    for (const auto &[rank, told] :
         exchange_records(news, parts.grid.communicator))
      {
        const auto   &nodes = shared_with(shared_nodes, rank);
        const auto   &cells = shared_with(shared_cells, rank);
        std::uint32_t last  = unknown; // far cell there
        for (Follower follower : told)
          {
            std::uint32_t &cell = follower.corner.cell;
            if (follower.shared_cell != unknown)
              cell = cells[follower.shared_cell];
            else
              {
                if (cell != last)
                  exchange[rank].receive.push_back(parts.grid.n_cells() +
                                                   far_cells++);
                last = cell;
                cell = exchange[rank].receive.back();
              }
            followers.emplace_back(nodes[follower.node], follower.corner);
          }
      }
    for (auto &[rank, neighbour] : exchange)
      if (!neighbour.send.empty() || !neighbour.receive.empty())
        neighbours.push_back(std::move(neighbour));
  }



  // Node by node.
  template <int dim>
  void
  CornersOfNodes<dim>::sort(const Followers &followers)
  {
    for (const auto &[node, corner] : followers)
      ++first[node + 1];
    for (std::size_t node = 1; node < first.size(); ++node)
      first[node] += first[node - 1];
    corners.resize(first.back());
    std::vector<std::size_t> next(first);
    for (const auto &[node, corner] : followers)
      corners[next[node]++] = corner;
  }



  template class CornersOfNodes<2>;
  template class CornersOfNodes<3>;
} // namespace limber
