// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/newton_equations.h>
#include <limber/time/nodal_mass.h>

#include <gtest/gtest.h>
#include <support/held_strip.h>
#include <support/scene_run.h>

#include <algorithm>
#include <cmath>

/**
 * @file Corrections of Newton's method: iterations find what a factorisation
 * finds (NewtonEquations).
 */

using namespace limber;

namespace
{
  /** The first correction of a strip under its weight, and the effort. */
  template <int dim>
  struct FirstCorrection
  {
    FirstCorrection(const RunParts<dim> &parts,
                    const double         inertia,
                    const std::size_t    largest_direct,
                    const double         mixed_beyond,
                    const std::size_t    most_factorised = 1u << 30,
                    const unsigned int   most_iterations = 2000)
      : equations(parts,
                  largest_direct,
                  mixed_beyond,
                  most_factorised,
                  most_iterations)
    {
      equations.begin_step();
      const std::vector<double> none(equations.size());
      NodalMass<dim>            mass(equations.numbered_nodes());
      mass.lump(std::vector<double>(equations.size(), inertia));
      std::vector<double> load(equations.size());
      for (std::size_t i = 1; i < load.size(); i += dim)
        load[i] = 1;
      const Inertia<dim> of_mass{mass, 1};
      solved = equations.evaluate(none, &of_mass) &&
               equations.solve(load, none, values);
    }

    NewtonEquations<dim> equations;
    std::vector<double>  values;
    bool                 solved = false;
  };

  /** The largest difference over the largest value. */
  double
  difference(const std::vector<double> &a, const std::vector<double> &b)
  {
    double size = 0, result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      {
        size   = std::max(size, std::abs(a[i]));
        result = std::max(result, std::abs(a[i] - b[i]));
      }
    return result / size;
  }



  /** The iterated correction is that of the factors, in at most so many steps.
   */
  template <int dim>
  void
  expect_alike(const FirstCorrection<dim> &factorised,
               const FirstCorrection<dim> &mixed,
               const std::string          &what,
               const unsigned int          most_iterations)
  {
    ASSERT_TRUE(factorised.solved && mixed.solved);
    std::printf("%zu unknowns %s: %lu iterations, %.1e away\n",
                mixed.values.size(),
                what.c_str(),
                mixed.equations.linear_iterations(),
                difference(factorised.values, mixed.values));
    EXPECT_LT(difference(factorised.values, mixed.values), 1e-6);
    EXPECT_FALSE(mixed.equations.gave_up_iterating());
    EXPECT_LE(mixed.equations.linear_iterations(), most_iterations);
  }
} // namespace



// Conjugate gradients and generalised minimal residuals with multigrid find
// what a factorisation finds, and the latter do not mind how little the volume
// gives in. Prints the table of doc/theory/implicit_steps.md.
TEST(NewtonSolvers, IterationsFindTheSameCorrection)
{
  const double always = 0, never = 1e300;
  for (const double nu : {0.3, 0.45, 0.49, 0.499, 0.4999})
    for (const int refined : {1, 2, 4, 8})
      {
        SceneRun<2>       run(held_strip,
                        {"Method/Time integration=quasi-static",
                               "Body strip/Frame=current",
                               "Body strip/Locking treatment=cell",
                               "Body strip/Neo hookean/Poisson's ratio=" + digits(nu),
                               "Grid/Cells=" + std::to_string(20 * refined) + ", " +
                                 std::to_string(10 * refined)});
        const RunParts<2> parts{
          run.problem, run.grid, run.nodes, run.bodies, run.ledger};
        const FirstCorrection factorised(parts, 0, 1u << 30, never),
          condensed(parts, 0, 0, never), mixed(parts, 0, 0, always);
        ASSERT_TRUE(factorised.solved && condensed.solved && mixed.solved);
        std::printf(
          "nu %g, %zu unknowns: %lu iterations of conjugate "
          "gradients%s, %lu of generalised minimal residuals, %.1e away\n",
          nu,
          factorised.values.size(),
          condensed.equations.linear_iterations(),
          condensed.equations.gave_up_iterating() ? ", then factorised" : "",
          mixed.equations.linear_iterations(),
          difference(factorised.values, mixed.values));
        EXPECT_LT(difference(factorised.values, condensed.values), 1e-6);
        EXPECT_LT(difference(factorised.values, mixed.values), 1e-6);
        EXPECT_EQ(factorised.equations.linear_iterations(), 0u);
        EXPECT_FALSE(mixed.equations.gave_up_iterating());
        EXPECT_GT(mixed.equations.linear_iterations(), 0u);
        EXPECT_LE(mixed.equations.linear_iterations(), 26u);
        EXPECT_TRUE(mixed.equations.is_mixed());
        EXPECT_FALSE(condensed.equations.is_mixed());
        if (nu <= 0.45)
          {
            EXPECT_FALSE(condensed.equations.gave_up_iterating());
            EXPECT_GT(condensed.equations.linear_iterations(), 0u);
          }
      }
}



