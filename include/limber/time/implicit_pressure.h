// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_implicit_pressure_h
#define limber_time_implicit_pressure_h

#include <limber/time/pressure_system.h>

namespace limber
{
  /**
   * The pressure of bodies that are averaged over cells, at the end of a step
   * and together with the velocity that it leaves: sound then does not limit
   * the step. With B the mean divergence of a medium in a cell times the volume
   * V of its points there, P its mean of J p and v* the velocity of the nodes
   * without these pressures,
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
   * T sees the patterns that B^T does not let act on any node around which all
   * cells are occupied, those that alternate in two directions or more: with
   * gamma = 1 the wide Laplacian B M^-1 B^T becomes the compact one. Its rows
   * sum up to zero: volume goes from cell to cell. It does not depend on the
   * bulk modulus, which may be as large as numbers are.
   *
   * Where nodes have more material than there is room for, a cell is to grow by
   * a part e of its volume. The same matrix finds the way w of nodes that does
   * it with the least motion,
   *
   *   (C + dt^2 B M^-1 B^T + gamma T) P_e = V e,   w = dt^2 M^-1 B^T P_e.
   *
   * Points go this way and keep velocity, pressure and J (T. Kugelstadt et al.,
   * IEEE Trans. Vis. Comput. Graph. 27, 2021): as a part of the velocity it
   * would have to be stopped by the pressure of the next step.
   *
   * Sides that hold a component of a node take the pressure on it: its entry
   * of M^-1 is zero.
   *
   * A liquid presses on the surface of an obstacle in a cell (CutCells) with a
   * pressure q of its own, as the mean flow A v over it must not enter:
   *
   *   v1 = v* + dt M^-1 (B^T P1 + A^T q),  q >= 0,  A v1 >= A v_o,
   *
   * one of both being an equality. Nodes that obstacles hold one by one
   * (ObstacleContact) keep their velocity along the normal, until the obstacle
   * would have to pull. The impulses dt q of surfaces are what
   * ObstacleContact::exchange() starts from, which gives them to the nodes.
   *
   * Where a body bears no tension, the equation of a cell is that P1 >= 0, that
   * it grows at least as much, and that one of both is an equality.
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
     * To advanced nodes, on which no side has acted yet, of a step of so many
     * seconds until @p end: the pressures of the bodies, and what they change
     * in velocity and increment. The density control of a body acts with this
     * @p share of what it would do in a step as long as motion allows. What
     * compression loses in energy goes into the ledger. Collective.
     */
    void
    solve(double end, double step, double share);

    /**
     * Let liquids be strained by another velocity than the new one: complete
     * their dilations by the mean divergence of the new one in this step.
     * When sides have acted, hanging nodes too; collective.
     */
    void
    complete_dilations(double step);

    /**
     * Add to the new velocity what makes room (see above), when it is to move
     * points and does nothing else any more: where it strains them as well,
     * this part is taken out of their dilations. Collective.
     */
    void
    make_room(double step);

    /** The way that make_room() adds to a component of a node, m. */
    double
    way_to_room(const std::uint32_t node, const int d) const
    {
      return has_way_to_room ? way[std::size_t(node) * dim + d] : 0;
    }

    /**
     * When sides have acted: the kinetic energy that is lost, likewise. The
     * velocity after the step is the new one, or the re-mapped one.
     */
    void
    account(double step, unsigned int velocity_after);

    /** The shortest in which sound crosses a cell in any of the bodies, s. */
    double
    time_of_sound() const;

    /** Of the pressures of this step on a component of a node, N. */
    double
    force_on(const std::uint32_t node, const int d) const
    {
      return force[std::size_t(node) * dim + d];
    }

    /** Whether a side has held it. */
    bool
    is_held(const std::uint32_t node, const int d) const
    {
      return !(system.mobility_of(node, d) > 0);
    }

    /** What the solver has been asked to do so far. */
    struct Effort
    {
      unsigned long steps = 0, solutions = 0, iterations = 0;
      unsigned int  most_iterations = 0; // in a step
      unsigned long for_room        = 0; // iterations, not among these
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
    find_way_to_room(double step, double residual);
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
    // Of the pressures, by node and component, N
    LazyArray<double> force;
    // w, likewise, m
    bool              has_way_to_room = false;
    LazyArray<double> way;
    PressureSolver    solver;
    Effort            spent;
  };
} // namespace limber

#endif
