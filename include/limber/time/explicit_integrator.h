// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_explicit_integrator_h
#define limber_time_explicit_integrator_h

#include <limber/base/timing.h>
#include <limber/grid/boundary_conditions.h>
#include <limber/state/material_body.h>
#include <limber/time/full_mass_filter.h>
#include <limber/time/loads.h>
#include <limber/transfer/grid_to_points.h>
#include <limber/transfer/hourglass.h>
#include <limber/transfer/points_to_grid.h>

#include <array>
#include <string>
#include <vector>

namespace limber
{
  /** The verbs of a step, in the order in which they are reported. */
  enum class Verb
  {
    points_to_grid,
    add_loads,
    sum_shared_nodes,
    advance_nodes,
    apply_boundaries,
    check_nodes,
    grid_to_points,
    update_stress,
    relocate,
    n_verbs
  };

  const char *
  name_of(Verb verb);



  /** What the integrator takes from step to step; plain, for checkpoints. */
  template <int dim>
  struct IntegratorState
  {
    // Of the last step, over all ranks: m/s, m/s, cells, kg
    double                              wave_speed         = 0;
    double                              point_speed        = 0;
    double                              displacement       = 0;
    double                              largest_mass       = 0;
    unsigned long                       steps_since_filter = 0;
    typename ExternalLoads<dim>::Pieces face_pieces;
  };



  /**
   * Explicit steps of the material point method, with the stress updated
   * first (USF), last (USL), last with re-mapped velocity (MUSL), or half of
   * it at either end (USAVG).
   */
  template <int dim>
  class ExplicitIntegrator
  {
  public:
    ExplicitIntegrator(const Problem<dim>                              &problem,
                       BackgroundGrid<dim>                             &grid,
                       NodalFields<dim>                                &nodes,
                       std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies,
                       Ledger<dim>                                     &ledger);

    /**
     * To be called before each step: exchange points between ranks or sort
     * them, where due. Returns whether ranks have exchanged points.
     */
    bool
    reorganise();

    /**
     * Where points see nodes beyond those of their cells, give those in ghost
     * cells to the ranks that own these, who alone know all; records of nodes
     * are given up. To
     * be called before anything but a step evaluates functions at points;
     * returns whether there were any. Collective.
     */
    bool
    bring_points_home();

    /**
     * One step from @p time over @p step seconds; collective. Throws
     * ComputationError when the step cannot be done; where nodal velocities
     * show it, points still are what they were.
     */
    void
    advance(double time, double step);

    /** The longest step that the Courant number admits now, s. */
    double
    longest_step() const;

    /** Adopt a mesh that has changed, and points that have moved with it. */
    void
    reinit();

    /** Collective. */
    IntegratorState<dim>
    state() const;

    /** Adopt points that have been replaced by those of a checkpoint. */
    void
    restore(const IntegratorState<dim> &former);

    /** Share of all points on the fullest rank times the number of ranks. */
    double
    imbalance() const;

    /** Whether any rank has lost points in the last step. */
    bool
    points_were_lost() const
    {
      return any_lost > 0;
    }

    /** Points that were lost in the last step, on this rank. */
    const std::vector<std::pair<std::string, LostPoint<dim>>> &
    lost_points() const
    {
      return lost;
    }

    /** Wall time per verb on this rank, s. */
    std::array<double, std::size_t(Verb::n_verbs)> verb_seconds{};

  private:
    // The schemes: in which order of its verbs a step is done
    void
    usf();
    void
    usl();
    void
    musl();
    void
    usavg();

    void
    strain_before_forces(double length);
    void
    strain_after_motion(double length);
    void
    accelerate_nodes();

    // Verbs: sums over points are complete on all ranks when they are done
    void
    p2g();
    void
    p2g_momentum();
    void
    p2g_force();
    void
    g2p_and_remap();
    void
    g2p_and_move();
    void
    update_stress(double length);
    void
    update_stress_and_move(double length);
    void
    g2p_update_stress_and_move();

    void
    clear();
    void
    points_to_grid(GiveToGrid what);
    void
    control_chequerboards();
    void
    resist_hourglass();
    void
    damp();
    void
    add_loads();
    void
    sum_shared_nodes(unsigned int first, unsigned int last);
    template <class Sum>
    void
    project_on_nodes(const Sum &sum);
    void
    advance_nodes();
    void
    check_nodes();
    void
    apply_boundaries();
    void
    account_loads(unsigned int velocity_after);
    void
    divide_remapped(unsigned int momentum, double when);
    void
    centre_velocity();
    void
    interpolate_hanging();
    void
    grid_to_points(const TakeFromGrid &what);
    void
    grid_to_points(MaterialBody<dim> &body, TakeFromGrid what);
    double
    flip_share() const;
    void
    filter_velocity();
    double
    relaxation(const Body<dim> &body,
               HistoryTreatment history,
               double           length) const;
    void
    relax_deviators(double length);
    void
    update_stress(StressSweep what);
    void
    relocate();
    void
    remove_lost_points();
    void
    sort_points(bool agree);
    void
    reduce_extremes();
    void
    exchange_points();
    void
    complete_cells(std::optional<CellFields<dim>> MaterialBody<dim>::*sums);
    void
    gather_cells();

    void
    lap(const Verb verb)
    {
      stopwatch.lap(verb_seconds[std::size_t(verb)]);
    }

    const Problem<dim>                              &problem;
    BackgroundGrid<dim>                             &grid;
    NodalFields<dim>                                &nodes;
    std::vector<std::unique_ptr<MaterialBody<dim>>> &bodies;
    Ledger<dim>                                     &ledger;
    const BoundaryConditions<dim>                    boundaries;
    ExternalLoads<dim>                               loads;
    const bool                                       parallel;
    Stopwatch                                        stopwatch;
    std::optional<FullMassFilter<dim>> full_mass; // for FMPM and XPIC alone
    unsigned long                      steps_since_filter = 0;

    double time = 0, step = 0; // of the step that is being done, s

    // Of the present state, over all ranks
    double wave_speed  = 0; // m/s
    double point_speed = 0; // m/s
    double viscosity   = 0; // largest kinematic viscosity, m^2/s

    // Of the step that is being done, on this rank
    double                                              speed_squared = 0;
    double                                              wave_squared  = 0;
    double                                              displacement  = 0;
    double                                              largest_mass  = 1e300;
    std::vector<std::pair<std::string, LostPoint<dim>>> lost;

    // Over all ranks
    // Refilled in each step, which then allocates nothing
    std::vector<HourglassResistance<dim>> resisting;

    double any_lost            = 0;
    double any_entered_shared  = 0;
    double any_entered_ghosts  = 0;
    double most_points         = 0; // on one rank
    double most_excess_batches = 0; // on one rank, see below
    double fastest_node        = 0; // cells in this step

    // Sum of largest displacements since ranks exchanged points, in cells
    double travelled = 0;
    // Batches beyond one per occupied cell, summed since the last sort
    std::size_t excess_batches = 0, n_batches = 0, n_batches_sorted = 0;
  };
} // namespace limber

#endif
