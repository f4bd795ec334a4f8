// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_health_figures_h
#define limber_output_health_figures_h

#include <limber/output/health.h>
#include <limber/output/totals.h>

#include <cstdint>
#include <functional>

/** @file Figures for the health of a run, computed from its points. */
namespace limber
{
  /**
   * Kinetic energy of the null space of P2G in each body, J: that of v - sum
   * N_i w_i with the nodal velocities w, common to all bodies, for which it is
   * smallest. Collective; as many passes over the points as it takes to find w,
   * at most some thirty for each component.
   */
  template <int dim>
  std::vector<double>
  unseen_energy(const State<dim> &state);

  /** Figures of volume and shape of the bodies that need the points at their
   * initial places. Collective. */
  template <int dim>
  void
  look_at_seeding(const State<dim> &start, std::vector<BodyFigures> &bodies);

  /** How many cells the points of solids have entered. Collective. */
  template <int dim>
  void
  look_at_crossings(const State<dim> &state, std::vector<BodyFigures> &bodies);

  /**
   * How the points are spread over cells. Collective; only the first rank gets
   * the answer.
   */
  template <int dim>
  void
  look_at_cells(const State<dim> &state, std::vector<BodyFigures> &bodies);



  /** Penetration of the points of all bodies into each obstacle. Collective. */
  template <int dim>
  std::vector<ObstacleFigures>
  look_at_obstacles(const State<dim> &state);



  /** Points and volume of a body in one cell of a lattice. */
  struct CellCount
  {
    std::uint64_t place; // in the lattice, x fastest
    std::uint64_t points;
    double        volume = 0; // that these stand for, m^dim
  };



  /** Cells of a lattice that hold points of a body. */
  struct CellCounts
  {
    std::vector<CellCount> cells; // by place, ascending

    CellCount
    in(std::uint64_t place) const; // no points: none
  };

  /**
   * Inner, single and gap cells of the body @p b from the counts of all, on a
   * lattice with @p n cells along each axis. A gap is an empty cell, or two
   * side by side, between two cells of the body along an axis.
   */
  template <int dim>
  void
  look_at_counts(const std::vector<CellCounts>       &counts,
                 const std::array<unsigned int, dim> &n,
                 std::size_t                          b,
                 BodyFigures                         &body);

  /**
   * Clumping: volume of all points in inner cells of the body @p b, over that
   * of these cells; only cells of @p is_open count. 1 if there are less than
   * sixteen.
   */
  template <int dim>
  double
  filling(const std::vector<CellCounts>            &counts,
          const std::array<unsigned int, dim>      &n,
          double                                    cell_volume,
          const std::function<bool(std::uint64_t)> &is_open,
          std::size_t                               b);



  /** Assesses a run from its start to its end. */
  template <int dim>
  class Health
  {
  public:
    /** With the points where the scene has placed them; collective. */
    explicit Health(const State<dim> &start);

    /**
     * @p totals and the scales of @p balance of the present state. Collective;
     * costs as much as some hundred steps. Only the first rank gets all
     * figures.
     */
    HealthFigures
    look(const State<dim>        &state,
         const Totals<dim>       &totals,
         const BalanceState<dim> &balance) const;

  private:
    std::vector<BodyFigures> at_start;
  };
} // namespace limber

#endif
