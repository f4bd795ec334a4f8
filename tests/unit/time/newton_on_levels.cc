// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/newton_equations.h>
#include <limber/time/nodal_mass.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <algorithm>
#include <cmath>

/**
 * @file Newton's method on cells of several sizes: nodes that hang follow
 * others (HangingCorners).
 */

using namespace limber;

namespace
{
  // A block between planes of symmetry, with fine cells in a corner and in its
  // middle, is drawn by dead loads.
  template <int dim>
  std::string
  drawn_block(const std::string &frame, const std::string &treatment)
  {
    const std::string z = dim == 3 ? ", 1" : "", half = dim == 3 ? ", 0.5" : "";
    return "set Dimension = " + std::to_string(dim) + R"(
      set End time = 1
      set Bodies = block
      subsection Body block
        subsection Box
          set Upper corner = 1, 1)" +
           z + R"(
        end
        set Points per cell edge = 2
        set Frame = )" +
           frame + R"(
        set Locking treatment = )" +
           treatment + R"(
        set Material = neo hookean
        subsection Neo hookean
          set Density = 1000
          set Young's modulus = 1e6
          set Poisson's ratio = 0.3
        end
      end
      subsection Grid
        set Upper corner = 1.5, 1.5)" +
           (dim == 3 ? ", 1.5" : "") + R"(
        set Cells = 6, 6)" +
           (dim == 3 ? ", 6" : "") + R"(
        set Levels = 2
        set Refine = corner, middle
        subsection Refine corner
          set Level = 1
          set Upper corner = 0.4, 0.4)" +
           (dim == 3 ? ", 0.4" : "") + R"(
        end
        subsection Refine middle
          set Level = )" +
           (dim == 2 ? "2" : "1") + R"(
          set Lower corner = 0.6, 0.4)" +
           (dim == 3 ? ", 0.6" : "") + R"(
          set Upper corner = 0.7, 0.6)" +
           (dim == 3 ? ", 0.7" : "") + R"(
        end
      end
      subsection Boundaries
        set left = slip
        set bottom = slip
        set right = free
        set top = free
        )" +
           (dim == 3 ? "set back = slip\nset front = free" : "") + R"(
      end
      subsection Loads
        set Face loads = pull
        subsection Face load pull
          set Body = block
          set Face = right
          set Traction = 2e5; 0)" +
           (dim == 3 ? "; 0" : "") + R"(
        end
      end
      subsection Method
        set Time integration = quasi-static
        set Time step = 0.25
      end)";
  }



  /** Number of nodes that hang in cells with points. */
  template <int dim>
  unsigned int
  hanging_corners(const NumberedNodes<dim> &nodes)
  {
    unsigned int result = 0;
    for (std::size_t c = 0; c < nodes.n_cells(); ++c)
      for (unsigned int i = 0; i < 1 << dim; ++i)
        result += nodes.hanging_corners(c).hangs(i);
    return result;
  }



  // A constant stress is in equilibrium on any cells: all points are stretched
  // alike, in the initial frame, as none leaves its cell.
  template <int dim>
  void
  check_constant_stress(const std::string &treatment)
  {
    SCOPED_TRACE(treatment + ", " + std::to_string(dim) + "d");
    SceneRun<dim> run(drawn_block<dim>("initial", treatment));
    run.advance_to(1);
    const auto points   = run.points();
    const auto at_start = [&](const std::size_t p) {
      return run.bodies[0]->points.reference_position(p);
    };
    double worst = 0, longest = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      for (int d = 0; d < dim; ++d)
        {
          const double stretch = points.position[d][0] / at_start(0)[d];
          worst                = std::max(worst,
                           std::abs(points.position[d][p] -
                                    stretch * at_start(p)[d]));
          longest              = std::max(longest, points.position[d][p]);
        }
    EXPECT_GT(longest, 1.15);
    EXPECT_LT(worst, 1e-9);
  }



  // Forces are the derivative of the energy, corrections solve with that of
  // the forces.
  template <int dim>
  void
  check_derivatives(const std::string &frame,
                    const std::string &treatment,
                    const std::string &integration)
  {
    SCOPED_TRACE(frame + ", " + treatment + ", " + std::to_string(dim) + "d");
    SceneRun<dim> run(drawn_block<dim>(frame, treatment),
                      {"Method/Time integration=" + integration});
    run.advance(0.25);
    const RunParts<dim> parts{
      run.problem, run.grid, run.nodes, run.bodies, run.ledger};
    NewtonEquations<dim> equations(parts);
    equations.begin_step();
    ASSERT_GT(hanging_corners(equations.numbered_nodes()), 10u);
    const std::size_t   n = equations.size();
    std::vector<double> u(n), change(n), none(n), load(n), correction;
    for (std::size_t k = 0; k < n; ++k)
      {
        u[k]      = 0.005 * std::sin(1. + 7. * double(k));
        change[k] = 0.005 * std::cos(3. * double(k));
        load[k]   = equations.is_held(k) ? 0 : std::sin(2. * double(k));
      }
    const auto beside = [&](const std::vector<double> &way, const double h) {
      std::vector<double> result = u;
      for (std::size_t k = 0; k < n; ++k)
        result[k] += h * way[k];
      return result;
    };

    const double h = 1e-4;
    ASSERT_TRUE(equations.evaluate(beside(change, h), nullptr));
    const double after = equations.energy();
    ASSERT_TRUE(equations.evaluate(beside(change, -h), nullptr));
    const double before = equations.energy();
    ASSERT_TRUE(equations.evaluate(u, nullptr));
    double work = 0, size = 0;
    for (std::size_t k = 0; k < n; ++k)
      {
        work += equations.forces()[k] * change[k];
        size += std::abs(equations.forces()[k] * change[k]);
      }
    EXPECT_NEAR((after - before) / (2 * h), work, 1e-7 * size);

    NodalMass<dim> mass(equations.numbered_nodes());
    mass.lump(none);
    const Inertia<dim> of_mass{mass, 0};
    ASSERT_TRUE(equations.evaluate(u, &of_mass));
    ASSERT_TRUE(equations.solve(load, none, correction));
    double largest = 0;
    for (const double way : correction)
      largest = std::max(largest, std::abs(way));
    const double step = 1e-6 / largest;
    ASSERT_TRUE(equations.evaluate(beside(correction, step), nullptr));
    const auto forces = equations.forces();
    ASSERT_TRUE(equations.evaluate(beside(correction, -step), nullptr));
    for (std::size_t k = 0; k < n; ++k)
      if (!equations.is_held(k))
        {
          EXPECT_NEAR((forces[k] - equations.forces()[k]) / (2 * step),
                      load[k],
                      1e-5);
        }
  }
} // namespace



TEST(NewtonOnLevels, AConstantStressIsInEquilibrium)
{
  for (const std::string treatment : {"none", "cell", "assumed strain"})
    {
      check_constant_stress<2>(treatment);
      check_constant_stress<3>(treatment);
    }
}



TEST(NewtonOnLevels, ForcesAndTangentAreDerivatives)
{
  for (const std::string frame : {"initial", "current"})
    for (const std::string treatment : {"none", "cell", "assumed strain"})
      {
        check_derivatives<2>(frame, treatment, "quasi-static");
        check_derivatives<3>(frame, treatment, "quasi-static");
      }
  check_derivatives<2>("current", "cell", "implicit");
  check_derivatives<3>("current", "cell", "implicit");
}
