// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/tria.h>

#include <limber/fem/natural_modes.h>
#include <limber/fem/solid_samples.h>

#include <gtest/gtest.h>
#include <support/solid_scene.h>

#include <cmath>
#include <fstream>

/** @file Elements against exact solutions and published numbers. */
using namespace limber;

namespace
{
  constexpr double pi = dealii::numbers::PI;

  std::string
  digits(const double value)
  {
    char text[32];
    std::snprintf(text, sizeof(text), "%.17g", value);
    return text;
  }



  struct Errors
  {
    double displacement = 0, stress = 0;
  };



  /**
   * Root mean square errors of the equilibrium under the body force of
   *
   *   u = A sin(pi x) cos(pi y),  v = A/2 cos(pi x) sin(pi y)
   *
   * between slip walls, with rho = E = 1, on n x n elements.
   */
  Errors
  manufactured_errors(const std::string &element,
                      const std::string &law,
                      const double       nu,
                      const unsigned int n)
  {
    const std::string scene   = R"(
      set Bodies = square
      subsection Body square
        subsection Box
          set Upper corner = 1, 1
        end
        subsection Linear elastic
          set Density = 1
          set Young's modulus = 1
        end
        subsection Neo hookean
          set Density = 1
          set Young's modulus = 1
        end
      end)";
    constexpr double  A       = 1e-6;
    const double      mu      = 0.5 / (1 + nu);
    const double      s       = mu / (1 - 2 * nu); // lambda + mu
    const auto        problem = problem_from<2>(
      scene,
      {"Reference/Element=" + element,
              "Reference/Method=quasi-static",
              "Reference/Elements over depth=" + std::to_string(n),
              "Body square/Material=" + law,
              "Body square/Linear elastic/Poisson's ratio=" + digits(nu),
              "Body square/Neo hookean/Poisson's ratio=" + digits(nu),
              "Loads/Constants=A = 1e-6, mu = " + digits(mu) + ", s = " + digits(s),
              "Loads/Body force=A*pi^2*(2*mu + 1.5*s)*sin(pi*x)*cos(pi*y); "
                     "A*pi^2*(mu + 1.5*s)*cos(pi*x)*sin(pi*y)"});
    SolidModel<2>      model(problem, MPI_COMM_WORLD);
    ReferenceSolver<2> solver(model);
    solver.advance(1);