// With splines too; a pressure of its own no cell has.
TEST(NewtonSolvers, IterationsWithSplines)
{
  for (const double nu : {0.3, 0.45})
    for (const int refined : {1, 2, 4})
      {
        SceneRun<2>       run(held_strip,
                        {"Method/Time integration=quasi-static",
                               "Method/Kernel=quadratic",
                               "Body strip/Frame=initial",
                               "Body strip/Box/Lower corner=0, 2.03",
                               "Body strip/Box/Upper corner=7.7, 2.96",
                               "Body strip/Neo hookean/Poisson's ratio=" + digits(nu),
                               "Grid/Cells=" + std::to_string(20 * refined) + ", " +
                                 std::to_string(10 * refined)});
        const RunParts<2> parts{
          run.problem, run.grid, run.nodes, run.bodies, run.ledger};
        const FirstCorrection factorised(parts, 0., 1u << 30, 0.),
          iterated(parts, 0., 0, 0.);
        ASSERT_TRUE(factorised.solved && iterated.solved);
        std::printf("splines, nu %g, %zu unknowns: %lu iterations of conjugate "
                    "gradients, %.1e away\n",
                    nu,
                    factorised.values.size(),
                    iterated.equations.linear_iterations(),
                    difference(factorised.values, iterated.values));
        EXPECT_LT(difference(factorised.values, iterated.values), 1e-6);
        EXPECT_FALSE(iterated.equations.gave_up_iterating());
        EXPECT_FALSE(iterated.equations.is_mixed());
        EXPECT_GT(iterated.equations.linear_iterations(), 0u);
      }
}



// Cells that are cut, so that hardly filled ones hang on light nodes, in
// equilibrium and in motion, where shear waves pass 20 cells in a step.
TEST(NewtonSolvers, MixedFormOfCutCells)
{
  for (const double inertia : {0., 1.})
    for (const int refined : {2, 4, 8})
      {
        SceneRun<2>       run(held_strip,
                        {"Method/Time integration=quasi-static",
                               "Body strip/Frame=current",
                               "Body strip/Locking treatment=cell",
                               "Body strip/Neo hookean/Poisson's ratio=0.4999",
                               "Body strip/Box/Lower corner=0, 2.03",
                               "Body strip/Box/Upper corner=7.7, 2.96",
                               "Grid/Cells=" + std::to_string(20 * refined) + ", " +
                                 std::to_string(10 * refined)});
        const RunParts<2> parts{
          run.problem, run.grid, run.nodes, run.bodies, run.ledger};
        // rho h^2 4/dt^2 with dt = 20 h / c: G / 100
        const double          diagonal = inertia * 1e6 / 3 / 100;
        const FirstCorrection factorised(parts, diagonal, 1u << 30, 0),
          mixed(parts, diagonal, 0, 0);
        expect_alike(factorised,
                     mixed,
                     inertia > 0 ? "in motion" : "at rest",
                     26);
      }
}



