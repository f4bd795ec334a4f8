// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_transfer_hourglass_h
#define limber_transfer_hourglass_h

#include <limber/grid/grid_view.h>

#include <vector>

/**
 * @file Viscous hourglass control: resistance to the zero energy modes of a
 * cell with averaged strain, the products s_k of two or more of the signs of
 * the directions, with amplitudes q_k = sum over nodes s_k v / 2^dim.
 *
 * A smooth motion has them too, those with two directions d, e with amplitudes
 * h_d h_e d^2v/dx_d dx_e / 4 that are alike in neighbouring cells, while
 * hourglass modes alternate. So these are resisted by the scatter of the second
 * derivatives w = q / (h_d h_e) among the cells around each node. With the
 * resistance k = sum over bodies chi c m_cell / h of a cell, the power
 *
 *   sum over nodes n, cells c around n:  k_c (h_d h_e)^2 (w_c - w_n)^2 / 2^dim
 *
 * is dissipated, w_n being the mean around n with the weights k_c (h_d h_e)^2;
 * its derivatives are the forces
 *
 *   f_a = - sum_k s_k(a) k_c (q_c - mean over the nodes of c of h_d h_e w_n).
 *
 * They vanish for velocities that are quadratic in space, also at surfaces,
 * where a node has fewer cells. The trilinear mode, of third order in h, is
 * resisted directly, as are all modes of a cell without neighbours (theory:
 * doc/theory/treatments.md).
 */
namespace limber
{
  /** A body with hourglass control: its masses in the cells, and chi c. */
  template <int dim>
  struct HourglassResistance
  {
    CellSums<dim> sums;
    double        speed = 0; // chi times the wave speed, m/s
  };



  /** Hourglass amplitudes of a cell. */
  template <int dim>
  struct HourglassModes
  {
    static constexpr unsigned int n_modes = (1 << dim) - 1 - dim;
    // modes of two directions, which have a mean around nodes
    static constexpr unsigned int n_pairs = dim == 2 ? 1 : 3;

    double                                       resistance = 0; // k, kg/s
    double                                       area       = 0; // h_d h_e, m^2
    std::array<std::array<double, n_modes>, dim> amplitude;      // q, m/s
  };



  /**
   * The nodal record, at the same offsets as NodeLayout: the sum of the weights
   * k (h_d h_e)^2 of cells, kg m^4/s, and the sums of weight times w or, after
   * division by the weight, the means of w, 1/(m s), by components and pairs of
   * directions.
   */
  template <int dim>
  struct HourglassLayout
  {
    static constexpr unsigned int weight = 0;
    static constexpr unsigned int mode   = 1;
    static constexpr unsigned int n = mode + dim * HourglassModes<dim>::n_pairs;
    static_assert(n <= NodeLayout<dim>::stride, "at the same offsets");
  };



  /**
   * From mass and momentum of the nodes: the hourglass amplitudes of these
   * cells, and their contributions to the nodal records in @p sums. k is at
   * most half (a quarter in 3d) of the smallest nodal mass over the step, for
   * stability.
   */
  template <int dim>
  void
  find_hourglass_modes(const std::vector<std::uint32_t>            &cells,
                       const GridView<dim>                         &grid,
                       const std::vector<HourglassResistance<dim>> &bodies,
                       double                                       step,
                       std::vector<HourglassModes<dim>>            &modes,
                       double                                      *sums);

  /**
   * Given the means around the nodes (weight zero if there is none), add the
   * hourglass forces to the re-mapped slots of the nodes, which are unused at
   * that time. They have no resultant and no moment and only dissipate.
   */
  template <int dim>
  void
  add_hourglass_forces(const std::vector<std::uint32_t>       &cells,
                       const GridView<dim>                    &grid,
                       const std::vector<HourglassModes<dim>> &modes,
                       const double                           *means);
} // namespace limber

#endif
