// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_newton_method_h
#define limber_time_newton_method_h

#include <limber/base/timing.h>
#include <limber/time/newton_equations.h>

#include <array>
#include <string>
#include <vector>

namespace limber
{
  /** Parts of an implicit step whose time is reported. */
  enum class NewtonVerb
  {
    number_nodes,
    evaluate_forces,
    assemble_tangent,
    solve_equations,
    move_points
  };



  struct NewtonClock
  {
    void
    lap(const NewtonVerb verb)
    {
      stopwatch.lap(seconds[static_cast<unsigned int>(verb)]);
    }

    Stopwatch             stopwatch;
    std::array<double, 5> seconds{}; // by verb
  };



  /** Data of the nonlinear equations of a step; all by equation. */
  struct StepQuestion
  {
    std::vector<double> held;     // displacements of held components, m; else 0
    std::vector<double> external; // forces independent of displacements, N
    std::vector<double> followers_at_rest; // follower loads at zero u, N
    double inertia = 0; // factor of the mass, 1/s^2; zero in equilibrium
    // displacement without acceleration (predictor), m, and the norm of the
    // force that would stop it, N
    std::vector<double> inertial_displacement;
    double              former_momentum = 0;
    // Quasi-static, N: a scale of forces for what is unloaded and has none at
    // the end to compare with.
    double largest_former_force = 0;
  };



  /**
   * The displacement of a step by Newton's method, at first with full
   * corrections, which take fewer iterations; if these fail, with a line
   * search, which converges more often (doc/theory/implicit_steps.md).
   */
  template <int dim>
  class NewtonMethod
  {
  public:
    /** @p tolerance: share of the forces that may be out of balance. Equations,
     * mass and clock are those of the caller. */
    NewtonMethod(NewtonEquations<dim> &equations,
                 const NodalMass<dim> &mass,
                 const double          tolerance,
                 NewtonClock          &clock)
      : equations(equations)
      , mass(mass)
      , tolerance(tolerance)
      , clock(clock)
    {}

    using Values = std::vector<double>; // by equation

    /** Initial guess: the motion without acceleration, where its residual is
     * less than that of @p displacement. */
    void
    guess(const StepQuestion &question, Values &displacement);

    /** Iterate from the given displacement; false with an obstacle(). */
    bool
    find(const StepQuestion &question, Values &displacement);

    /** Why nothing was found. */
    const std::string &
    obstacle() const
    {
      return reason;
    }

    /** Iterations that led to the last displacement. */
    unsigned long
    iterations() const
    {
      return n_iterations;
    }

    /** Corrections (linear solutions) of all tries. */
    unsigned long
    corrections() const
    {
      return n_corrections;
    }

  private:
    bool
    solve(const StepQuestion &question, bool search, Values &displacement);
    double
    evaluate_residual(const StepQuestion &question,
                      const Values       &displacement,
                      Values             &residual);
    void
    renew_ghost_penalty(const StepQuestion &question,
                        const Values       &last,
                        Values             &displacement,
                        Values             &residual);
    double
    potential(const StepQuestion &question, const Values &displacement) const;
    bool
    improves(const StepQuestion &question,
             const Values       &correction,
             double              former_potential,
             double              former_residual,
             Values             &displacement,
             Values             &residual);

    /** Forces that the acceleration to a displacement takes, N. */
    Values
    inertial_forces(const StepQuestion &question,
                    const Values       &displacement) const;

    NewtonEquations<dim> &equations;
    const NodalMass<dim> &mass;
    const double          tolerance;
    NewtonClock          &clock;
    double                relative_residual = 0;
    std::string           reason;
    unsigned long         n_iterations = 0, n_corrections = 0;
  };
} // namespace limber

#endif
