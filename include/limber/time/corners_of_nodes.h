// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_corners_of_nodes_h
#define limber_time_corners_of_nodes_h

#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /**
   * Which corners of cells follow a node where cells have several sizes: its
   * own, and hanging ones with the share that it has in them; empty where no
   * node hangs. They may be those of far cells, which are owned by another rank
   * and are no ghosts here: these have numbers beyond all cells of the grid.
   */
  template <int dim>
  class CornersOfNodes
  {
  public:
    struct Corner
    {
      std::uint32_t cell;
      std::uint32_t corner;
      double        share; // of the motion of the node
      double        room;  // this share in the room around the corner, m^3
    };

    /** What a corner follows. */
    struct Master
    {
      std::uint32_t node;
      double        share;
    };

    /** Adopt a mesh. Collective. */
    void
    reinit(const RunParts<dim> &parts);

    /** Of this rank, that follow a node. */
    std::uint32_t
    n_far_cells() const
    {
      return far_cells;
    }

    /** What neighbours are to be told for their far cells. */
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

    /** Call work(master) for what a node follows, be it itself. */
    template <class Work>
    void
    for_each_master(const std::uint32_t node, const Work &work) const
    {
      if (hanging[node] == nullptr)
        return work(Master{node, 1});
      for (const auto &[master, share] : hanging[node]->masters)
        work(Master{master, share});
    }

  private:
    // One that follows a node; what ranks tell each other of it besides
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
