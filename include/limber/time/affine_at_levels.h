// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_affine_at_levels_h
#define limber_time_affine_at_levels_h

#include <limber/grid/background_grid.h>
#include <limber/points/point_view.h>

#include <vector>

namespace limber
{
  /**
   * APIC at hanging nodes: correction for the affine velocities of points. A
   * hanging node h adds its momentum, sum_p m N_h (v + C (x_h - x)), to its
   * masters m. As these have other positions, they have to get the share w_m of
   * sum_p m N_h (v + C (x_m - x)). The difference,
   *
   *   w_m (sum_p m_p N_h(x_p) C_p) (x_m - x_h),
   *
   * sums to zero over the masters. Without it a velocity that is linear in
   * space, like a rotation, would lose energy where cells of two sizes meet.
   */
  template <int dim>
  class AffineAtLevels
  {
  public:
    /** Adopt a changed mesh. */
    void
    reinit(const BackgroundGrid<dim> &grid);

    /**
     * Add the correction to the momentum of nodes, at slot @p slot, before
     * hanging nodes are added to their masters.
     */
    void
    add(const PointView<dim> &points,
        const GridView<dim>  &grid,
        unsigned int          slot) const;

  private:
    struct Arm
    {
      std::uint32_t           master;
      double                  weight;
      std::array<double, dim> arm; // from the hanging node to it, m
    };

    // By node: its arms are [first[node], first[node + 1]); most have none
    std::vector<std::uint32_t> first;
    std::vector<Arm>           arms;
    std::vector<char>          has_hanging_node; // by cell
  };
} // namespace limber

#endif
