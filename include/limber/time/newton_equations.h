// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_newton_equations_h
#define limber_time_newton_equations_h

#include <limber/fem/linear_solver.h>
#include <limber/grid/side_constraints.h>
#include <limber/stress/trial_stress.h>
#include <limber/time/follower_loads.h>
#include <limber/time/free_motions.h>
#include <limber/time/ghost_penalty.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  template <int dim>
  class AveragedVolumes;
  template <int dim>
  class NewtonTangent;



  /**
   * The equations of a step whose unknowns are the displacements of nodes in
   * it: nodes of occupied cells alone, dim equations each, in the order of
   * NumberedNodes. They are made anew when points have moved. For cells of one
   * size.
   *
   * Each rank finds what its points resist with; then every rank knows the
   * equations of all and solves them, alike to the last bit.
   *
   * Besides what the points resist with (TrialStress) there is the
   * GhostPenalty in equilibrium.
   */
  template <int dim>
  class NewtonEquations
  {
  public:
    /**
     * Up to @p largest_direct unknowns are factorised. More are solved for with
     * conjugate gradients, or where a body has averaged volumes and a bulk
     * modulus of @p mixed_beyond shear moduli and more, with linear functions,
     * in mixed form with generalised minimal residuals; unless the tangent is
     * not symmetric. Where conjugate gradients take more than @p
     * most_iterations, or generalised minimal residuals fail, up to @p
     * most_factorised unknowns are factorised instead, from then on.
     */
    explicit NewtonEquations(const RunParts<dim> &parts,
                             std::size_t  largest_direct  = default_direct,
                             double       mixed_beyond    = default_mixed,
                             std::size_t  most_factorised = default_most,
                             unsigned int most_iterations = 2000);
    ~NewtonEquations();

    /** Loads that evaluate() takes account of; those of the caller. */
    void
    set_followers(FollowerLoads<dim> *const of_scene)
    {
      followers = of_scene;
    }

    /**
     * Number the nodes of the cells that hold points, and find which components
     * the sides hold. Points must be sorted, and all of a cell on one rank.
     * Collective.
     */
    void
    begin_step();

    /** Of the unknowns. */
    std::size_t
    size() const
    {
      return nodes.size() * dim;
    }

    /** By number of equations / dim. */
    const NumberedNodes<dim> &
    numbered_nodes() const
    {
      return nodes;
    }

    bool
    is_held(const std::size_t equation) const
    {
      return held[equation] != 0;
    }

    /** The side that holds a component. */
    unsigned int
    side(const std::size_t equation) const
    {
      return side_of[equation];
    }

    /** Velocities of the sides at @p time, m/s; zero where nothing is held. */
    std::vector<double>
    held_velocities(double time);

    /**
     * Of what hangs together by faces of cells (with splines, which reach over
     * cells, by nodes), if something of it is not held.
     */
    std::optional<FreeMotion<dim>>
    free_motion() const;

    /**
     * Strain energy, the forces that resist these displacements, and on
     * request the tangent, to which the diagonal @p inertia (kg/s^2) is added.
     * False where a point is turned inside out. @p former: see TrialStress, may
     * be null. Collective.
     */
    bool
    evaluate(const std::vector<double> &displacement,
             const std::vector<double> *inertia,
             const std::vector<double> *former = nullptr);

    double
    energy() const
    {
      return total_energy;
    }

    /** Of it, what is against jumps of the strain, J. */
    double
    ghost_energy() const
    {
      return energy_of_jumps;
    }

    /** Of the mean of the forces against these jumps at the beginning of the
     * step, where there are none, and now, on the way of the step, J. */
    double
    ghost_work() const
    {
      return work_on_jumps;
    }

    /** Jumps are resisted from these displacements on; at the beginning of a
     * step, from none. */
    void
    count_jumps_from(const std::vector<double> &displacement)
    {
      begin_of_jumps = displacement;
    }

    /** Forces this small are noise after these displacements: stresses know a
     * strain to the last bits of these. */
    double
    round_off(const std::vector<double> &displacement) const;

    const std::vector<double> &
    forces() const
    {
      return total_forces;
    }

    /** Of follower loads at the last displacement, N; zero without any. */
    const std::vector<double> &
    follower_forces() const
    {
      return forces_of_followers;
    }

    /**
     * The correction of displacements by the last tangent, with held
     * components corrected by @p of_held, to the last bit. False where there is
     * none, with an obstacle().
     */
    bool
    solve(const std::vector<double> &unbalanced,
          const std::vector<double> &of_held,
          std::vector<double>       &correction);

    /** Why solve() found nothing. */
    const std::string &
    obstacle() const
    {
      return why_unsolved;
    }

    /** Iterations have failed last time, and there are too many unknowns to
     * factorise. */
    bool
    is_too_large() const
    {
      return too_large;
    }

    /** What iterations failed with, as the subject and verb of a sentence;
     * empty as long as they did not. */
    const std::string &
    failure_of_iterations() const
    {
      return failed_iterations;
    }

    /** Of conjugate gradients or generalised minimal residuals, in all. */
    unsigned long
    linear_iterations() const
    {
      return n_linear_iterations;
    }

    /** Cells have pressures of their own where equations are iterated. */
    bool
    is_mixed() const
    {
      return mixed;
    }

    /** Iterations have failed; all is factorised since. */
    bool
    gave_up_iterating() const
    {
      return factorises_all;
    }

    /** Let the points take these displacements. */
    AcceptedMotion
    accept(const std::vector<double> &displacement);

  private:
    // faster than iterations up to here
    static constexpr std::size_t default_direct = dim == 2 ? 60000 : 3000;
    // takes minutes and some gigabytes beyond
    static constexpr std::size_t default_most = dim == 2 ? 400000 : 30000;
    // less work than conjugate gradients from here on: nu = .475
    static constexpr double default_mixed = 20;

    double
    largest_modulus() const;
    std::vector<double>
    moduli_of_penalty() const;
    void
    find_held();
    void
    find_places();
    void
    add_volume(std::size_t                          body,
               typename NumberedNodes<dim>::Numbers numbers,
               CellResponse                        &response);
    void
    condense_volumes();
    std::vector<double>
    rigid_motions() const;
    bool
    is_iterated() const
    {
      return size() > largest_direct && !factorises_all;
    }
    unsigned int
    solve_condensed(NodalVector &solution, const NodalVector &right_side);
    void
    spread(const std::vector<double> &displacement,
           std::vector<double>       &on_grid) const;

    const RunParts<dim> parts;
    const std::size_t   largest_direct, most_factorised;
    bool                mixed = false;
    std::vector<std::unique_ptr<const TrialStress<dim>>> responses; // by body
    SideConstraints<dim>                                 constraints;
    NumberedNodes<dim>                                   nodes;
    std::vector<unsigned char>      held, side_of; // by equation
    GhostPenalty<dim>               ghost;
    std::vector<double>             begin_of_jumps, since_jumps;
    std::vector<dealii::Point<dim>> places; // of nodes, as the step begins
    std::vector<double>             displacement_of_tangent; // m
    std::vector<double>             by_node, former_by_node; // displacements, m
    std::vector<double>             total_forces, forces_of_followers;
    FollowerLoads<dim>             *followers = nullptr; // or none
    double total_energy = 0, energy_of_jumps = 0, work_on_jumps = 0, noise = 0;
    // what is in the matrix, and what is kept apart in mixed form
    const std::unique_ptr<NewtonTangent<dim>>   tangent;
    const std::unique_ptr<AveragedVolumes<dim>> volumes;
    std::optional<LinearSolver>                 solver;
    bool                                        is_factorised       = false;
    unsigned long                               n_linear_iterations = 0;
    bool                                        factorises_all      = false;
    bool                                        too_large           = false;
    std::string                                 why_unsolved, failed_iterations;
    const unsigned int                          most_iterations;
  };
} // namespace limber

#endif
