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
   * The sweeps over the points of all bodies (P2G, G2P, stress update). The
   * options that depend on the law, locking treatment and histories of a body
   * are set here; energies that a sweep removes go into the ledger.
   */
  template <int dim>
  class BodySweeps
  {
  public:
    explicit BodySweeps(const RunParts<dim> &parts);

    /** Adopt a changed mesh. */
    void
    reinit();

    /** P2G: add to the nodes; returns the number of batches. Collective. */
    std::size_t
    points_to_grid(P2GOptions what);

    /**
     * Dual domain method, once nodal sums are complete over ranks: add forces
     * of the stress that is mapped through nodes. Collective.
     */
    void
    finish_points_to_grid(const P2GOptions &what);

    /**
     * With the dual domain method, before points and loaded faces are strained:
     * the mean gradients around nodes of the velocity in @p slot. Collective.
     */
    void
    average_gradients(unsigned int slot);

    /** These, by nodal field; empty with other kernels. */
    const std::vector<DualDomain<dim>> &
    mean_gradients() const
    {
      return dual_domains;
    }

    void
    grid_to_points(const G2POptions &what, StepExtremes &extremes);

    /** G2P for bodies that do not take velocities in update_stress(). */
    void
    grid_to_points_ahead(const G2POptions &what, StepExtremes &extremes);

    /** Relaxation of histories towards the mean of the cell in one sweep. */
    struct Pace
    {
      // Time over which volumetric histories relax now, s; 0: they do not
      double volumetric = 0;
      double deviatoric = 0; // likewise
      double speed      = 0; // of the fastest point, m/s
    };

    /**
     * Strain all points and update their stress, after histories have relaxed
     * towards the means at the start of the step. Collective.
     */
    void
    update_stress(StressSweep what, const Pace &pace, StepExtremes &extremes);

  private:
    /** Nodal field that the points of a body map to and from. */
    GridView<dim>
    nodes_of(const MaterialBody<dim> &body)
    {
      const unsigned int field = body.description.nodal_field;
      GridView<dim>      view  = parts.nodes.view(field);
      if (!dual_domains.empty() && !body.description.is_liquid)
        view.dual_domain = dual_domains[field].data();
      return view;
    }

    void
    grid_to_points(MaterialBody<dim> &body,
                   const G2POptions  &what,
                   StepExtremes      &extremes);
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

    const RunParts<dim>          parts;
    std::vector<DualDomain<dim>> dual_domains; // by field, that kernel alone
    // With affine velocities on cells of several sizes
    std::optional<AffineAtLevels<dim>> affine_at_levels;
  };
} // namespace limber

#endif
