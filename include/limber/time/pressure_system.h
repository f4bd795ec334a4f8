// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_pressure_system_h
#define limber_time_pressure_system_h

#include <limber/grid/boundary_conditions.h>
#include <limber/time/obstacle_contact.h>
#include <limber/time/pressure_cells.h>
#include <limber/time/pressure_solver.h>
#include <limber/time/surroundings.h>

#include <vector>

namespace limber
{
  /**
   * The linear system of the implicit pressure, see ImplicitPressure: sparsity
   * pattern, matrix C + dt^2 B M^-1 B^T + gamma T (Schur complement, as
   * velocities are eliminated with the lumped mass), right-hand sides C P0 - dt
   * B v* and V e (density control), and the rows of the pressures on surfaces
   * of obstacles.
   */
  template <int dim>
  class PressureSystem
  {
  public:
    using Medium   = typename PressureCells<dim>::Medium;
    using Vector   = dealii::Tensor<1, dim>;
    using HeldNode = typename ObstacleContact<dim>::HeldNode;

    PressureSystem(const RunParts<dim>     &parts,
                   BoundaryConditions<dim> &boundaries,
                   PressureCells<dim>      &cells);

    /** Adopt a mesh that has changed. */
    void
    reinit();

    /** Build the sparsity pattern, after cells have been renumbered. */
    void
    find_columns();

    /**
     * Find the free surface and how much nodes hold. Inside a liquid add to
     * velocity and increment of nodes what their weight lacks, in a step of so
     * many seconds, to that of the liquid which they have room for, see
     * ImplicitPressure. First in a step; collective.
     */
    void
    weigh(double step);

    /** What weigh() has added to the mass that weighs at a node, kg. */
    double
    missing_mass_of(const std::uint32_t node) const
    {
      return levels_weights ? missing_mass[node] : 0;
    }

    /**
     * Assemble matrix and right-hand side from nodes that are advanced without
     * these pressures, before any boundary condition, in a step of so many
     * seconds until @p end; the density control acts with this @p share.
     */
    void
    assemble(double end, double step, double share);

    /**
     * Scale rows and columns symmetrically to a diagonal of ones, so that the
     * equations of hardly filled (cut) cells weigh as much as others; and set
     * the initial guess, the mean pressure of the points. Returns the norm of
     * the right-hand side if all volumes were to change by 100 %, a scale for
     * residuals. Collective.
     */
    double
    scale();

    /** Whether there are constraints P >= 0: tension cutoff in any of the
     * bodies, or surfaces of obstacles, which can only push. */
    bool
    cuts_tension() const;

    /**
     * One update of the active set: rows with negative pressure are removed
     * (P = 0); removed ones return whose cell would be compressed without
     * pressure, or whose surface the liquid would enter, if @p may_return.
     * Returns whether the set has changed and the system is to be solved again,
     * from the pressures as they are now. After scale(); collective.
     */
    bool
    cut_tension(bool may_return);

    /**
     * Set the right-hand side to V e, where there is pressure, for the
     * pressures P_e of the density control. Returns whether e is other than
     * zero anywhere. After the pressures have been found; collective.
     */
    bool
    set_density_source();

    /** Turn a force on a node, N, into its change of velocity dt M^-1 f in a
     * step of so many seconds, m/s, without what sides and obstacles hold. */
    void
    push(std::uint32_t node, double step, double *force) const;

    /** Begin a step with these nodes that obstacles hold one by one; the list
     * remains that of the caller. */
    void
    meet_nodes(const std::vector<HeldNode> *held);

    /**
     * Update the active set of these nodes: release those that an obstacle
     * would have to pull, and hold those again that approach, if they @p
     * may_return, with the forces of all pressures at Layout::pressure_force.
     * Returns whether it has changed, so that all has to be assembled and
     * solved again. Collective.
     */
    bool
    release_nodes(double step, bool may_return);

