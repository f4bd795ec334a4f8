// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_reference_solver_h
#define limber_fem_reference_solver_h

#include <limber/fem/fastest_mode.h>
#include <limber/fem/solid_model.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace limber
{
  /** State of a body in motion, or in equilibrium, at some time. */
  template <int dim>
  struct SolidMotion
  {
    unsigned long step      = 0;
    double        time      = 0; // s
    double        step_size = 0; // of the last step, s
    NodalVector   displacement, velocity, acceleration;

    double                                      load_work     = 0; // J
    double                                      boundary_work = 0; // J
    double                                      plastic_work  = 0; // J
    double                                      outer_power   = 0; // W, now
    dealii::Tensor<1, dim>                      load_impulse;      // kg m/s
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_force;   // on the body, N
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse; // kg m/s

    unsigned long newton_steps   = 0;
    unsigned long factorisations = 0; // or set-ups of the multigrid
  };



  /**
   * Time integration of a SolidModel: load steps in equilibrium, the HHT-alpha
   * method (both by Newton's method, the latter with the tangent kept as long
   * as it converges fast), or central differences. Collective.
   */
  template <int dim>
  class ReferenceSolver
  {
  public:
    /** History variables of @p model are updated by accepted steps. */
    explicit ReferenceSolver(SolidModel<dim> &model);

    ~ReferenceSolver();

    /** The step that the scene prescribes or else the elements allow. */
    double
    longest_step() const
    {
      return step_limit;
    }

    /**
     * One step of the given length, s; in equilibrium a load step. Throws
     * ComputationError where Newton's method fails or a step is unstable.
     */
    void
    advance(const double step);

    /** Correct the time for the round-off of its steps, s. */
    void
    set_time(const double time)
    {
      state.time = time;
    }

    const SolidMotion<dim> &
    motion() const
    {
      return state;
    }

  private:
    void
    start();
    void
    check_free_motion() const;
    double
    explicit_step_limit(const unsigned int n_iterations);
    void
    explicit_step(const double step);
    void
    newmark_step(const double step, const unsigned int halved);
    bool
    try_newmark_step(const double step);
    void
    load_step(const double step);
    bool
    solve(const double time, const double mass_factor, const bool keep_tangent);
    bool
    matrix_serves(const double mass_factor) const;
    [[noreturn]] void
    fail(const double time, const std::string &entry) const;
    void
    follow_held(const NodalVector &former);
    double
    round_off_of_forces() const;
    void
    choose_loads(const double time);
    double
    evaluate_residual(const double time, const double mass_factor);
    void
    renew_tangent(const double mass_factor, const NodalVector *former);
    void
    close_step(const NodalVector &former, const double step);
    void
    account(const NodalVector &former, const double step);

    SolidModel<dim>                                  &model;
    const ReferenceMethod                             method;
    SolidMotion<dim>                                  state;
    double                                            step_limit = 0;
    LinearSolver                                      linear_solver;
    std::unique_ptr<typename SolidModel<dim>::Matrix> matrix;
    double matrix_mass_factor = -1; // with which the matrix was assembled

    // Forces, N: load is all but gravity, unbalanced what is left over, and
    // support what the sides of the box give to held components.
    NodalVector internal, load, inertia, unbalanced, support;
    NodalVector former_load, former_support;
    NodalVector net_force, former_net_force; // all but inertia
    NodalVector predicted; // displacement without the new acceleration, m
    double      load_factor       = 1; // share of gravity and loads that acts
    double      time_of_loads     = 0; // in equilibrium, s
    double      relative_residual = 0; // unbalanced share of the forces

    std::optional<FastestMode<dim>> fastest_mode; // where explicit steps ask
  };
} // namespace limber

#endif
