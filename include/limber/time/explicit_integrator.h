// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_explicit_integrator_h
#define limber_time_explicit_integrator_h

#include <limber/base/timing.h>
#include <limber/grid/boundary_conditions.h>
#include <limber/time/body_sweeps.h>
#include <limber/time/contact.h>
#include <limber/time/density_control.h>
#include <limber/time/full_mass_filter.h>
#include <limber/time/liquid_means.h>
#include <limber/time/obstacle_contact.h>
#include <limber/time/particle_shifting.h>
#include <limber/time/relocation.h>
#include <limber/time/smooth_surfaces.h>
#include <limber/time/stabilization.h>

#include <array>
#include <optional>

namespace limber
{
  /** The verbs of a step, in the order in which they are reported. */
  enum class Verb
  {
    points_to_grid,
    stabilize,
    add_loads,
    solve_pressure,
    sum_shared_nodes,
    advance_nodes,
    touch,
    apply_boundaries,
    check_nodes,
    grid_to_points,
    update_stress,
    relocate,
    n_verbs
  };



  /**
   * Explicit steps of the material point method, with the stress updated
   * first (USF), last (USL), last with re-mapped velocity (MUSL), or half of
   * it at either end (USAVG). A step is never tried again: where nodal
   * velocities show that it cannot be done, advance() throws before points
   * are moved, with USL and MUSL before they are changed at all.
   */
  template <int dim>
  class ExplicitIntegrator : public Integrator<dim>
  {
  public:
    explicit ExplicitIntegrator(const RunParts<dim> &parts);

    bool
    reorganise(double now) override;
    bool
    bring_points_home() override;
    double
    longest_step() const override;
    double
    advance(double time, double step) override;
    void
    synchronise() override;
    void
    reinit() override;
    IntegratorState<dim>
    state() const override;
    void
    restore(const IntegratorState<dim> &former) override;
    typename ExternalLoads<dim>::Pieces
    detached_pieces() const override
    {
      return loads.detached_pieces();
    }
    void
    attach(const typename ExternalLoads<dim>::Pieces &detached) override
    {
      loads.attach(detached);
    }
    double
    imbalance() const override;
    double
    largest_displacement() const override;
    bool
    points_were_lost() const override;
    const std::vector<LostPointOfBody<dim>> &
    lost_points() const override;
    std::vector<std::pair<std::string, double>>
    verb_seconds() const override;
    std::string
    effort() const override
    {
      return "";
    }

  protected:
    using Layout = NodeLayout<dim>;

    // The schemes (USF, USL, MUSL, ...): the order of the verbs in a step
    virtual void
    do_scheme();
    void
    usf();
    void
    usl();
    void
    musl();
    void
    usavg();
    void
    leapfrog(double ahead);
    void
    usl_in_initial_frame();
    void
    between_filters();
    void
    strain_at_start(double length);
    void
    p2g_before_strain();
    void
    accelerate_nodes();
    double
    square_of_strain() const;
    double
    share_of_smoothing() const;

    // Sweeps over points. Nodal sums are complete on all ranks at their end
    void
    p2g();
    void
    p2g_momentum();
    void
    p2g_force();
    void
    find_contact();
    void
    g2p();
    void
    g2p_and_remap();
    void
    g2p_and_move();
    void
    update_stress(double length);
    void
    update_stress_and_move(double length, unsigned int slot);
    void
    g2p_update_stress_and_move();
    void
    strain_and_give_force(double length);

    // Operations on nodes between the sweeps
    void
    clear();
    void
    control_checkerboards();
    void
    control_density();
    void
    resist_hourglass();
    void
    damp();
    void
    add_loads();
    void
    advance_nodes();
    void
    smooth_surfaces(double share);
    void
    measure_nodes();
    double
    way_of_fastest_node();
    void
    check_nodes();
    void
    exchange_between_bodies();
    void
    apply_boundaries();
    void
    interpolate_hanging();
    void
    account_loads(unsigned int velocity_after);
    void
    form_velocity(unsigned int momentum);
    void
    form_velocity_before();
    std::vector<KeptNode<dim>>
    nodes_to_keep() const;
    void
    restore_kept_nodes();
    void
    form_velocity_after();
    void
    clear_remapped();
    void
    clear_trial_force();
    void
    clear_momentum();
    void
    keep_momentum();
    void
    strain_by_new_velocity();
    void
    show_velocity();
    void
    centre_velocity();
    void
    move_as_strained();
    void
    note_forces();
    void
    filter_velocity();
    void
    filter_and_account();

    // Parts of these
    bool
    leapfrogs() const;
    void
    find_speeds();
    double
    longest_way() const;
    bool
    spread_points(double now);
    void
    give(P2GOptions what);
    void
    finish_giving(const P2GOptions &what);
    void
    take(G2POptions what);
    double
    flip_share() const;
    double
    light_share() const;
    void
    strain(StressSweep what);
    void
    sum_shared_nodes(unsigned int first, unsigned int last);
    bool
    needs_trial_force() const;

    void
    lap(const Verb verb)
    {
      stopwatch.lap(seconds[std::size_t(verb)]);
    }

    const RunParts<dim> parts;
    const bool          parallel;
    const bool          in_initial_frame; // all bodies
    // With MUSL and USAVG points move with the velocity that strains them; with
    // APIC this would lose angular momentum.
    const bool              moves_as_strained;
    CoveredSides<dim>       covered; // by obstacles that move
    BoundaryConditions<dim> boundaries;
    // Where obstacles may cut cells that hold a liquid
    std::optional<CutCells<dim>> cut_cells;
    ExternalLoads<dim>           loads;
    BodySweeps<dim>              sweeps;
    LiquidMeans<dim>             liquid_means;
    bool touched = false; // bodies or obstacles, in the step before
    std::optional<Contact<dim>> contact; // of bodies that may part
    // Where the scene has any, or sides that meet surfaces
    std::optional<ObstacleContact<dim>> obstacles;
    std::optional<SmoothSurfaces<dim>>  surfaces; // in cells that these cut
    Stabilization<dim>                  stabilization;
    DensityControl<dim>                 density_control;
    Relocation<dim>                     relocation;
    ParticleShifting<dim>               shifting;
    std::optional<FullMassFilter<dim>>  full_mass; // for FMPM and XPIC alone
    unsigned long                       steps_since_filter = 0;

    Stopwatch                                      stopwatch;
    std::array<double, std::size_t(Verb::n_verbs)> seconds{};

    double time = 0, step = 0; // of the step that is being done, s

    // In the initial frame: time by which strain and stress lag behind, s.
    // While it is positive, nodes hold the velocity that is going to strain the
    // points.
    double unstrained       = 0;
    bool   stress_is_behind = false;
    // Whether nodes hold, from leapfrog(), the re-mapped velocity of the step
    // before and the momentum mapped for the next, also after synchronise():
    // whether anybody has looked changes nothing.
    bool keeps_velocity = false;
    bool shows_velocity = false;           // for output, see show_velocity()
    std::vector<KeptNode<dim>> kept_nodes; // of a checkpoint, for the next step

    // Of the present state, over all ranks
    double wave_speed  = 0; // m/s
    double point_speed = 0; // m/s
    double viscosity   = 0; // largest kinematic viscosity, m^2/s

    // Of the step that is being done, on this rank until it ends
    StepExtremes extremes;
    double       history_time = 0; // for which histories have yet to relax, s
    double       fastest_node = 0; // cells in this step, over all ranks
  };
} // namespace limber

#endif
