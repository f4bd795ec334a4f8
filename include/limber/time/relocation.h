// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_relocation_h
#define limber_time_relocation_h

#include <limber/time/integrator.h>

#include <vector>

namespace limber
{
  /** Maxima found during a step, on this rank or over all. */
  struct StepExtremes
  {
    double speed_squared = 0;     // of points, m^2/s^2
    double wave_squared  = 0;     // of waves in them, m^2/s^2
    double displacement  = 0;     // of points over the edges of their cells
    double largest_mass  = 1e300; // of a node, kg
  };



  /**
   * Bookkeeping of points between the sweeps of two steps, however they are
   * moved: their cells and the sums over cells, order in memory, migration
   * between ranks, losses.
   */
  template <int dim>
  class Relocation
  {
  public:
    /** Pieces of @p loads follow the points that carry them. */
    Relocation(const RunParts<dim> &parts, ExternalLoads<dim> &loads);

    /** Adopt points that have come to their cells other than by steps. */
    void
    reinit();

    /** Reduce the extremes over all ranks, in place. */
    void
    reduce(StepExtremes &extremes);

    void
    begin_step();

    /** Note the number of batches (runs of points in one cell) of the first
     * sweep of a step. */
    void
    note_batches(const std::size_t n)
    {
      n_batches = n;
    }

    /**
     * After the points have moved: reduce the extremes over all ranks, handle
     * losses and newly occupied cells, and complete the cell sums at the new
     * places. If points have @p moved_again after they were added to these
     * (their longest way, in cells), the sums are formed anew from all points.
     */
    void
    end_step(StepExtremes &extremes, double moved_again = 0);

    /** See Integrator; @p displacement is the way of points in the last step,
     * in cells. */
    bool
    reorganise(double displacement);

    /** See Integrator. */
    bool
    bring_points_home();
    double
    imbalance() const;

    /** Let ranks exchange points, so that none is in a ghost cell. */
    void
    exchange_points();

    /** Adopt points that have been moved between steps, and know their cells.
     */
    void
    adopt_places();

    /** Smallest edge of the cells that hold points, over all ranks, m. */
    double
    smallest_edge() const
    {
      return 1 / largest_inverse_edge;
    }

    bool
    points_were_lost() const
    {
      return any_lost > 0;
    }

    const std::vector<LostPointOfBody<dim>> &
    lost_points() const
    {
      return lost;
    }

  private:
    void
    remove_lost_points();
    void
    sort_points(bool agree);
    void
    gather_cells();
    double
    find_largest_inverse_edge() const;

    const RunParts<dim> parts;
    ExternalLoads<dim> &loads;
    const bool          parallel;

    std::vector<LostPointOfBody<dim>> lost; // in the last step, on this rank

    // Maxima over all ranks
    double any_lost            = 0;
    double farthest_again      = 0; // in cells
    double any_entered_shared  = 0;
    double any_entered_ghosts  = 0;
    double most_points         = 0; // on one rank
    double most_excess_batches = 0; // on one rank, see below

    // Of cells that hold points, over all ranks, 1/m
    double largest_inverse_edge = 0;

    // Sum of largest displacements since ranks exchanged points, in cells
    double travelled = 0;
    // Batches beyond one per occupied cell, summed since the last sort
    std::size_t excess_batches = 0, n_batches = 0, n_batches_sorted = 0;
  };
} // namespace limber

#endif
