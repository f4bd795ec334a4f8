// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_body_sweeps_h
#define limber_time_body_sweeps_h

#include <limber/time/affine_at_levels.h>
#include <limber/time/dual_domain.h>
#include <limber/time/relocation.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/points_to_grid.h>

#include <optional>

namespace limber
{
  /**
   * The sweeps over the points of all bodies, each with what its law, its
   * treatment and its histories ask for. What the caller does not say is added
   * here; energies that a sweep removes go into the ledger.
   */
  template <int dim>
  class BodySweeps
  {
  public:
    explicit BodySweeps(const RunParts<dim> &parts);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** Add to the nodes; returns the number of batches. Collective. */
    std::size_t
    points_to_grid(GiveToGrid what);

    /**
     * With the dual domain method, once ranks have completed the sums of the
     * nodes: what part of the stress does there. Collective.
     */
    void
    finish_points_to_grid(const GiveToGrid &what);

    /**
     * With the dual domain method, before points and loaded faces are strained:
     * the mean gradients around nodes. Collective.
     */
    void
    average_gradients(bool remapped);

    /** These (DualDomainLayout); null with other kernels. */
    const double *
    mean_gradients() const
    {
      return dual_domain ? dual_domain->data() : nullptr;
    }

    void
    grid_to_points(const TakeFromGrid &what, StepExtremes &extremes);

    /** The same for bodies that do not take velocities in update_stress(). */
    void
    grid_to_points_ahead(const TakeFromGrid &what, StepExtremes &extremes);

    /** How fast histories tend to the mean of the cell in one sweep. */
    struct Pace
    {
      // Time over which volumetric histories do so now, s; 0: they do not
      double volumetric = 0;
      double deviatoric = 0; // likewise
      double speed      = 0; // of the fastest point, m/s
    };

    /**
     * Strain all points, after histories have gone their way to the means
     * of the beginning of the step. Collective.
     */
    void
    update_stress(StressSweep what, const Pace &pace, StepExtremes &extremes);

  private:
    /** The nodes that the points of a body give to and take from. */
    GridView<dim>
    nodes_of(const MaterialBody<dim> &body)
    {
      GridView<dim> view = parts.nodes.view(body.description.nodal_field);
      if (dual_domain && !body.description.is_liquid)
        view.dual_domain = dual_domain->data();
      return view;
    }

    void
    grid_to_points(MaterialBody<dim>  &body,
                   const TakeFromGrid &what,
                   StepExtremes       &extremes);
    template <class Sum>
    void
    project_on_nodes(const Sum &sum);
    template <class Sum>
    void
    average_over_cells(const Sum &sum);
    double
    relaxation(const Body<dim>       &body,
               const HistoryTreatment history,
               const double           length,
               const double           speed) const;
    void
    relax_deviators(const Pace &pace);

    const RunParts<dim>            parts;
    std::optional<DualDomain<dim>> dual_domain; // with that kernel alone
    // With affine velocities on cells of several sizes
    std::optional<AffineAtLevels<dim>> affine_at_levels;
  };
} // namespace limber

#endif