    /**
     * Predict what one-sided sides (separating, friction) do to nodes in a new
     * step until @p end, by the forces of expected pressures at
     * Layout::pressure_force.
     */
    void
    expect_at_sides(double end, double step);

    /**
     * The same with the forces of all pressures: hold nodes that press, release
     * those that sides would have to pull, if they @p may_release, and find the
     * friction on those that slide. Returns whether this differs from what the
     * equations assumed, so that all has to be assembled and solved again.
     * Collective.
     */
    bool
    meet_sides(double end, double step, bool may_release);

    /**
     * Normal contact impulses on the nodes of meet_nodes(), kg m/s, with the
     * forces of all pressures at Layout::pressure_force; zero at released
     * nodes.
     */
    std::vector<double>
    impulses_on_nodes(double step) const;

    /** Entry of gamma T P (checkerboard control) of a cell, m^3, with the
     * pressures that ranks have shared. */
    double
    flux(std::size_t medium, std::uint32_t cell) const;

    /**
     * Entry of M^-1: 1/m of a component of a node, or 0 where a side holds it.
     */
    double
    mobility_of(const std::uint32_t node, const int d) const
    {
      return mobility[std::size_t(node) * dim + d];
    }

    PressureEquations equations;

    // By row
    struct Former
    {
      double pressure;   // P0, Pa
      double compliance; // C, m^3/Pa
    };
    std::vector<Former> former;
    std::vector<double> growth;        // e
    std::vector<double> pressures;     // P1, Pa; divided by scales while solved
    std::vector<double> scales;        // of rows and columns: 1/sqrt(diagonal)
    std::vector<unsigned char> is_cut; // removed by active set; empty: none

    /** Contribution of a body to a cell of its medium. */
    struct Part
    {
      double volume;       // V, m^3
      double pressure;     // P0 of this body, Pa
      double compliance;   // V/kappa, m^3/Pa
      double volume_ratio; // mean J of its points, or the law's measure
    };

    /** Of a body that has @p mass kg in a cell of this rank. */
    Part
    part_of(const Medium            &medium,
            const MaterialBody<dim> &body,
            std::uint32_t            cell,
            double                   mass) const;

  private:
    using Layout = NodeLayout<dim>;
    using Record = typename PressureCells<dim>::Record;
    using Result = typename PressureCells<dim>::Result;
    using Piece  = typename PressureSurfaces<dim>::Piece;
    static constexpr unsigned int n_nodes = PressureCells<dim>::n_nodes;

    // Action of one-sided sides on a node
    struct AtSide
    {
      std::uint32_t node;
      unsigned int  held;     // bits: components at rest
      Vector        friction; // change of the others, m/s

      bool
      holds(const int d) const
      {
        return held >> d & 1;
      }
    };

