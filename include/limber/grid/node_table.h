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
  /** A node that the mesh constrains to others: u = sum weight u_master. */
  struct HangingNode
  {
    std::uint32_t                                 node; // local number
    std::vector<std::pair<std::uint32_t, double>> masters;
  };



  /**
   * What is known of a set of nodes on this rank, by local numbers: those that
   * it owns first, then ghosts.
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
     * Slots [first, last) of records of nodes: hanging nodes hand what has
     * been added to them on to their masters, and are left with zero.
     */
    void
    give_to_masters(double      *records,
                    unsigned int stride,
                    unsigned int first,
                    unsigned int last) const;

    /** The same: hanging nodes get the values that follow from masters. */
    void
    take_from_masters(double      *records,
                      unsigned int stride,
                      unsigned int first,
                      unsigned int last) const;

    unsigned int             n_owned = 0;
    std::vector<HangingNode> hanging;
    // Their masters, ascending, also of hanging nodes that only others know
    std::vector<std::uint32_t> masters;
    // Bit s is set for nodes on side s of the box.
    std::vector<std::uint8_t> sides;
    // Places of these nodes only
    std::unordered_map<std::uint32_t, dealii::Point<dim>> places;
    // Those that other ranks hold as well
    SharedRecords shared;
    // Of splines: for a node in sides, and a set of directions (bits), the node
    // that is reached by steps inward in those of them in which it lies at a
    // side
    std::unordered_map<std::uint32_t, std::array<std::uint32_t, 1 << dim>>
      inward;
    // The part of the mass of a node in a held side that joins the lumped mass
    // of its neighbour inward in full_mass_filter.h, for each direction
    double inward_share = 0;
  };
} // namespace limber

#endif
