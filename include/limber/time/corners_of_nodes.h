// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_corners_of_nodes_h
#define limber_time_corners_of_nodes_h

#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /**
   * Which corners of cells follow a node where cells have several sizes: its
   * own, and hanging ones with the share that it has in them. Known for the
   * nodes of one rank that has all cells; empty where no node hangs.
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
    };

    /** What a corner follows. */
    struct Master
    {
      std::uint32_t node;
      double        share;
    };

    /** Adopt a mesh. */
    void
    reinit(const RunParts<dim> &parts);

    bool
    empty() const
    {
      return corners.empty();
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
    std::vector<const HangingNode *> hanging; // by node; null: does not hang
    std::vector<std::size_t>         first;   // by node, and the end
    std::vector<Corner>              corners; // node by node
  };
} // namespace limber

#endif