    // somewhere in the elements, on a lattice that does not fit them
    Errors             result;
    const auto        &u        = solver.motion().displacement;
    constexpr unsigned n_places = 7;
    for (unsigned int i = 0; i < n_places; ++i)
      for (unsigned int j = 0; j < n_places; ++j)
        {
          const dealii::Point<2> x((i + 0.41) / n_places,
                                   (j + 0.37) / n_places);
          const auto             found = sample_at(model, x, u, u);
          const double sx = std::sin(pi * x[0]), cx = std::cos(pi * x[0]);
          const double sy = std::sin(pi * x[1]), cy = std::cos(pi * x[1]);
          const dealii::Tensor<1, 2> exact({A * sx * cy, A / 2 * cx * sy});
          const double               shear = -mu * A * pi * 1.5 * sx * sy;
          result.displacement += (found.displacement - exact).norm_square();
          result.stress += std::pow(found.material.stress[0][1] - shear, 2);
        }
    result.displacement = std::sqrt(result.displacement) / (n_places * A);
    result.stress       = std::sqrt(result.stress) / (n_places * A);
    return result;
  }



  void
  expect_orders(const std::string &element, const unsigned int degree)
  {
    for (const std::string law : {"linear elastic", "neo hookean"})
      for (const double nu : {0.3, 0.49})
        {
          SCOPED_TRACE(element + ", " + law + ", nu = " + digits(nu));
          const Errors coarse = manufactured_errors(element, law, nu, 8);
          const Errors fine   = manufactured_errors(element, law, nu, 32);
          EXPECT_GT(std::log2(coarse.displacement / fine.displacement) / 2,
                    degree + 1 - 0.3);
          EXPECT_GT(std::log2(coarse.stress / fine.stress) / 2, degree - 0.3);
        }
  }



  /** Displacements upwards of Cook's panel. */
  struct CookTip
  {
    double corner, middle; // at (48, 60), (48, 52)
  };



  CookTip
  cook(const unsigned int n, const std::vector<std::string> &changes)
  {
    std::vector<std::string> overrides = {"Reference/Method=quasi-static",
                                          "Body panel/Material=linear elastic"};
    overrides.insert(overrides.end(), changes.begin(), changes.end());
    const auto            problem = problem_from<2>(R"(
      set Bodies = panel
      subsection Body panel
        subsection Box
          set Upper corner = 48, 60
        end
        subsection Linear elastic
          set Density = 1
          set Young's modulus = 70
          set Poisson's ratio = 0.499
        end
        subsection Neo hookean
          set Density = 1
          set Young's modulus = 70
          set Poisson's ratio = 0.499
        end
      end
      subsection Grid
        set Lower corner = 0, -10
        set Upper corner = 60, 70
      end
      subsection Boundaries
        set left = no slip
      end
      subsection Loads
        set Face loads = shear
        subsection Face load shear
          set Body = panel
          set Face = right
          set Traction = 0; 0.0625
        end
      end)",
                                         overrides);
    const BlockCorners<2> corners = {{dealii::Point<2>(0, 0),
                                      dealii::Point<2>(48, 44),
                                      dealii::Point<2>(0, 44),
                                      dealii::Point<2>(48, 60)}};
    SolidModel<2>         model(problem,
                        make_block_mesh<2>(corners, {{n, n}}, MPI_COMM_WORLD));
    ReferenceSolver<2>    solver(model);
    for (unsigned int k = 0; k < problem.reference.load_steps; ++k)
      solver.advance(solver.longest_step());
    const auto &u = solver.motion().displacement;
    return {sample_at(model, dealii::Point<2>(48, 60), u, u).displacement[1],
            sample_at(model, dealii::Point<2>(48, 52), u, u).displacement[1]};
  }
} // namespace



TEST(ReferenceOrders, Q1)
{
  expect_orders("Q1", 1);
}



TEST(ReferenceOrders, Q1P0P0)
{
  expect_orders("Q1-P0-P0", 1);
}



TEST(ReferenceOrders, Q2)
{
  expect_orders("Q2", 2);
}



TEST(ReferenceOrders, Q2P1P1)
{
  expect_orders("Q2-P1-P1", 2);
}



// Plane-strain values of the Q2 element with reduced volumetric quadrature;
// the corner is nearly singular, so three digits count.
TEST(CooksPanel, SmallStrain)
{
  const CookTip soft = cook(32, {});
  EXPECT_NEAR(soft.corner, 0.2774, 0.0006);
  EXPECT_NEAR(soft.middle, 0.2645, 0.0005);
  const CookTip compressible =
    cook(32, {"Body panel/Linear elastic/Poisson's ratio=0.33333333333333333"});
  EXPECT_NEAR(compressible.corner, 0.3227, 0.0005);
  const CookTip stiff =
    cook(32,
         {"Body panel/Linear elastic/Young's modulus=240.565",
          "Body panel/Linear elastic/Poisson's ratio=0.4999",
          "Loads/Face load shear/Traction=0; 6.25"});
  EXPECT_NEAR(stiff.corner, 8.065, 0.015);
}



