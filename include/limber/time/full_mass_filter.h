// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_full_mass_filter_h
#define limber_time_full_mass_filter_h

#include <limber/grid/boundary_conditions.h>
#include <limber/state/material_body.h>

#include <vector>

namespace limber
{
  /**
   * The velocity of the nodes that points take with FMPM(k) and XPIC(k). The
   * lumped mass makes v = p / m too smooth: brought to the points (S) and back
   * (S+ = m^-1 S^T M) a velocity comes out as S+ S v. The inverse of S+ S, that
   * is the full mass matrix, is approached by k terms of its series,
   *
   *   v(k) = sum over j < k of (1 - S+ S)^j v,
   *
   * so that waves of some cells keep their amplitude in v <- S v(k) while what
   * no node sees of the motion of points is gone after one step.
   *
   * (Nairn and Hammerquist, CMAME 380, 2021; Hammerquist and Nairn, CMAME 318,
   * 2017 for XPIC)
   */
  template <int dim>
  class FullMassFilter
  {
  public:
    FullMassFilter(const BackgroundGrid<dim>     &grid,
                   const BoundaryConditions<dim> &boundaries);

    /** Adopt a changed mesh. */
    void
    reinit();

    /**
     * Put v(@p order) in the place of the new velocity of active nodes or,
     * with @p former_only, that of the velocity before the step plus the
     * increment of the step. What sides hold stays as it is. Collective.
     */
    void
    apply(NodalFields<dim>                                &nodes,
          std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
          unsigned int                                     order,
          bool                                             former_only);

  private:
    using Layout = NodeLayout<dim>;

    void
    bring_to_points_and_back(
      NodalFields<dim>                                &nodes,
      std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies);

    double *
    record(const std::uint32_t node)
    {
      return records.data() + std::size_t(node) * Layout::stride;
    }

    const NodeTable<dim>          &table;
    const BoundaryConditions<dim> &boundaries;
    // As the nodes' own: the present term of the series is their velocity, the
    // re-mapped slots are for what comes back.
    LazyArray<double>              records;
    RecordExchange                 exchange{Layout::stride};
    std::vector<std::vector<double>> on_points; // velocities; refilled
  };
} // namespace limber

#endif
