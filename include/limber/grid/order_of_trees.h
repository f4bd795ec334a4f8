// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_order_of_trees_h
#define limber_grid_order_of_trees_h

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <vector>

/**
 * @file The order of coarse cells as trees of p4est's forest, such that trees
 * of one rank are adjacent.
 *
 * deal.II's SparsityTools::reorder_hierarchical() computes it, but (until
 * release 9.5) searches all cells at the rim of what is ordered already for
 * each group of cells. If the cell counts have no common factors of two every
 * cell is a tree, and that search took more time than the rest of the set-up.
 * Therefore order_of_trees.cc defines that function of deal.II again; as
 * symbols of the executable precede those of shared libraries, deal.II calls
 * this one. Both give the same order.
 */
namespace limber
{
  /** Row numbers of a graph with symmetric connections. */
  using Order = std::vector<dealii::DynamicSparsityPattern::size_type>;

  /**
   * Rows in hierarchical order. A row and its free neighbours form a group; the
   * next one begins at the rim, at the row with fewest free neighbours; groups
   * are ordered in the same way, recursively. Takes O(n log n) time in the
   * number n of connections.
   */
  Order
  hierarchical_order(const dealii::DynamicSparsityPattern &graph);

  /** Does nothing; a call makes the linker include this translation unit. */
  void
  order_trees_quickly();
} // namespace limber

#endif
