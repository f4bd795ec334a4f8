// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_checkerboard_h
#define limber_transfer_checkerboard_h

#include <limber/grid/grid_view.h>

#include <vector>

/**
 * @file Control of checkerboard pressure modes, the dual of the hourglass
 * control. With one pressure per cell (Q1-P0) a pattern that alternates from
 * cell to cell causes no nodal force, so nothing removes it once points that
 * changed cells have left it there. Around a node with all its 2^dim cells
 * these patterns are the products s_k of two or more of the signs of the
 * directions; their amplitudes in the mean theta_c of the volumetric variable
 * are
 *
 *   a_k = sum over cells s_k(c) theta_c / 2^dim,
 *
 * and a step removes a share beta of them,
 *
 *   theta_c -= beta W / m_c sum_k s_k(c) a_k,  1 / W = sum over cells 1 / m_c,
 *
 * which conserves the sum of m theta (the volume), does not affect linear
 * fields and never adds energy for beta <= 2^-dim
 * (doc/theory/treatments.md).
 */
namespace limber
{
  /** Slots of the nodal records for this: number of cells, sum of 1/m, a_k. */
  template <int dim>
  inline constexpr unsigned int n_checkerboard_slots = 2 + (1 << dim) - 1 - dim;

  /**
   * Let each of these cells, if the body has mass there, add to these slots of
   * its nodes.
   */
  template <int dim>
  void
  gather_checkerboards(const std::vector<std::uint32_t> &cells,
                       const GridView<dim>              &grid,
                       const CellSums<dim>              &sums);

  /**
   * Given the complete nodal sums, write to shift[cell] the change of the
   * volumetric variable of the points in each of these cells, for beta = way /
   * h in cells with shortest edge h, but at most 2^-dim.
   */
  template <int dim>
  void
  find_checkerboard_shifts(const std::vector<std::uint32_t> &cells,
                           const GridView<dim>              &grid,
                           const CellSums<dim>              &sums,
                           double                            way,
                           double                           *shift);
} // namespace limber

#endif
