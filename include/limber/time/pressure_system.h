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
   * The equations of the implicit pressure, see ImplicitPressure: their
   * pattern, C + dt^2 B M^-1 B^T + gamma T, and C P0 - dt B v*; V e; and those
   * of the pressures on the surfaces of obstacles.
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

    /** Adopt the numbers of the cells. */
    void
    find_columns();

    /**
     * Of nodes that are advanced without these pressures, on which no side has
     * acted yet, in a step of so many seconds until @p end; the density control
     * acts with this @p share.
     */
    void
    assemble(double end, double step, double share);

    /**
     * Rows and columns such that the diagonal is one, which makes the equations
     * of cells that hold little as large as others; and the pressures that
     * points bring, with which to start. Returns the size of the right side if
     * all volumes were to change by one. Collective.
     */
    double
    scale();

    /** Whether some pressures must not be negative: tension is cut off in any
     * of the bodies, or there are surfaces that can only push. */
    bool
    cuts_tension() const;

    /**
     * Where a solution asks for tension, let there be no pressure; and where
     * the cell would be compressed without one, let it have one again, if
     * @p may_return. Returns whether there is anything to be solved anew, from
     * the pressures as they are now. After scale(); collective.
     */
    bool
    cut_tension(bool may_return);

    /**
     * Let the right side be V e, where there is pressure, for the pressures
     * that would make the room. Returns whether any room is wanting. After the
     * pressures have been found; collective.
     */
    bool
    ask_for_room();

    /** What a force on a node does to its velocity within a step of so many
     * seconds, but for what holds it. */
    void
    push(std::uint32_t node, double step, double *force) const;

    /** Of nodes that obstacles hold: what they are to do in a new step. */
    void
    meet_nodes(const std::vector<HeldNode> *held);

    /**
     * Let nodes go that an obstacle would have to pull, and hold those that
     * come near, if they @p may_return, with the forces of all pressures at
     * Layout::pressure_force. Returns whether there are any, so that all has to
     * be assembled and solved anew. Collective.
     */
    bool
    release_nodes(double step, bool may_return);

    /** What one-sided sides are to do to nodes in a new step until @p end, by
     * the forces of expected pressures at Layout::pressure_force. */
    void
    expect_at_sides(double end, double step);

    /**
     * The same with the forces of all pressures: hold what presses, let go what
     * sides would have to pull, if they @p may_release, and rub what slides.
     * Returns whether the equations have not known it, so that all has to be
     * assembled and solved anew. Collective.
     */
    bool
    meet_sides(double end, double step, bool may_release);

    /** What holds the nodes of meet_nodes() across the surface, kg m/s, with
     * the forces of all pressures at Layout::pressure_force; nothing where they
     * are let go. */
    std::vector<double>
    impulses_on_nodes(double step) const;

    /** The part of gamma T P in a cell, m^3, with the pressures that cells
     * know of each other. */
    double
    flux(std::size_t medium, std::uint32_t cell) const;

    /** 1/m of a component of a node, or 0 where a side holds it. */
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
    std::vector<double> pressures;     // P1, Pa; over the scales while solved
    std::vector<double> scales;        // of rows and columns
    std::vector<unsigned char> is_cut; // its tension; empty: none is

    /** What a body is in a cell. */
    struct Part
    {
      double volume;       // V, m^3
      double pressure;     // P0 of this body, Pa
      double compliance;   // V/kappa, m^3/Pa
      double volume_ratio; // mean J of its points, or what a law has for it
    };

    /** Of @p mass kg in a cell of this rank. */
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

    // What one-sided sides do to a node
    struct AtSide
    {
      std::uint32_t node;
      unsigned int  held;     // components (bits) that are at rest
      Vector        friction; // on the others, m/s

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
    opening(std::uint32_t row) const;
    void
    exclude_cut();
    void
    find_pattern_scales(double step);
    double
    excess(std::uint32_t cell, std::uint32_t node, double density) const;
    double
    excess_in(double room, std::uint32_t node, double density) const;
    void
    sum_volumes();
    void
    find_surface();
    double
    excess_over_levels(std::uint32_t node, double density) const;

    const RunParts<dim>      parts;
    BoundaryConditions<dim> &boundaries;
    PressureCells<dim>      &cells;
    unsigned int             in_body = 0; // places of a medium in a row
    unsigned int of_cells = 0; // of all media; those of surfaces follow
    // By node and component: 1/m, or 0 where a side holds it; and the velocity
    // without the pressures, or that of the side
    LazyArray<double> mobility, velocity;
    // By medium and node, for T: gamma dt^2 <V^2/m> / 4^(dim - 1) where all
    // cells around are occupied, else 0
    std::vector<LazyArray<double>> pattern_scales;
    // By place in a row: the cell, or piece of surface, that it stands for
    std::vector<std::uint32_t> mates;
    const bool                 controls_density; // of any body
    // By node, m^3: what liquids take of the room around it; only
    // where a density control of several bodies asks for it
    const bool        needs_volumes;
    LazyArray<double> volumes;
    // Only with a density control; by node, how many of the cells around it are
    // at a surface
    Surroundings<dim>   surroundings;
    LazyArray<double>   at_surface;
    RecordExchange      node_exchange{1};
    std::vector<AtSide> at_sides; // by nodes
    // Of a node that obstacles hold: orthogonal directions that are held
    struct Held
    {
      std::uint32_t           node;
      unsigned int            n = 0;
      std::array<Vector, dim> directions;
      // By direction: of what has to be met, the part along it of the normal,
      // and the number
      std::array<double, dim>      along;
      std::array<std::size_t, dim> contacts;
    };
    const std::vector<HeldNode> *to_hold = nullptr;
    std::vector<char>            is_released; // of these
    std::vector<Held>            held;
    LazyArray<std::uint32_t>     held_as; // by node, 1 + place in these, or 0
    // By row, whether none of the bodies in the cell bears tension
    std::vector<unsigned char> may_be_cut;
    // Matrix and right side of all cells, where some are cut off
    std::vector<double> whole, whole_right_side;
  };
} // namespace limber

#endif
