// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/support.h>
#include <limber/time/ghost_penalty.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file The stiffness against jumps of the derivative of order p across faces
 * next to the surface (GhostPenalty), p = 1 for linear functions and 2 for
 * quadratic splines.
 */

using namespace limber;

namespace
{
  // Without a side, so that the functions are not those at one; with one at
  // the left and the bottom. @p levels: as finer cells in the middle.
  template <int dim>
  std::string
  scene(const std::string &kernel, const unsigned int levels)
  {
    const std::string z = dim == 3 ? ", 0.5" : "";
    return "set Dimension = " + std::to_string(dim) + R"(
      set End time = 1
      set Bodies = block
      subsection Body block
        set Frame = initial
        set Placement = regular
        subsection Box
          set Lower corner = 0, 0)" +
           z + R"(
          set Upper corner = 2.1, 1.6)" +
           (dim == 3 ? ", 2" : "") + R"(
        end
        set Material = neo hookean
        subsection Neo hookean
          set Density = 1000
          set Young's modulus = 1e6
          set Poisson's ratio = 0.3
        end
      end
      subsection Grid
        set Upper corner = 4, 2)" +
           (dim == 3 ? ", 2.5" : "") + R"(
        set Cells = 8, 5)" +
           (dim == 3 ? ", 5" : "") +
           (levels == 0 ? "" :
                          "\nset Levels = " + std::to_string(levels) + R"(
        set Refine = middle
        subsection Refine middle
          set Lower corner = 0.9, 0.5)" +
                            (dim == 3 ? ", 0.6" : "") + R"(
          set Upper corner = 1.3, 1.4)" +
                            (dim == 3 ? ", 1.3" : "") + "\nend") +
           R"(
      end
      subsection Method
        set Time integration = quasi-static
        set Kernel = )" +
           kernel + "\nend\n";
  }



  template <int dim>
  struct Penalty
  {
    explicit Penalty(const std::string &kernel, const unsigned int levels)
      : run(scene<dim>(kernel, levels))
      , nodes({run.problem, run.grid, run.nodes, run.bodies, run.ledger})
      , p(kernel == "linear" ? 1 : 2)
    {
      nodes.update();
      penalty.find(nodes, std::vector<double>(nodes.n_cells(), modulus));
    }

    /** Of the values of field(node, component) at the nodes. */
    template <class Field>
    std::vector<double>
    values(const Field &field) const
    {
      std::vector<double> result(nodes.size() * dim);
      for (std::size_t k = 0; k < result.size(); ++k)
        result[k] = field(k / dim, k % dim);
      return result;
    }

    /** Derivative of order p along d at a place, as a cell has it. */
    double
    derivative(const std::vector<double> &u,
               const std::uint32_t        cell,
               std::array<double, dim>    x,
               const int                  d,
               const unsigned int         component)
    {
      const std::size_t number = nodes.number_of(cell);
      const double      h      = nodes.edge(number, d);
      const auto        value  = [&](const double step) {
        auto at = x;
        at[d] += step;
        auto       support = support_at<dim>(run.nodes.view(), cell, at);
        const auto numbers = nodes.of_cell(number);
        nodes.hanging_corners(number).condense(support.value.data(), 1);
        double result = 0;
        for (int i = 0; i < support.n; ++i)
          result += support.value[i] * u[numbers[i] * dim + component];
        return result;
      };
      // polynomials are continued beyond the cell: exact
      return p == 1 ? (value(h) - value(-h)) / (2 * h) :
                      (value(h) - 2 * value(0) + value(-h)) / (h * h);
    }

    /** g E / 2 h^(2p-1) / ((2p+1) p!^2) times the integral of jumps, h of the
     * larger cell. */
    double
    energy(const std::vector<double> &u)
    {
      const double factor = p == 1 ? 1. / 3 : 1. / 20;
      double       result = 0;
      const auto   view   = run.nodes.view();
      for (std::uint32_t c = 0; c < run.grid.n_owned_cells(); ++c)
        for (int face = 0; face < 2 * dim; ++face)
          {
            const int           d     = face / 2;
            const std::uint32_t other = beyond(c, d, face % 2, 0.5, 0.5);
            if (!is_occupied(c) || !is_occupied(other) ||
                !(at_surface(c) || at_surface(other)))
              continue;
            const auto own   = nodes.number_of(c);
            const int  ratio = nodes.size_of_cell(nodes.number_of(other)) /
                              nodes.size_of_cell(own);
            if (ratio == 0 || (ratio == 1 && face % 2 == 0))
              continue; // the other's turn
            const double h = nodes.edge(nodes.number_of(other), d);
            // Gauss' rule of three points in each direction of the face
            for (int k = 0; k < (dim == 2 ? 3 : 9); ++k)
              {
                std::array<double, dim> x      = view.cells[c].origin;
                double                  weight = 1;
                for (int e = 0, rest = k; e < dim; ++e)
                  if (e == d)
                    x[e] += face % 2 * nodes.edge(own, d);
                  else
                    {
                      const int at = rest % 3;
                      rest /= 3;
                      x[e] += nodes.edge(own, e) *
                              (0.5 + 0.5 * (at - 1) * std::sqrt(0.6));
                      weight *= nodes.edge(own, e) * (at == 1 ? 4. : 2.5) / 9;
                    }
                for (unsigned int component = 0; component < dim; ++component)
                  {
                    const double jump = derivative(u, other, x, d, component) -
                                        derivative(u, c, x, d, component);
                    result += 0.5 * modulus * factor * std::pow(h, 2 * p - 1) *
                              weight * jump * jump;
                  }
              }
          }
      return result;
    }

    std::uint32_t
    beyond(const std::uint32_t cell,
           const int           d,
           const bool          upper,
           const double        first,
           const double        second)
    {
      const auto              view = run.nodes.view();
      std::array<double, dim> x;
      for (int e = 0, k = 0; e < dim; ++e)
        x[e] = view.cells[cell].origin[e] + (e == d   ? (upper ? 1.01 : -0.01) :
                                             k++ == 0 ? first :
                                                        second) /
                                              view.cells[cell].inverse_edge[e];
      return view.bins.cell_at(x);
    }

    bool
    is_occupied(const std::uint32_t cell)
    {
      const auto points = run.points();
      for (std::size_t q = 0; q < points.size; ++q)
        if (points.cell[q] == cell)
          return true;
      return false;
    }

    bool
    at_surface(const std::uint32_t cell)
    {
      for (int d = 0; d < dim; ++d)
        for (const bool upper : {false, true})
          for (const double first : {0.25, 0.75})
            for (const double second : {0.25, 0.75})
              if (const auto next = beyond(cell, d, upper, first, second);
                  next != invalid_cell && !is_occupied(next))
                return true;
      return false;
    }

    static constexpr double modulus = 3e4;

    SceneRun<dim>      run;
    NumberedNodes<dim> nodes;
    GhostPenalty<dim>  penalty;
    const int          p;
  };



  template <int dim>
  void
  check_penalty(const std::string &kernel, const unsigned int levels)
  {
    SCOPED_TRACE(kernel + " in " + std::to_string(dim) +
                 "d, levels: " + std::to_string(levels));
    Penalty<dim> of(kernel, levels);
    ASSERT_GT(of.penalty.faces().size(), 4u);

    // Any values of the nodes, the same in each run
    const auto random = of.values([&](const std::size_t i, const int d) {
      return std::sin(12.9898 * (i * dim + d + 1)) * 0.1;
    });
    std::vector<double> force(random.size());
    const double        energy = of.penalty.add_forces(random, force);
    EXPECT_NEAR(energy, of.energy(random), 1e-9 * energy);

    // The force is the derivative, the tangent that of the force.
    double twice = 0;
    for (std::size_t k = 0; k < force.size(); ++k)
      twice += force[k] * random[k];
    EXPECT_NEAR(twice, 2 * energy, 1e-12 * energy);
    std::vector<double> product(force.size());
    of.penalty.add_tangent([&](const std::uint32_t *const numbers,
                               const unsigned int         n_nodes,
                               const double *const        block) {
      const unsigned int n = n_nodes * dim;
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          product[numbers[k / dim] * dim + k % dim] +=
            block[k * n + l] * random[numbers[l / dim] * dim + l % dim];
    });
    for (std::size_t k = 0; k < force.size(); ++k)
      EXPECT_NEAR(product[k], force[k], 1e-9 * energy);

    // What the functions have everywhere does not jump: with splines also what
    // is quadratic, whose values at nodes are products of the knots next to
    // them.
    const auto smooth = of.values([&](const std::size_t i, const int d) {
      const auto &x      = of.nodes.places()[i];
      double      result = 0.3 + x[0] - 0.7 * x[1];
      if (of.p == 2)
        for (int e = 0; e < dim; ++e)
          {
            const double h       = of.nodes.edge(0, e);
            const bool   at_side = (of.nodes.sides(i) >> (2 * e) & 3) != 0;
            result +=
              (e + d + 1) * (x[e] * x[e] - (at_side ? 0 : 0.25 * h * h));
          }
      return result;
    });
    EXPECT_LT(of.penalty.add_forces(smooth, force), 1e-20 * energy);
  }
} // namespace



TEST(GhostPenalties, JumpsCostEnergyAndSmoothFieldsDoNot)
{
  for (const std::string kernel : {"linear", "quadratic"})
    {
      check_penalty<2>(kernel, 0);
      check_penalty<3>(kernel, 0);
    }
  check_penalty<2>("linear", 2);
  check_penalty<3>("linear", 1);
}
