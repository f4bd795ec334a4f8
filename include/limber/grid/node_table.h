// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_node_table_h
#define limber_grid_node_table_h

#include <deal.II/base/point.h>

#include <limber/grid/shared_records.h>

#include <array>
#include <unordered_map>
#include <vector>

namespace limber
{
  /** A hanging node, constrained by its masters: u = sum weight u_master. */
  struct HangingNode
  {
    std::uint32_t                                 node; // local number
    std::vector<std::pair<std::uint32_t, double>> masters;
  };



  /**
   * Topology of a set of nodes on this rank, by local numbers: owned ones
   * first, then ghosts.
   */
  template <int dim>
  struct NodeTable
  {
    /** Owned and ghost. */
    unsigned int
    n() const
    {
      return sides.size();
    }

    /**
     * Condense: add slots [first, last) of the records of hanging nodes to
     * their masters, and set them to zero (transpose of the interpolation).
     */
    void
    give_to_masters(double      *records,
                    unsigned int stride,
                    unsigned int first,
                    unsigned int last) const;

    /** Interpolate: set these slots of hanging nodes from their masters. */
    void
    take_from_masters(double      *records,
                      unsigned int stride,
                      unsigned int first,
                      unsigned int last) const;

    unsigned int             n_owned = 0;
    std::vector<HangingNode> hanging;
    // Their masters, ascending; also those of hanging nodes of other ranks
    std::vector<std::uint32_t> masters;
    // Bit s is set for nodes on side s of the box.
    std::vector<std::uint8_t> sides;
    // Positions of the nodes on sides only
    std::unordered_map<std::uint32_t, dealii::Point<dim>> places;
    // Nodes that are known to several ranks
    SharedRecords shared;
    // Of splines: for a node on sides, and a set of directions (bits), the node
    // reached by one step inward in those directions in which it is on a side
    std::unordered_map<std::uint32_t, std::array<std::uint32_t, 1 << dim>>
      inward;
    // Share of the mass of a node on a held side that is added to the lumped
    // mass of its inward neighbour in full_mass_filter.h, per direction
    double inward_share = 0;
  };
} // namespace limber

#endif
