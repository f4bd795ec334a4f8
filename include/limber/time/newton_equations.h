// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_newton_equations_h
#define limber_time_newton_equations_h

#include <limber/fem/free_motions.h>
#include <limber/fem/linear_solver.h>
#include <limber/grid/side_constraints.h>
#include <limber/stress/trial_stress.h>
#include <limber/time/follower_loads.h>
#include <limber/time/ghost_penalty.h>
#include <limber/time/grid_reset.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  template <int dim>
  class AveragedVolumes;
  template <int dim>
  class NodalMass;
  template <int dim>
  class NewtonTangent;



  /** What accelerations take of forces, by displacements: a multiple of the
   * mass. */
  template <int dim>
  struct Inertia
  {
    const NodalMass<dim> &mass;
    double                factor; // 1/s^2; zero in equilibrium
  };



  /**
   * The nonlinear equations of a step in the displacements of nodes: nodes of
   * occupied cells alone, dim equations each, in the order of NumberedNodes.
   * They are set up anew when points have moved.
   *
   * Each rank finds internal forces and tangents of its points, which are
   * summed; then every rank solves all equations, alike to the last bit.
   *
   * Besides the internal forces (TrialStress) there is the GhostPenalty in
   * quasi-static steps.
   */
  template <int dim>
  class NewtonEquations
  {
  public:
    /**
     * Up to @p largest_direct unknowns are factorised. Larger systems are
     * solved by conjugate gradients, or where a body has averaged volumes and a
     * bulk modulus of @p mixed_beyond shear moduli and more, with linear
     * functions, in mixed form (displacements and pressures) by generalised
     * minimal residuals (GMRES); unless the tangent is not symmetric. Where
     * conjugate gradients take more than @p most_iterations, or GMRES fails, up
     * to @p most_factorised unknowns are factorised instead, from then on.
     */
    explicit NewtonEquations(const RunParts<dim> &parts,
                             std::size_t  largest_direct  = default_direct,
                             double       mixed_beyond    = default_mixed,
                             std::size_t  most_factorised = default_most,
                             unsigned int most_iterations = 2000);
    ~NewtonEquations();

    /** Follower loads that evaluate() includes; those of the caller. */
    void
    set_followers(FollowerLoads<dim> *const of_scene)
    {
      followers = of_scene;
    }

    /**
     * Number the nodes of the cells that hold points, and find which components
     * the sides hold. Points must be sorted, and all of a cell on one rank.
     * False if the cells are those of the step before. Collective.
     */
    bool
    begin_step();

    /** The mesh, or the points of this rank, have been replaced. */
    void
    reinit()
    {
      nodes.forget();
    }

    /** Whether any body flows plastically: its potential has no least value
     * beyond the limit load. */
    bool
    any_flows() const
    {
      return std::any_of(parts.bodies.begin(),
                         parts.bodies.end(),
                         [](const auto &body) {
                           return body->description.is_plastic;
                         });
    }

    /** Number of unknowns. */
    std::size_t
    size() const
    {
      return nodes.size() * dim;
    }

    /** The nodes: equation k belongs to node k / dim. */
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
     * A rigid body motion that the sides leave free, if there is one, of any
     * part that is connected by faces of cells (with splines, whose support is
     * wider, by nodes).
     */
    std::optional<FreeMotion<dim>>
    free_motion() const;

    /**
     * Find strain energy and internal forces at these displacements, and on
     * request the tangent, to which @p inertia is added. False where a point is
     * inverted (det F <= 0). @p former: see TrialStress, may be null.
     * Collective.
     */
    bool
    evaluate(const std::vector<double> &displacement,
             const Inertia<dim>        *inertia,
             const std::vector<double> *former = nullptr);

    /** Strain energy of the last evaluate(), with the ghost penalty, J. */
    double
    energy() const
    {
      return total_energy;
    }

    /** Part of it in the ghost penalty, J. */
    double
    ghost_energy() const
    {
      return energy_of_jumps;
    }

    /** Work of the ghost penalty on the displacement of the step, by the mean
     * of its forces at the beginning, where there are none, and now, J. */
    double
    ghost_work() const
    {
      return work_on_jumps;
    }

    /** Of the GridReset; null: at rest. */
    void
    expect(const std::vector<double> *const displacement)
    {
      known_at.clear();
      if (displacement != nullptr)
        reset.expect(*displacement);
      else
        reset.expect_nothing();
    }

    /** Work on the displacement of the step of the mean of the forces of the
     * GridReset at both ends, J. */
    double
    reset_work() const
    {
      return work_on_reset;
    }

    /** The ghost penalty acts on the displacement beyond this one; at the
     * beginning of a step, beyond zero. */
    void
    count_jumps_from(const std::vector<double> &displacement)
    {
      if (begin_of_jumps != displacement)
        known_at.clear();
      begin_of_jumps = displacement;
    }

    /** Norm of forces that are round-off at these displacements: stresses know
     * a strain to the last bits of these. */
    double
    round_off(const std::vector<double> &displacement) const;

    /** Internal forces of the last evaluate(), with the ghost penalty, N. */
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
     * Newton's correction of the displacements by the last tangent, from the
     * residual @p unbalanced; held components are corrected by @p of_held, to
     * the last bit. False if there is none, with an obstacle().
     */
    bool
    solve(const std::vector<double> &unbalanced,
          const std::vector<double> &of_held,
          std::vector<double>       &correction);

    /**
     * Whether the last tangent is positive along its softest motion, as far as
     * that is found: the equilibrium is a minimum of the potential. Not so of a
     * straight column above its buckling load. True before there is a tangent.
     */
    bool
    is_stable();

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

    /** Iterative solutions use the mixed form, with pressures of cells. */
    bool
    is_mixed() const
    {
      return mixed;
    }

    /** Equations are solved by iterations; else by a factorisation, which
     * serves several right-hand sides. */
    bool
    is_iterated() const
    {
      return size() > largest_direct && !factorises_all;
    }

    /** Iterations have failed; all is factorised since. */
    bool
    gave_up_iterating() const
    {
      return factorises_all;
    }

    /** How far these displacements move any point along an axis at most, over
     * the edge of the finest cells. Collective. */
    double
    longest_way(const std::vector<double> &displacement);

    /** Update the points by these displacements. */
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
    add_volume(std::size_t body, std::size_t cell, CellResponse &response);
    void
    condense_volumes();
    std::vector<double>
    rigid_motions() const;
    SolutionMethod
    solution_method() const;
    bool
    knows_forces_at(const std::vector<double> &displacement) const;
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
    GridReset<dim>                  reset;
    std::vector<double>             moduli; // of the penalty, by cell, Pa
    std::vector<double>             begin_of_jumps, since_jumps;
    std::vector<dealii::Point<dim>> places; // of nodes, as the step begins
    std::vector<double>             displacement_of_tangent; // m
    std::vector<double>             by_node, former_by_node; // displacements, m
    std::vector<double>             total_forces, forces_of_followers;
    std::vector<double> known_at; // displacement of the forces; empty: none
    FollowerLoads<dim> *followers = nullptr; // or none
    double total_energy = 0, energy_of_jumps = 0, work_on_jumps = 0,
           work_on_reset = 0, noise = 0;
    // what is in the matrix, and what is kept apart in mixed form
    const std::unique_ptr<NewtonTangent<dim>>   tangent;
    const std::unique_ptr<AveragedVolumes<dim>> volumes;
    std::optional<LinearSolver>                 solver;
    bool                                        is_factorised = false;
    bool               set_up_serves = false; // multigrid of a former tangent
    unsigned int       iterations_of_set_up = 0;
    unsigned long      n_linear_iterations  = 0;
    bool               factorises_all       = false;
    bool               too_large            = false;
    std::string        why_unsolved, failed_iterations;
    const unsigned int most_iterations;
  };
} // namespace limber

#endif
