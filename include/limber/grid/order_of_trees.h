// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_order_of_trees_h
#define limber_grid_order_of_trees_h

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <vector>

/**
 * @file The order in which the cells of a coarse mesh become trees of p4est's
 * forest, so that trees of one rank lie side by side.
 *
 * deal.II's SparsityTools::reorder_hierarchical() finds it, but looks for each
 * group of cells through all cells along the rim of what is ordered already
 * (until its release 9.5). Where numbers of cells have no common factors every
 * cell is a tree, and that search took more time than all the rest of the
 * set-up. order_of_trees.cc therefore defines that function of deal.II once
 * more; as the program's own functions come before those of shared libraries,
 * deal.II calls this one. Both give the same order.
 */
namespace limber
{
  /** Numbers of the rows of a graph that is connected to and fro. */
  using Order = std::vector<dealii::DynamicSparsityPattern::size_type>;

  /**
   * Rows in hierarchical order. A row and those of its neighbours that are
   * still free make a group, the next one begins at the rim where fewest
   * neighbours are free; groups are ordered in the same way. Each takes time
   * proportional to n log(n) in the number of connections.
   */
  Order
  hierarchical_order(const dealii::DynamicSparsityPattern &graph);

  /** Does nothing; who calls it has the linker take the function along. */
  void
  order_trees_quickly();
} // namespace limber

#endif
