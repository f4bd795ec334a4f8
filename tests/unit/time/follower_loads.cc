// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/follower_loads.h>
#include <limber/time/newton_equations.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file Loads that follow the displacement of a step of Newton's method
 * (FollowerLoads), and bodies in equilibrium with them.
 */

using namespace limber;

namespace
{
  // An eighth or a quarter of a hollow ball or tube, 1 and 2 m, pressed from
  // within
  template <int dim>
  std::string
  hollow_body(const std::string &frame, const std::string &method)
  {
    const std::string square = dim == 2 ? "x^2 + y^2" : "x^2 + y^2 + z^2";
    return "set Dimension = " + std::to_string(dim) + R"(
      set End time = 1
      set Bodies = shell
      subsection Body shell
        set Shape = formula
        subsection Formula
          set Inside = ()" +
           square + " - 1)*(4 - (" + square + R"())
        end
        set Points per cell edge = 2
        set Placement = cut
        set Frame = )" +
           frame + R"(
        set Locking treatment = cell
        set Material = neo hookean
        subsection Neo hookean
          set Density = 1
          set Young's modulus = 1000
          set Poisson's ratio = 0.499
        end
      end
      subsection Grid
        set Upper corner = )" +
           (dim == 2 ? "3, 3" : "3, 3, 3") + R"(
        set Cells = )" +
           (dim == 2 ? "24, 24" : "6, 6, 6") + R"(
      end
      subsection Boundaries
        set right = free
        set top = free
        )" +
           (dim == 3 ? "set front = free" : "") + R"(
      end
      subsection Loads
        set Face loads = pressure
        subsection Face load pressure
          set Body = shell
          set Face = surface
          set Where = 1.5 - sqrt()" +
           square + R"()
          set Pressure = 100*t
        end
      end
      subsection Method
        set Kernel = linear
        )" +
           method +
           R"(
      end)";
  }



  const std::string in_equilibrium = "set Time integration = quasi-static";



  // The tangent is minus the derivative of the forces, and these are those that
  // explicit steps have where nothing moves.
  template <int dim>
  void
  check_tangent(const std::string &frame)
  {
    SceneRun<dim> run(hollow_body<dim>(frame, in_equilibrium),
                      {"Loads/Body force=x*y; -y^2" +
                       std::string(dim == 3 ? "; x*z" : "")});
    run.advance(0.5); // so that pieces are turned and stretched already
    const RunParts<dim> parts{
      run.problem, run.grid, run.nodes, run.bodies, run.ledger};
    ExternalLoads<dim>   loads(run.problem, run.grid, run.bodies);
    NewtonEquations<dim> equations(parts);
    FollowerLoads<dim>   followers(parts, equations.numbered_nodes(), loads);
    ASSERT_TRUE(followers.any());
    equations.begin_step();
    followers.find();
    followers.set(0.5, 2.);

    const std::size_t   n = equations.size();
    std::vector<double> displacement(n), change(n), expected(n), symmetric(n);
    for (std::size_t k = 0; k < n; ++k)
      {
        displacement[k] = 0.05 * std::sin(1. + double(k));
        change[k]       = std::cos(3. * double(k));
      }
    const auto multiply = [&](std::vector<double> &result, const bool half) {
      followers.add_tangent(displacement,
                            half,
                            [&](const std::uint32_t *const numbers,
                                const unsigned int         n_nodes,
                                const double *const        block) {
                              const unsigned int m = n_nodes * dim;
                              for (unsigned int k = 0; k < m; ++k)
                                for (unsigned int l = 0; l < m; ++l)
                                  result[numbers[k / dim] * dim + k % dim] -=
                                    block[k * m + l] *
                                    change[numbers[l / dim] * dim + l % dim];
                            });
    };
    multiply(expected, false);
    multiply(symmetric, true);

    const double        h = 1e-4;
    std::vector<double> before(n), after(n), former = displacement;
    for (std::size_t k = 0; k < n; ++k)
      displacement[k] = former[k] - h * change[k];
    followers.add_forces(displacement, before);
    for (std::size_t k = 0; k < n; ++k)
      displacement[k] = former[k] + h * change[k];
    followers.add_forces(displacement, after);
    double size = 0, work = 0, work_of_symmetric = 0;
    for (std::size_t k = 0; k < n; ++k)
      {
        size = std::max(size, std::abs(expected[k]));
        work += change[k] * expected[k];
        work_of_symmetric += change[k] * symmetric[k];
      }
    ASSERT_GT(size, 0.1);
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_NEAR((after[k] - before[k]) / (2 * h), expected[k], 1e-7 * size);
    // of a quadratic form the symmetric part is all that counts
    EXPECT_NEAR(work, work_of_symmetric, 1e-10 * size * double(n));

    // at rest: what ExternalLoads gives to the nodes, but for the factor
    std::vector<double> none(n), at_rest(n);
    followers.add_forces(none, at_rest);
    run.nodes.clear();
    loads.add(run.nodes, 0.5);
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_NEAR(at_rest[k],
                  2 * loads.on_node(
                        0,
                        equations.numbered_nodes().on_grid()[k / dim])[k % dim],
                  1e-10 * size);
  }
} // namespace