// Twice as fine as the finest grid of the table.
TEST(NewtonSolvers, MixedFormOnAFineGrid)
{
  SceneRun<2>       run(held_strip,
                  {"Method/Time integration=quasi-static",
                         "Body strip/Frame=current",
                         "Body strip/Locking treatment=cell",
                         "Body strip/Neo hookean/Poisson's ratio=0.4999",
                         "Grid/Cells=320, 160"});
  const RunParts<2> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  const FirstCorrection factorised(parts, 0., 1u << 30, 0.),
    mixed(parts, 0., 0, 0.);
  expect_alike(factorised, mixed, "on a fine grid", 30);
}



// In space pressures may alternate along each pair of directions.
TEST(NewtonSolvers, MixedFormInSpace)
{
  for (const int refined : {1, 2})
    {
      const std::string n = std::to_string(4 * refined);
      SceneRun<3>       run(R"(
        set Dimension = 3
        set End time = 1
        set Bodies = bar
        subsection Body bar
          subsection Box
            set Lower corner = 0, 0.25, 0.25
            set Upper corner = 3, 0.75, 0.75
          end
          set Points per cell edge = 2
          set Frame = current
          set Locking treatment = cell
          set Material = neo hookean
          subsection Neo hookean
            set Density = 1000
            set Young's modulus = 1e6
            set Poisson's ratio = 0.4999
          end
        end
        subsection Grid
          set Upper corner = 4, 1, 1
          set Cells = )" +
                      std::to_string(16 * refined) + ", " + n + ", " + n + R"(
        end
        subsection Boundaries
          set left = no slip
          set right = free
          set bottom = free
          set top = free
          set front = free
          set back = free
        end
        subsection Method
          set Time integration = quasi-static
        end)");
      const RunParts<3> parts{
        run.problem, run.grid, run.nodes, run.bodies, run.ledger};
      const FirstCorrection factorised(parts, 0., 1u << 30, 0.),
        mixed(parts, 0., 0, 0.);
      expect_alike(factorised, mixed, "in space", 28);
    }
}



// A sphere with a hole cuts its cells anywhere, and three planes of symmetry
// hold it. Iterations by grid and Poisson's ratio are in
// doc/theory/implicit_steps.md.
TEST(NewtonSolvers, CutCellsOfAShell)
{
  struct Case
  {
    double       nu;
    int          cells;
    unsigned int most_iterations;
  };
  for (const Case &solved : {Case{0.3, 9, 20},
                             Case{0.499, 9, 29},
                             Case{0.4999, 9, 29},
                             Case{0.3, 18, 21},
                             Case{0.499, 18, 34}})
    {
      const std::string n = std::to_string(solved.cells);
      SceneRun<3>       run(R"(
        set Dimension = 3
        set End time = 1
        set Bodies = shell
        subsection Body shell
          set Shape = formula
          subsection Formula
            set Inside = (x^2 + y^2 + z^2 - 1)*(4 - x^2 - y^2 - z^2)
          end
          set Points per cell edge = 2
          set Placement = cut
          set Locking treatment = cell
          set Material = linear elastic
          subsection Linear elastic
            set Density = 1
            set Young's modulus = 1000
            set Poisson's ratio = )" +
                      digits(solved.nu) + R"(
          end
        end
        subsection Grid
          set Upper corner = 2, 2, 2
          set Cells = )" +
                      n + ", " + n + ", " + n + R"(
        end
        subsection Boundaries
          set right = free
          set top = free
          set front = free
        end
        subsection Method
          set Time integration = quasi-static
        end)");
      const RunParts<3> parts{
        run.problem, run.grid, run.nodes, run.bodies, run.ledger};
      const FirstCorrection iterated(parts, 0., 0, 20.);
      if (solved.cells == 9)
        {
          const FirstCorrection factorised(parts, 0., 1u << 30, 20.);
          expect_alike(factorised,
                       iterated,
                       "of a shell",
                       solved.most_iterations);
        }
      ASSERT_TRUE(iterated.solved);
      std::printf("shell, nu %g, %zu unknowns: %lu iterations\n",
                  solved.nu,
                  iterated.values.size(),
                  iterated.equations.linear_iterations());
      EXPECT_LE(iterated.equations.linear_iterations(), solved.most_iterations);
      // to the last bit, or Newton's method never arrives
      for (std::size_t k = 0; k < iterated.values.size(); ++k)
        if (iterated.equations.is_held(k))
          {
            ASSERT_EQ(iterated.values[k], 0.);
          }
    }
}