TEST(CooksPanel, FiniteStrain)
{
  const CookTip soft = cook(32, {"Body panel/Material=neo hookean"});
  EXPECT_NEAR(soft.corner, 0.2761, 0.0005);
  EXPECT_NEAR(soft.middle, 0.2637, 0.0005);
  // a single load step by a seventh of the length, nearly incompressible
  const CookTip large = cook(32,
                             {"Body panel/Material=neo hookean",
                              "Body panel/Neo hookean/Young's modulus=240.565",
                              "Body panel/Neo hookean/Poisson's ratio=0.4999",
                              "Loads/Face load shear/Traction=0; 6.25"});
  EXPECT_NEAR(large.corner, 6.920, 0.010);
  EXPECT_NEAR(large.middle, 6.950, 0.010);
}



// The elements of one field lock, those of three do not.
TEST(CooksPanel, BilinearElementsLockUnlessPressureIsConstant)
{
  EXPECT_LT(cook(16, {"Reference/Element=Q1"}).corner, 0.20);
  EXPECT_NEAR(cook(32, {"Reference/Element=Q1-P0-P0"}).corner, 0.2765, 0.0015);
}



// Four elements from a file, refined twice, are the block of 8 x 8: loads and
// sides find their faces by where they are.
TEST(MeshFile, GivesWhatTheBlockGives)
{
  const std::string path = testing::TempDir() + "limber_mesh.inp";
  std::ofstream(path) << "9 4 0 0 0\n"
                         "1 0 0 0\n2 0.5 0 0\n3 1 0 0\n"
                         "4 0 0.5 0\n5 0.5 0.5 0\n6 1 0.5 0\n"
                         "7 0 1 0\n8 0.5 1 0\n9 1 1 0\n"
                         "1 0 quad 1 2 5 4\n2 0 quad 2 3 6 5\n"
                         "3 0 quad 4 5 8 7\n4 0 quad 5 6 9 8\n";
  const std::string                 scene = R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Upper corner = 1, 1
      end
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1
        set Young's modulus = 1
      end
    end
    subsection Grid
      set Lower corner = 0, -1
      set Upper corner = 3, 3
    end
    subsection Boundaries
      set left = no slip
    end
    subsection Loads
      set Face loads = pull
      subsection Face load pull
        set Body = block
        set Face = right
        set Traction = 0.1; 0.02*y
      end
    end)";
  std::vector<dealii::Tensor<1, 2>> corner;
  for (const std::vector<std::string> &changes :
       {std::vector<std::string>{"Reference/Mesh file=" + path,
                                 "Reference/Refinements=2"},
        std::vector<std::string>{"Reference/Elements=8, 8"}})
    {
      auto all = changes;
      all.push_back("Reference/Method=quasi-static");
      const auto    problem = problem_from<2>(scene, all);
      SolidModel<2> model(problem, MPI_COMM_WORLD);
      EXPECT_EQ(model.mesh->n_global_active_cells(), 64u);
      ReferenceSolver<2> solver(model);
      solver.advance(solver.longest_step());
      const auto &u = solver.motion().displacement;
      corner.push_back(
        sample_at(model, dealii::Point<2>(1, 1), u, u).displacement);
    }
  EXPECT_GT(corner[0].norm(), 0.05);
  EXPECT_LT((corner[0] - corner[1]).norm(), 1e-7);
}



