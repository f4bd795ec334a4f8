// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_implicit_pressure_h
#define limber_time_implicit_pressure_h

#include <limber/time/pressure_system.h>

namespace limber
{
  /**
   * Implicit pressure (projection method) of semi-implicit steps, for bodies
   * with the treatment `cell`: the pressure at the end of a step is solved
   * together with the velocity, so that sound does not limit the step (CFL).
   * With B the mean divergence of a medium in a cell times the volume V of its
   * points there, P its mean of J p and v* the velocity of the nodes without
   * these pressures,
   *
   *   v1 = v* + dt M^-1 B^T P1,
   *   C (P1 - P0) = - dt B v1 - gamma T P1,   C = V / kappa,
   *
   * where P0 and kappa = -J d(J p)/dJ are those of the mean J of the cell. The
   * liquids in a cell are one medium, of one pressure: C and C P0 are the sums
   * over them, B has the points of all (LiquidMeans), and each dilates by
   * (P0_k - P1)/kappa_k. This is one symmetric positive definite system, with
   * one unknown for each cell of each medium,
   *
   *   (C + dt^2 B M^-1 B^T + gamma T) P1 = C P0 - dt B v*.
   *
   * T is the checkerboard control (pressure jump stabilisation). It acts on
   * pressures in the kernel of B^T at nodes around which all cells are
   * occupied, those that alternate in two or more directions: with gamma = 1
   * the wide Laplacian B M^-1 B^T becomes the compact one. Its rows sum up to
   * zero: volume is exchanged between cells. It does not depend on the bulk
   * modulus, which may be as large as numbers are.
   *
   * Weight: inside a liquid, nodes weigh what they have room for, not what the
   * points near them happen to be: the pressures of cells carry the former, and
   * the difference would set water at rest in motion, most at nodes that
   * obstacles leave little room.
   *
   * Density control: where nodes have more material than there is room for, a
   * cell is to grow by a part e of its volume. The same matrix gives the nodal
   * displacement w that does it with the least motion,
   *
   *   (C + dt^2 B M^-1 B^T + gamma T) P_e = V e,   w = dt^2 M^-1 B^T P_e.
   *
   * Points are moved by w and keep velocity, pressure and J (T. Kugelstadt et
   * al., IEEE Trans. Vis. Comput. Graph. 27, 2021): as a part of the velocity
   * it would have to be stopped by the pressure of the next step.
   *
   * Components of nodes that a side holds have the entry zero in M^-1: the side
   * takes the pressure on them.
   *
   * The surface of an obstacle in a cut cell (CutCells) has a pressure q of its
   * own, as the mean flow A v through it must not enter the obstacle:
   *
   *   v1 = v* + dt M^-1 (B^T P1 + A^T q),  q >= 0,  A v1 >= A v_o,
   *
   * with complementarity. Nodes that obstacles hold one by one
   * (ObstacleContact) keep their velocity along the normal, until the obstacle
   * would have to pull. The impulses dt q of surfaces are given to the nodes by
   * ObstacleContact::exchange(), which starts from them.
   *
   * With a tension cutoff cells satisfy a complementarity condition as well:
   * P1 >= 0, and the cell grows at least as much as its equation says. Both are
   * solved by a primal-dual active set. Theory:
   * doc/theory/implicit_pressure.md.
   */
  template <int dim>
  class ImplicitPressure
  {
  public:
    ImplicitPressure(const RunParts<dim>     &parts,
                     BoundaryConditions<dim> &boundaries,
                     CutCells<dim>           *cut_cells,
                     ObstacleContact<dim>    *obstacles);

    /** Adopt a mesh that has changed. */
    void
    reinit();

    /**
     * Solve for the pressures of the step of length @p step (s) until the time
     * @p end, and add their effect to velocity and increment of advanced nodes,
     * on which no side has acted yet. Density control acts with the @p share of
     * what it does in a step of the largest length that motion allows. Energy
     * lost by compression goes into the ledger. Collective.
     */
    void
    solve(double end, double step, double share);

    /**
     * To be called if another velocity than the new one strains the liquids:
     * adds the mean divergence of the new one in this step to their dilations.
     * After sides and hanging nodes have been applied; collective.
     */
    void
    complete_dilations(double step);

    /**
     * Add w / dt of the density control to the new velocity, just before this
     * moves the points; where it strains them as well, that part is subtracted
     * from their dilations. Collective.
     */
    void
    correct_density(double step);

    /** Component of the displacement w of the density control at a node, m. */
    double
    density_displacement(const std::uint32_t node, const int d) const
    {
      return has_density_displacement ? way[std::size_t(node) * dim + d] : 0;
    }

    /**
     * After sides have been applied: add the kinetic energy that is lost to the
     * ledger. @p velocity_after is the slot of the velocity after the step, the
     * new or the re-mapped one.
     */
    void
    account(double step, unsigned int velocity_after);

    /** Shortest time in which sound crosses a cell in any of the bodies, s. */
    double
    time_of_sound() const;

    /** Component of the force of this step's pressures on a node, N. */
    double
    force_on(const std::uint32_t node, const int d) const
    {
      return force[std::size_t(node) * dim + d];
    }

    /** Whether a side holds a component of a node. */
    bool
    is_held(const std::uint32_t node, const int d) const
    {
      return !(system.mobility_of(node, d) > 0);
    }

    /** Effort of the solver so far. */
    struct Effort
    {
      unsigned long steps = 0, solutions = 0, iterations = 0;
      unsigned int  most_iterations = 0; // in a step
      unsigned long for_density     = 0; // further ones, for density control
    };

    const Effort &
    effort() const
    {
      return spent;
    }

  private:
    using Layout   = NodeLayout<dim>;
    using Medium   = typename PressureCells<dim>::Medium;
    using Record   = typename PressureCells<dim>::Record;
    using Result   = typename PressureCells<dim>::Result;
    using Part     = typename PressureSystem<dim>::Part;
    using HeldNode = typename PressureSystem<dim>::HeldNode;
    static constexpr unsigned int n_nodes = PressureCells<dim>::n_nodes;

    void
    keep_result(std::size_t medium);
    void
    find_dilations(std::size_t medium);
    void
    keep_dilation(Medium &medium, MaterialBody<dim> &body);
    double
    elastic_work(const MaterialBody<dim> &body,
                 const Part              &part,
                 double                   pressure) const;
    void
    meet_obstacles();
    bool
    is_held_otherwise(double end, double step, unsigned int k);
    std::vector<double>
    former_pressures() const;
    double
    solve_equations(double end, double step, double share);
    void
    sum_forces(const std::vector<double> &pressures, bool with_surfaces);
    void
    push_nodes(double step);
    void
    find_density_displacement(double step, double residual);
    template <class Field>
    void
    add_flow_to_dilations(Medium            &medium,
                          MaterialBody<dim> &body,
                          double             factor,
                          const Field       &field);
    void
    press_on_obstacles(double                     step,
                       const std::vector<double> &impulses_on_nodes);

    const RunParts<dim>         parts;
    ObstacleContact<dim> *const obstacles;      // or null
    const bool                  with_one_sided; // sides
    PressureCells<dim>          cells;
    PressureSystem<dim>         system;
    // Forces of the pressures, by node and component, N
    LazyArray<double> force;
    // Displacement w of the density control, likewise, m
    bool              has_density_displacement = false;
    LazyArray<double> way;
    PressureSolver    solver;
    Effort            spent;
  };
} // namespace limber

#endif
