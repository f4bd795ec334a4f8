// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_smooth_surfaces_h
#define limber_time_smooth_surfaces_h

#include <limber/grid/boundary_conditions.h>
#include <limber/time/cut_cells.h>

#include <vector>

namespace limber
{
  /**
   * Damps the motion of liquids that alternates along surfaces of obstacles in
   * cut cells. The mean flow through each piece of surface is held by its
   * impulse or pressure (ObstacleContact, PressureSurfaces), but what
   * alternates is not, as the nodes are as many as the pieces. It would grow as
   * in a Rayleigh-Taylor instability, as what sinks into the obstacle makes the
   * nodes there heavier. So the first moments of the relative normal velocity
   * over each piece
   *
   *   b_k = int (v - v_o) . n t_k . (x - x_s) dS
   *       = sum_i A_ki . (v_i - v_o(x_i))
   *
   * with its tangents t_k and centroid x_s, which are zero in an exact motion,
   * are damped at the start of a step, by impulses - A_ki b_k / d_k,
   *
   *   d_k = sum_i |A_ki|/m_i sum_l |A_li|
   *
   * over all moments l at the node: some steps of Jacobi's method that do not
   * overshoot. Nothing happens at rest. Explicit steps take a share of it, the
   * shorter they are the less. Cells with hanging corners are left alone.
   */
  template <int dim>
  class SmoothSurfaces
  {
  public:
    SmoothSurfaces(const RunParts<dim> &parts, CutCells<dim> &cut_cells);

    /** Adopt a changed mesh. */
    void
    reinit();

    /**
     * Change new velocities and increments of nodes by a @p share of the
     * damping that the velocities before the step ask for, except for
     * components that sides hold at its end. Collective.
     */
    void
    apply(BoundaryConditions<dim> &boundaries,
          double                   time,
          double                   step,
          double                   share);

    /**
     * Record the energy that the impulses of the step have taken from the
     * points: they do work with the mean of the velocities before and after it.
     */
    void
    account(unsigned int velocity_after);

  private:
    using Layout                          = NodeLayout<dim>;
    using Vector                          = dealii::Tensor<1, dim>;
    static constexpr unsigned int n_nodes = 1 << dim;

    /** One b_k. */
    struct Moment
    {
      std::uint32_t               cell;
      unsigned int                obstacle;
      std::array<Vector, n_nodes> entries{}; // A_ki, m^dim
    };

    void
    find_moments();
    void
    add(const typename CutCells<dim>::Cell &cell);
    void
    damp(double time, double step, double share);
    using Ways = std::vector<ObstacleMotion<dim>>; // of each obstacle
    void
    damp_once(const Ways &ways, double share);
    void
    push_nodes();

    std::uint32_t
    node_of(const std::uint32_t cell, const unsigned int a) const
    {
      return parts.grid.geometry[cell].node[a] / Layout::stride;
    }

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * stride;
    }

    const RunParts<dim> parts;
    CutCells<dim>      &cut_cells;
    std::vector<Moment> moments; // of cells of this rank, in this step
    std::vector<char>   held;    // by node and component
    // By node: impulses of this step, of one pass, kg m/s; weights
    static constexpr unsigned int of_pass = dim, weight = 2 * dim,
                                  stride = 2 * dim + 1;
    LazyArray<double> records;
    RecordExchange    exchange{stride};
  };
} // namespace limber

#endif