// The slowest motion of a free ball twists its halves against each other: with
// the spherical Bessel functions, j_2(x) = x j_3(x), x = w R / c_s, five times.
// Straight edges of elements leave an error of second order.
TEST(MeshFile, ABallTwistsAtItsExactFrequency)
{
  constexpr double exact = 2.5011;
  EXPECT_NEAR(std::sph_bessel(2, exact),
              exact * std::sph_bessel(3, exact),
              1e-5);
  std::vector<double> errors;
  for (const unsigned int refinements : {1, 2})
    {
      dealii::Triangulation<3> mesh;
      dealii::GridGenerator::hyper_ball(mesh, dealii::Point<3>(2, 2, 2), 1);
      mesh.refine_global(refinements);
      const std::string path = testing::TempDir() + "limber_ball.vtk";
      std::ofstream     file(path);
      dealii::GridOut().write_vtk(mesh, file);
      file.close();

      const auto    problem = problem_from<3>(R"(
        set Dimension = 3
        set Bodies = ball
        subsection Body ball
          set Shape = ball
          subsection Ball
            set Centre = 2, 2, 2
            set Radius = 1
          end
          set Material = linear elastic
          subsection Linear elastic
            set Density = 1
            set Young's modulus = 2.6
            set Poisson's ratio = 0.3
          end
        end
        subsection Grid
          set Upper corner = 4, 4, 4
        end)",
                                           {"Reference/Mesh file=" + path,
                                               "Reference/Element=Q2"});
      SolidModel<3> model(problem, MPI_COMM_WORLD);
      EXPECT_EQ(model.mesh->n_global_active_cells(), mesh.n_active_cells());
      const auto found = natural_frequencies(model, 5);
      EXPECT_EQ(found.n_rigid_motions, 6u);
      double mean = 0;
      for (const double frequency : found.frequencies)
        mean += 2 * pi * frequency / 5; // c_s = 1 m/s
      errors.push_back(mean / exact - 1);
    }
  EXPECT_LT(errors[1], 0.025);
  // what is left without the error of second order
  EXPECT_NEAR((4 * errors[1] - errors[0]) / 3, 0, 0.002);
}



// A bar without lateral strain, u = sigma / E at its end: under the load factor
// of a scene in equilibrium, at the times of its steps, and for one in motion
// under the growing load of its end.
TEST(ReferenceInEquilibrium, FollowsTheLoadsOfTheScene)
{
  const std::string bar           = R"(
    set End time = 1
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 1, 0.5
      end
      set Material = linear elastic
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = 2, 1
    end
    subsection Loads
      set Face loads = pull
      subsection Face load pull
        set Body = bar
        set Face = right
        set Traction = 1 + t; 0
      end
    end)";
  const auto        displacements = [&](const std::vector<std::string> &changes,
                                 const unsigned int              n_steps) {
    const auto problem = problem_from<2>(bar, changes);
    EXPECT_EQ(problem.reference.method, ReferenceMethod::quasi_static);
    EXPECT_EQ(problem.reference.load_steps, n_steps);
    SolidModel<2>       model(problem, MPI_COMM_WORLD);
    ReferenceSolver<2>  solver(model);
    std::vector<double> result;
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        solver.advance(solver.longest_step());
        const auto &u = solver.motion().displacement;
        result.push_back(
          100 *
          sample_at(model, dealii::Point<2>(1, 0.5), u, u).displacement[0]);
      }
    return result;
  };
  const auto expect_all = [](const std::vector<double> &found,
                             const std::vector<double> &exact) {
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t k = 0; k < exact.size(); ++k)
      EXPECT_NEAR(found[k], exact[k], 1e-6) << k;
  };
  const std::string quasi_static = "Method/Time integration=quasi-static";

  // up and back to nothing
  expect_all(displacements({quasi_static,
                            "Method/Time step=0.25",
                            "Loads/Load factor=if(t<0.5, 2*t, 2-2*t)"},
                           4),
             {0.625, 1.5, 0.875, 0});
  // a load of t acts as it is written, if the scene gives no factor
  expect_all(displacements({quasi_static, "Reference/Load steps=2"}, 2),
             {1.5, 2});
  expect_all(displacements(
               {quasi_static, "Loads/Load factor=t", "Reference/Load steps=2"},
               2),
             {0.75, 2});
  expect_all(displacements(
               {"Reference/Method=quasi-static", "Reference/Load steps=2"}, 2),
             {1, 2});
  expect_all(displacements({"Reference/Method=quasi-static"}, 1), {2});
  EXPECT_EQ(problem_from<2>(bar, {quasi_static}).reference.load_steps, 10u);
  EXPECT_EQ(problem_from<2>(bar).reference.method,
            ReferenceMethod::implicit_steps);
  EXPECT_EQ(problem_from<2>(bar, {quasi_static, "Reference/Method=implicit"})
              .reference.method,
            ReferenceMethod::implicit_steps);
}