    void
    hold_nodes(double end);
    void
    assemble_row(std::size_t   medium,
                 std::uint32_t cell,
                 std::uint32_t row,
                 double        step,
                 double        share);
    void
    couple_over_levels(const double *entries,
                       std::uint32_t cell,
                       std::uint32_t row,
                       double        step);
    void
    couple(const double *entries,
           std::uint32_t cell,
           std::uint32_t row,
           double        step);
    void
    couple_on_lattice(const double *entries,
                      std::uint32_t cell,
                      std::uint32_t row,
                      double        step);
    template <class Work>
    void
    for_each_row(const Work &work) const
    {
      for (const Medium &medium : cells.media)
        for (std::size_t k = 0; k < medium.cells.size(); ++k)
          work(medium.first + k, medium.cells[k]);
      for (std::uint32_t k = 0; k < cells.surfaces.n_of_rank(); ++k)
        work(cells.first_of_surfaces() + k, cells.surfaces.pieces[k].cell);
    }
    std::vector<std::uint32_t>
    coupled_to(std::uint32_t cell) const;
    unsigned int
    most_surfaces_near() const;
    std::size_t
    surface_entry(std::uint32_t row, std::uint32_t piece) const;
    void
    couple_surfaces(std::uint32_t node,
                    const double *scaled,
                    std::uint32_t row);
    void
    assemble_surfaces(double step);
    double
    scale_of(const std::size_t at, const unsigned int place) const
    {
      return of_mate(
        at,
        place,
        [](const double *const result) { return result[Result::scale]; },
        [](const auto &piece) { return piece.scale; });
    }
    double
    scale_surfaces();
    void
    hold_by_sides(double end);
    std::vector<AtSide>
    find_at_sides(double end, double step);
    void
    hold_by_obstacles();
    void
    move(std::uint32_t node, double *vector) const;
    const double *
    covered_corners() const;
    bool
    is_at_obstacle(std::uint32_t node) const;
    template <class OfCell, class OfPiece>
    double
    of_mate(const std::size_t  at,
            const unsigned int place,
            const OfCell      &of_cell,
            const OfPiece     &of_piece) const
    {
      if (place < of_cells)
        return of_cell(cells.media[place / in_body].result(mates[at]));
      return of_piece(cells.surfaces.pieces[mates[at]]);
    }
    void
    find_columns_of_lattice();
    void
    find_columns_over_levels();
    bool
    is_inside(const Medium &medium, std::uint32_t node) const;
    std::size_t
    entry_of(std::uint32_t row, std::size_t medium, std::uint32_t cell) const;
    double
    row_residual(std::uint32_t row) const;
    void
    exclude_cut();
    void
    find_pattern_scales(double step);
    double
    nodal_volume(std::uint32_t node) const;
    double
    nodal_volume_over_levels(std::uint32_t node) const;
    double
    excess(std::uint32_t node) const;
    void
    sum_volumes();
    void
    find_surface();

    const RunParts<dim>      parts;
    BoundaryConditions<dim> &boundaries;
    PressureCells<dim>      &cells;
    unsigned int             in_body = 0; // columns of a medium in a row
    unsigned int of_cells = 0; // of all media; those of surfaces follow
    // By node and component: M^-1, i.e. 1/m, or 0 where a side holds it; and
    // v*, the velocity without the pressures, or that of the side
    LazyArray<double> mobility, velocity;
    // By medium and node, factor of T: gamma dt^2 <V^2/m> / 4^(dim - 1) where
    // all cells around are occupied, else 0
    std::vector<LazyArray<double>> pattern_scales;
    // By entry of the matrix: the cell, or piece of surface, of its column
    std::vector<std::uint32_t> mates;
    const bool                 controls_density; // of any body
    const bool levels_weights; // where weight acts on liquids alone
    // By node: the mass that it has room for less its own, kg
    LazyArray<double> missing_mass;
    // Only where either is done, by node: current volume of the liquids around
    // it, m^3 (P2G), and how many of the cells around it are at the free
    // surface
    const bool          looks_at_nodes;
    LazyArray<double>   volumes;
    Surroundings<dim>   surroundings;
    LazyArray<double>   at_surface;
    RecordExchange      node_exchange{1};
    std::vector<AtSide> at_sides; // by nodes
    // Node held by obstacles, and its held directions: contact normals after
    // Gram-Schmidt orthonormalisation
    struct Held
    {
      std::uint32_t           node;
      unsigned int            n = 0;
      std::array<Vector, dim> directions;
      // By direction: component along it of the contact normal, and the index
      // of the contact in to_hold
      std::array<double, dim>      along;
      std::array<std::size_t, dim> contacts;
    };
    const std::vector<HeldNode> *to_hold = nullptr;
    std::vector<char>            is_released; // by entry of to_hold
    std::vector<Held>            held;
    LazyArray<std::uint32_t>     held_as; // by node, 1 + place in these, or 0
    // By row, whether P >= 0 is required, as none of the bodies in the cell
    // bears tension
    std::vector<unsigned char> may_be_cut;
    // Full matrix and right-hand side, while the active set removes rows
    std::vector<double> whole, whole_right_side;
  };
} // namespace limber

#endif