TEST(FollowerLoads, TangentIsTheDerivative)
{
  for (const std::string frame : {"initial", "current"})
    {
      check_tangent<2>(frame);
      check_tangent<3>(frame);
    }
}



// In a field of springs fixed in space a body swings with the period 2
// pi/sqrt(k) and, by the trapezoidal rule, keeps its energy.
TEST(FollowerLoads, ABodySwingsInAField)
{
  const std::string block = R"(
    set End time = 10
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 1.1, 0.9
        set Upper corner = 1.5, 1.1
      end
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
    end
    subsection Grid
      set Upper corner = 2, 2
      set Cells = 20, 20
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end
    subsection Loads
      set Body force = -9*(x - 1); -9*(y - 1)
    end
    subsection Method
      set Time integration = implicit
      set Time step = 0.02
    end)";
  SceneRun<2>       run(block);
  const auto        centre = [&]() {
    return run.totals().all.mass_moment[0] / run.totals().all.mass;
  };
  EXPECT_NEAR(centre(), 1.3, 1e-12);
  double least = 2;
  for (unsigned int k = 0; k < 419; ++k) // four periods, 8.38 s
    {
      run.advance(0.02);
      least = std::min(least, centre());
    }
  EXPECT_NEAR(least, 0.7, 0.001);
  EXPECT_NEAR(centre(), 1.3, 0.001);
  EXPECT_LT(std::abs(run.totals().energy_drift), 1e-6);
}



// Incompressible neo-Hookean tube in plane strain, B/A = 2: pressure over G at
// which the inner radius has grown to a,
// ln((a/A)/(b/B)) + (k/2)(1/a^2 - 1/b^2), k = a^2 - A^2 = b^2 - B^2.
TEST(FollowerLoads, TubeOfRubber)
{
  const double G = 1000. / (2 * 1.499);
  for (const double inner : {1.1, 1.25, 1.5})
    {
      const double k = inner * inner - 1, b = std::sqrt(4 + k);
      const double p = G * (std::log(inner / (b / 2)) +
                            k / 2 * (1 / (inner * inner) - 1 / (b * b)));
      SceneRun<2>  run(hollow_body<2>("initial", in_equilibrium),
                      {"Loads/Face load pressure/Pressure=" + digits(p)});
      run.advance(0.25, 4);
      double      missed = 0, mass = 0; // mean by mass, as splinters are loose
      const auto  points = run.points();
      const auto &body   = run.bodies[0]->points;
      for (std::size_t i = 0; i < points.size; ++i)
        {
          const auto   X = body.reference_position(i);
          const double r = std::hypot(points.position[0][i],
                                      points.position[1][i]),
                       R = X.norm();
          missed += points.mass[i] * std::abs(r - std::sqrt(R * R + k));
          mass += points.mass[i];
        }
      missed /= mass;
      std::printf("tube, a/A %g: p/G %.6f, places missed by %.2e m; %s\n",
                  inner,
                  p / G,
                  missed,
                  run.integrator.effort().c_str());
      EXPECT_LT(missed, 0.02 * (inner - 1));
      // what the pressure has spent is in the body
      EXPECT_LT(std::abs(run.totals().energy_drift), 2e-3);
    }
}