// A side that stops where a step ends has moved until then.
TEST(ReferenceInEquilibrium, SidesMayStopAtTheEndOfAStep)
{
  const auto         problem = problem_from<2>(R"(
    set End time = 2
    set Bodies = bar
    subsection Body bar
      subsection Box
        set Upper corner = 2, 1
      end
      set Material = linear elastic
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
      end
    end
    subsection Grid
      set Upper corner = 2, 1
    end
    subsection Boundaries
      set left   = slip
      set bottom = slip
      set right  = velocity
      subsection Side right
        set Velocity = if(t < 1, -0.01, 0); 0
      end
    end
    subsection Method
      set Time integration = quasi-static
      set Time step        = 0.5
    end)");
  SolidModel<2>      model(problem, MPI_COMM_WORLD);
  ReferenceSolver<2> solver(model);
  const double       places[] = {-0.005, -0.01, -0.01, -0.01};
  for (const double place : places)
    {
      solver.advance(0.5);
      const auto &u = solver.motion().displacement;
      EXPECT_NEAR(
        sample_at(model, dealii::Point<2>(2, 0.5), u, u).displacement[0],
        place,
        1e-12);
    }
}



// A load acts on the part of a face that 'Where' names, wherever this ends in
// the elements: its resultant is that of the exact area.
TEST(FaceLoads, ActOnPartsOfElements)
{
  const auto resultant_over_area = [](auto of_dim, const std::string &where) {
    constexpr int     dim  = decltype(of_dim)::value;
    const std::string ones = dim == 2 ? "1, 1" : "1, 1, 1";
    const auto        scene =
      problem_from<dim>("set Dimension = " + std::to_string(dim) +
                          R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Upper corner = )" +
                          ones + R"(
      end
      set Material = linear elastic
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = )" +
                          (dim == 2 ? "2, 2" : "2, 2, 2") + R"(
    end
    subsection Loads
      set Face loads = push
      subsection Face load push
        set Body = block
        set Face = right
        set Pressure = 3
      end
    end)",
                        {"Loads/Face load push/Where=" + where});
    SolidModel<dim> model(scene, MPI_COMM_WORLD);
    NodalVector     forces = model.make_vector();
    model.loads(model.make_vector(), 0, forces);
    double along_x = 0;
    model.for_each_owned_node(
      [&](const auto &, const auto &dofs) { along_x += forces[dofs[0]]; });
    EXPECT_NEAR(along_x, -3 * model.loaded_areas()[0], 1e-12);
    return -along_x / 3;
  };
  const std::integral_constant<int, 2> plane;
  const std::integral_constant<int, 3> space;
  EXPECT_NEAR(resultant_over_area(plane, "1"), 1, 1e-12);
  for (const double end : {0.25, 0.31, 0.6, 0.99})
    EXPECT_NEAR(resultant_over_area(plane, digits(end) + " - y"), end, 5e-4);
  EXPECT_NEAR(resultant_over_area(space, "0.7^2 - y^2 - z^2"),
              pi / 4 * 0.49,
              1e-3);
}



TEST(ReferenceInEquilibrium, ABodyThatNothingHoldsIsRefused)
{
  const auto    problem = problem_from<2>(R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0, 0.5
        set Upper corner = 1, 1
      end
      set Material = linear elastic
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 100
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = 2, 2
    end
    subsection Boundaries
      set left = slip
    end)",
                                       {"Reference/Method=quasi-static"});
  SolidModel<2> model(problem, MPI_COMM_WORLD);
  try
    {
      ReferenceSolver<2> solver(model);
      FAIL() << "not refused";
    }
  catch (const ComputationError &error)
    {
      EXPECT_NE(std::string(error.what()).find("the translation along y"),
                std::string::npos)
        << error.what();
    }
}
