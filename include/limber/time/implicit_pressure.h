// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_implicit_pressure_h
#define limber_time_implicit_pressure_h

#include <limber/grid/boundary_conditions.h>
#include <limber/time/integrator.h>
#include <limber/time/pressure_solver.h>

#include <optional>
#include <vector>

namespace limber
{
  /**
   * The pressure of bodies that are averaged over cells, at the end of a step
   * and together with the velocity that it leaves: sound then does not limit
   * the step. With B the mean divergence of a body in a cell times the volume
   * V of its points there, P its mean of J p and v* the velocity of the nodes
   * without these pressures,
   *
   *   v1 = v* + dt M^-1 B^T P1,
   *   C (P1 - P0) = - dt B v1 - gamma T P1 + V e,   C = V / kappa,
   *
   * where P0 and kappa = -J d(J p)/dJ are those of the mean J of the cell. This
   * is one symmetric positive definite system, with one unknown for each cell
   * of each body,
   *
   *   (C + dt^2 B M^-1 B^T + gamma T) P1 = C P0 - dt B v* + V e.
   *
   * T sees the patterns that B^T does not let act on any node around which all
   * cells are occupied, those that alternate in two directions or more: with
   * gamma = 1 the wide Laplacian B M^-1 B^T becomes the compact one. Its rows
   * sum up to zero: volume goes from cell to cell. e is that part of its volume
   * by which a cell is to grow as its nodes have more material than there is
   * room for. Neither depends on the bulk modulus, which may be as large as
   * numbers are.
   *
   * Sides that hold a component of a node take the pressure on it: its entry
   * of M^-1 is zero.
   */
  template <int dim>
  class ImplicitPressure
  {
  public:
    ImplicitPressure(const RunParts<dim>     &parts,
                     BoundaryConditions<dim> &boundaries);

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
     * When sides have acted: the kinetic energy that is lost, likewise. The
     * velocity after the step is the new one, or the re-mapped one.
     */
    void
    account(double step, unsigned int velocity_after);

    /** The shortest in which sound crosses a cell in any of the bodies, s. */
    double
    time_of_sound() const;

    /** What the solver has been asked to do so far. */
    struct Effort
    {
      unsigned long steps = 0, iterations = 0;
      unsigned int  most_iterations = 0; // in a step
    };

    const Effort &
    effort() const
    {
      return spent;
    }

  private:
    using Layout                          = NodeLayout<dim>;
    static constexpr unsigned int n_nodes = 1 << dim;

    /** What ranks tell each other of a cell of a body. */
    struct Record
    {
      static constexpr unsigned int number = 0; // of the unknown, from 1 on
      static constexpr unsigned int mass   = 1; // kg
      static constexpr unsigned int moment = 2; // sum of m J p, kg Pa
      static constexpr unsigned int rows   = 3; // B by nodes, m^2 or m
      static constexpr unsigned int stride = rows + n_nodes * dim;
    };

    /** Pressure and dilation, for ranks that have points in a cell. */
    struct Result
    {
      static constexpr unsigned int pressure = 0, dilation = 1;
      static constexpr unsigned int scale  = dilation; // while it is solved
      static constexpr unsigned int stride = 2;
    };

    /** A body whose pressure is implicit. */
    struct Liquid
    {
      MaterialBody<dim> *body;
      LazyArray<double>  records; // by cell
      // By node, the cell of the body at each place around it, from 1 on: the
      // node is corner k of the cell at place k.
      LazyArray<std::uint32_t> around;
      LazyArray<double>        results; // by cell
      // Owned, in the order of their rows; the first of these, here
      std::vector<std::uint32_t> cells;
      std::uint32_t              first = 0;
    };

    template <class Work>
    void
    for_each_near(std::uint32_t cell, int n, const Work &work) const;
    void
    gather(Liquid &liquid);
    bool
    knows_all_cells() const;
    void
    choose_cells();
    void
    find_columns();
    void
    exchange(Liquid &liquid);
    void
    look_around(Liquid &liquid);
    void
    hold_nodes(double end);
    void
    assemble(double step);
    void
    assemble_row(std::size_t   liquid,
                 std::uint32_t cell,
                 std::uint32_t row,
                 double        step);
    double
    scale();
    void
    share(Liquid &liquid, unsigned int slot);
    void
    keep_result(Liquid &liquid, double step);
    void
    push_nodes(double step);

    double *
    record(Liquid &liquid, const std::uint32_t cell)
    {
      return liquid.records.data() + std::size_t(cell) * Record::stride;
    }
    const double *
    record(const Liquid &liquid, const std::uint32_t cell) const
    {
      return liquid.records.data() + std::size_t(cell) * Record::stride;
    }
    std::uint32_t
    node_of(const std::uint32_t cell, const unsigned int corner) const
    {
      return parts.grid.geometry[cell].node[corner] / Layout::stride;
    }
    const std::uint32_t *
    around(const Liquid &liquid, const std::uint32_t node) const
    {
      return liquid.around.data() + std::size_t(node) * n_nodes;
    }
    bool
    is_inside(const Liquid &liquid, std::uint32_t node) const;
    double
    pattern_scale(const Liquid &liquid, std::uint32_t node, double step) const;
    double *
    result(Liquid &liquid, const std::uint32_t cell)
    {
      return liquid.results.data() + std::size_t(cell) * Result::stride;
    }
    double
    excess(std::uint32_t cell, std::uint32_t node, double density) const;

    const RunParts<dim>         parts;
    BoundaryConditions<dim>    &boundaries;
    std::optional<ExchangePlan> shared_cells;
    RecordExchange              records_exchange{Record::stride};
    RecordExchange              result_exchange{Result::stride};
    std::vector<Liquid>         liquids;
    // By node and component: 1/m, or 0 where a side holds it; and the velocity
    // without the pressures, or that of the side
    LazyArray<double> mobility, velocity;
    LazyArray<double> force; // of the pressures, likewise, N
    PressureEquations equations;
    bool              has_cells     = false; // of the present mesh
    double            share_of_pace = 0;     // of the step, see solve()

    // By place in a row: the cell that it stands for
    std::vector<std::uint32_t> mates;

    // By row
    struct Former
    {
      double pressure;   // P0, Pa
      double compliance; // C, m^3/Pa
    };
    std::vector<Former> former;
    std::vector<double> growth;    // e
    std::vector<double> pressures; // P1, Pa; over the scales while solved
    std::vector<double> scales;    // of rows and columns

    PressureSolver solver;
    Effort         spent;
  };
} // namespace limber

#endif
