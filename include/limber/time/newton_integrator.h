// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_newton_integrator_h
#define limber_time_newton_integrator_h

#include <limber/time/generalised_alpha.h>
#include <limber/time/loads.h>
#include <limber/time/newton_method.h>
#include <limber/time/nodal_mass.h>
#include <limber/time/relocation.h>

namespace limber
{
  /**
   * Quasi-static steps, at whose end forces are in equilibrium, or implicit
   * ones with inertia (GeneralisedAlpha, whose acceleration points carry, or
   * without damping Newmark's trapezoidal rule, beta = 1/4, gamma = 1/2). The
   * displacements of the nodes in the step are found by Newton's method with
   * line search; points are updated only afterwards, so that a step that fails
   * leaves all as it was. It is then tried with half the length.
   * doc/theory/implicit_steps.md
   */
  template <int dim>
  class NewtonIntegrator final : public Integrator<dim>
  {
  public:
    explicit NewtonIntegrator(const RunParts<dim> &parts);

    bool
    reorganise(double) override
    {
      // exchange points between ranks, as they may move by up to a cell
      return equations.numbered_nodes().is_parallel() &&
             relocation.reorganise(1);
    }
    bool
    bring_points_home() override
    {
      return false;
    }
    double
    longest_step() const override
    {
      return next_step;
    }
    double
    advance(double time, double step) override;
    void
    synchronise() override
    {}
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
    imbalance() const override
    {
      return 1;
    }
    double
    largest_displacement() const override
    {
      return extremes.displacement * (1u << parts.problem.grid.levels);
    }
    bool
    points_were_lost() const override
    {
      return relocation.points_were_lost();
    }
    const std::vector<LostPointOfBody<dim>> &
    lost_points() const override
    {
      return relocation.lost_points();
    }
    std::vector<std::pair<std::string, double>>
    verb_seconds() const override;
    std::string
    warning() override;
    std::string
    effort() const override;

  private:
    using Layout = NodeLayout<dim>;
    using Values = std::vector<double>; // by equation
    // Points with what P2G is to map in the place of the velocity
    using View = PointView<dim> (*)(const PointView<dim> &);

    void
    measure_waves();
    void
    begin_step();
    void
    gather_nodes();
    Values
    gather(View view);
    bool
    try_step(double time, double step);
    bool
    stays_with_ranks(const Values &displacement);
    void
    look_at_stability();
    void
    look_at_compliance(const Values &increase, const Values &displacement);
    Values
    loads_at(double time, Values *given);
    double
    load_factor(double time) const;
    double
    kinetic_energy() const;
    void
    take_motion(const Values &displacement,
                const Values &new_velocity,
                const Values &new_acceleration);
    Values
    gained_momentum(const Values &new_velocity) const;
    void
    account_for_damping(const StepQuestion &question,
                        const Values       &displacement,
                        const Values       &new_velocity,
                        double              step);
    void
    account(const StepQuestion &question,
            const Values       &displacement,
            const Values       &new_velocity,
            const Values       &given,
            const Values       &net,
            double              time,
            double              step);
    [[noreturn]] void
    fail(double time, double step) const;

    const RunParts<dim>  parts;
    const bool           in_motion; // has inertia; else quasi-static
    ExternalLoads<dim>   loads;
    Relocation<dim>      relocation;
    NewtonEquations<dim> equations;
    FollowerLoads<dim>   followers;
    NewtonClock          clock;
    NodalMass<dim>       mass;
    NewtonMethod<dim>    newton;

    // Of the nodes of the step, kg (lumped), m/s, m/s^2; accelerations of
    // generalised-alpha alone, else zero
    const GeneralisedAlpha scheme;
    Values                 masses, velocities, accelerations;

    const double longest;   // of steps that may be asked for, s
    double       next_step; // s
    double       last_step = 0, wave_speed = 0;
    StepExtremes extremes;

    double        largest_force      = 0; // in equilibrium so far, N
    double        lost_between_steps = 0; // J
    double        lost_in_time       = 0; // by generalised-alpha, J
    std::string   obstacle;               // why the last step failed
    unsigned long steps = 0, iterations = 0, halvings = 0;
    unsigned long most_iterations = 0;
    bool          warned          = false; // that iterations have failed

    double first_compliance = 0; // of the loads, m/N
    bool   collapses = false, told_of_collapse = false;
    bool   is_unstable = false, told_of_instability = false;
  };
} // namespace limber

#endif