// Iterations that fail say so, and a factorisation replaces them up to a
// number of unknowns.
TEST(NewtonSolvers, FailedIterationsAreTold)
{
  SceneRun<2>       run(held_strip,
                  {"Method/Time integration=quasi-static",
                         "Body strip/Frame=current",
                         "Body strip/Locking treatment=cell",
                         "Grid/Cells=40, 20"});
  const RunParts<2> parts{
    run.problem, run.grid, run.nodes, run.bodies, run.ledger};
  const double          never = 1e300;
  const FirstCorrection factorised(parts, 0., 1u << 30, never),
    replaced(parts, 0., 0, never, 1u << 30, 3),
    refused(parts, 0., 0, never, 100, 3);
  const std::string event =
    "conjugate gradients stopped after 3 iterations with ";
  ASSERT_TRUE(factorised.solved && replaced.solved);
  EXPECT_TRUE(factorised.equations.failure_of_iterations().empty());
  EXPECT_TRUE(replaced.equations.gave_up_iterating());
  EXPECT_EQ(replaced.equations.failure_of_iterations().find(event), 0u);
  EXPECT_LT(difference(factorised.values, replaced.values), 1e-9);
  EXPECT_FALSE(refused.solved);
  EXPECT_FALSE(refused.equations.gave_up_iterating());
  EXPECT_TRUE(refused.equations.is_too_large());
  EXPECT_NE(refused.equations.obstacle().find(
              "too many to factorise (at most 100)"),
            std::string::npos)
    << refused.equations.obstacle();
}



// All ranks solve the equations of all, alike to the last bit, and so whether
// these are factorised or iterated.
TEST(NewtonSolvers, IterationsOnRanks)
{
  struct Case
  {
    double nu, mixed_beyond;
  };
  for (const Case &solved : {Case{0.3, 1e300}, Case{0.4999, 0}})
    {
      SceneRun<2>       run(held_strip,
                      {"Method/Time integration=quasi-static",
                             "Body strip/Frame=current",
                             "Body strip/Locking treatment=cell",
                             "Body strip/Neo hookean/Poisson's ratio=" +
                               digits(solved.nu),
                             "Body strip/Box/Upper corner=7.7, 2.96",
                             "Grid/Cells=40, 20"});
      const RunParts<2> parts{
        run.problem, run.grid, run.nodes, run.bodies, run.ledger};
      const FirstCorrection factorised(parts, 0., 1u << 30, 1e300),
        iterated(parts, 0., 0, solved.mixed_beyond);
      ASSERT_TRUE(factorised.solved && iterated.solved);
      EXPECT_FALSE(iterated.equations.gave_up_iterating());
      EXPECT_GT(iterated.equations.linear_iterations(), 0u);
      EXPECT_LT(difference(factorised.values, iterated.values), 1e-6);
      for (const auto *const values : {&factorised.values, &iterated.values})
        {
          std::vector<double> of_first = *values;
          MPI_Bcast(
            of_first.data(), of_first.size(), MPI_DOUBLE, 0, MPI_COMM_WORLD);
          EXPECT_EQ(of_first, *values);
        }
    }
}
