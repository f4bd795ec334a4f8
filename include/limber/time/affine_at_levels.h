// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_affine_at_levels_h
#define limber_time_affine_at_levels_h

#include <limber/grid/background_grid.h>
#include <limber/points/point_view.h>

#include <vector>

namespace limber
{
  /**
   * What the affine velocities of points (APIC) give to the masters of hanging
   * nodes. A hanging node h hands its momentum, sum_p m N_h (v + C (x_h - x)),
   * to masters m, and each of these stands elsewhere: it has to get the share
   * w_m of sum_p m N_h (v + C (x_m - x)). The difference,
   *
   *   w_m (sum_p m_p N_h(x_p) C_p) (x_m - x_h),
   *
   * has no sum over masters. Without it a field that is linear in space, like a
   * rotation, would lose energy where cells of two sizes meet.
   */
  template <int dim>
  class AffineAtLevels
  {
  public:
    /** Adopt a changed mesh. */
    void
    reinit(const BackgroundGrid<dim> &grid);

    /**
     * Add it to the momentum of nodes, from slot @p slot on, before hanging
     * nodes hand theirs on.
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

    // By node: its arms are [first[node], first[node + 1]); none of most
    std::vector<std::uint32_t> first;
    std::vector<Arm>           arms;
    std::vector<char>          has_hanging_node; // by cell
  };
} // namespace limber

#endif
