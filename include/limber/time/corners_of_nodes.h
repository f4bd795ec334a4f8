// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_corners_of_nodes_h
#define limber_time_corners_of_nodes_h

#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /**
   * Transpose of the hanging node constraints on meshes with levels: which
   * corners of cells follow a node, its own and hanging ones with its weight in
   * them; empty if no node hangs. Corners may belong to far cells, which are
   * owned by another rank and are no ghosts here; their numbers are beyond
   * those of all cells of the grid.
   */
  template <int dim>
  class CornersOfNodes
  {
  public:
    struct Corner
    {
      std::uint32_t cell;
      std::uint32_t corner;
      double        share; // weight of the node in it
      double nodal_volume; // share times the volume around the corner, m^dim
    };

    /** A node that a corner follows, with its weight. */
    struct Master
    {
      std::uint32_t node;
      double        share;
    };

    /** Adopt a mesh. Collective. */
    void
    reinit(const RunParts<dim> &parts);

    /** Number of far cells with a corner that follows a node here. */
    std::uint32_t
    n_far_cells() const
    {
      return far_cells;
    }

    /** Exchange plan of cell data for the far cells of all ranks. */
    const std::vector<ExchangePlan::Neighbour> &
    far_exchange() const
    {
      return neighbours;
    }

    bool
    empty() const
    {
      return !has_hanging;
    }

    /** Call work(corner) for those that follow a node. */
    template <class Work>
    void
    for_each(const std::uint32_t node, const Work &work) const
    {
      for (std::size_t k = first[node]; k < first[node + 1]; ++k)
        work(corners[k]);
    }

    /** Call work(master) for the masters of a node, or for itself. */
    template <class Work>
    void
    for_each_master(const std::uint32_t node, const Work &work) const
    {
      if (empty() || hanging[node] == nullptr)
        return work(Master{node, 1});
      for (const auto &[master, share] : hanging[node]->masters)
        work(Master{master, share});
    }

  private:
    // Record by which ranks tell each other of a corner that follows a node
    struct Follower
    {
      std::uint32_t node; // its place among the nodes that both share
      Corner        corner;
      // The place of the cell among those that both share, or none
      std::uint32_t shared_cell;
    };

    using Followers = std::vector<std::pair<std::uint32_t, Corner>>;

    Followers
    find_own(const RunParts<dim> &parts) const;
    void
    add_those_of_others(const RunParts<dim> &parts, Followers &followers);
    void
    sort(const Followers &followers);

    std::vector<const HangingNode *> hanging; // by node; null: does not hang
    std::vector<std::size_t>         first;   // by node, and the end
    std::vector<Corner>              corners; // node by node
    bool                             has_hanging = false; // on any rank
    std::uint32_t                    far_cells   = 0;
    std::vector<ExchangePlan::Neighbour> neighbours;
  };
} // namespace limber

#endif
