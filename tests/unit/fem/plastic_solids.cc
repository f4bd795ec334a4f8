// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/fem/solid_samples.h>
#include <limber/fem/solid_totals.h>

#include <gtest/gtest.h>
#include <support/solid_scene.h>

#include <cmath>

/** @file Finite elements of laws that flow, on exact solutions. */
using namespace limber;

namespace
{
  constexpr double sy = 1e-3, hardening = 0.05; // over Young's modulus

  template <int dim>
  std::string
  cube(const std::string &law)
  {
    const std::string corner = dim == 2 ? "1, 1" : "1, 1, 1";
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = block\n"
           "subsection Body block\n"
           "  subsection Box\n set Upper corner = " +
           corner + "\n end\n set Material = " + law +
           "\n"
           "  subsection J2\n"
           "    set Density = 1\n set Young's modulus = 1\n"
           "    set Poisson's ratio = 0.3\n"
           "    set Yield stress = 1e-3\n set Hardening modulus = 0.05\n"
           "  end\n"
           "  subsection Drucker prager\n"
           "    set Density = 1\n set Young's modulus = 1\n"
           "    set Poisson's ratio = 0.3\n set Cohesion = 1e-3\n"
           "    set Friction angle = 20\n set Tensile strength = 1\n"
           "  end\n"
           "end\n"
           "subsection Grid\n set Upper corner = " +
           corner +
           "\nend\n"
           "subsection Reference\n set Elements = " +
           (dim == 2 ? "3, 3" : "2, 2, 2") +
           "\n set Method = quasi-static\n set Tolerance = 1e-10\nend\n";
  }



  // Forces against their tangent, in a step that begins where one has flowed.
  template <int dim>
  void
  compare_tangent(const std::string              &element,
                  const std::string              &law,
                  const std::vector<std::string> &changes = {})
  {
    SCOPED_TRACE(element + ", " + law + ", " + std::to_string(dim) + "d");
    std::vector<std::string> all = {"Reference/Element=" + element,
                                    "Boundaries/left=free",
                                    "Boundaries/right=free",
                                    "Boundaries/bottom=free",
                                    "Boundaries/top=free"};
    all.insert(all.end(), changes.begin(), changes.end());
    const auto      problem = problem_from<dim>(cube<dim>(law), all);
    SolidModel<dim> model(problem, MPI_COMM_WORLD);

    NodalVector u = model.make_vector(), direction = model.make_vector();
    double      seed   = 1;
    const auto  random = [&]() {
      seed = std::fmod(16807 * seed, 2147483647.);
      return seed / 2147483647. - 0.5;
    };
    for (const auto i : u.locally_owned_elements())
      u[i] = 0.02 * random();
    model.held().clear(u);
    u.update_ghost_values();
    EXPECT_GT(model.accept(u), 0);
    for (const auto i : u.locally_owned_elements())
      {
        u[i] += 0.005 * random();
        direction[i] = random();
      }
    model.held().clear(u);
    model.held().clear(direction);
    u.update_ghost_values();

    typename SolidModel<dim>::Matrix tangent;
    model.reinit(tangent);
    ASSERT_TRUE(model.assemble(u, 0, tangent));
    NodalVector product = model.make_vector(), ahead = product,
                behind = product;
    tangent.vmult(product, direction);

    constexpr double h = 1e-7;
    u.add(h, direction);
    u.update_ghost_values();
    ASSERT_TRUE(model.internal_forces(u, ahead));
    u.add(-2 * h, direction);
    u.update_ghost_values();
    ASSERT_TRUE(model.internal_forces(u, behind));
    ahead -= behind;
    ahead *= 1 / (2 * h);
    model.held().clear(ahead);
    model.held().clear(product);
    const double size = product.l2_norm();
    product -= ahead;
    EXPECT_LT(product.l2_norm(), 1e-5 * size);
  }
} // namespace



TEST(PlasticElements, TangentIsTheDerivativeOfTheForces)
{
  for (const std::string &element : reference_elements)
    {
      compare_tangent<2>(element, "j2");
      compare_tangent<3>(element, "j2");
      compare_tangent<2>(element, "drucker prager");
      compare_tangent<2>(element,
                         "drucker prager",
                         {"Body block/Drucker prager/Dilatancy angle=10"});
    }
  compare_tangent<3>("Q1-P0-P0", "drucker prager");
}



// A bar that is drawn out: the Kirchhoff stress is the yield stress, which has
// grown with the plastic strain, in every step; its work is what strain and
// flow have taken up. The stretch is the elastic one, J stress / E, and the
// plastic one, which the law measures at dev(be): to a share of the elastic
// strain.
TEST(PlasticElements, BarFollowsTheUniaxialCurve)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      constexpr unsigned int n_steps = 40;
      const auto             pulled =
        problem_from<3>(cube<3>("j2") + R"(
          subsection Loads
            set Face loads = pull
            subsection Face load pull
              set Body = block
              set Face = right
              set Traction = 0.005; 0; 0
            end
          end)",
                        {"Reference/Element=" + element,
                         "Reference/Elements=1, 1, 1",
                         "Reference/Load steps=" + std::to_string(n_steps),
                         "Grid/Upper corner=2, 2, 2"});
      SolidModel<3>          model(pulled, MPI_COMM_WORLD);
      ReferenceSolver<3>     solver(model);
      const dealii::Point<3> end(1, 1, 1);
      const auto            &motion   = solver.motion();
      unsigned int           n_flowed = 0;
      for (unsigned int k = 0; k < n_steps; ++k)
        {
          solver.advance(solver.longest_step());
          const auto here =
            sample_at(model, end, motion.displacement, motion.velocity);
          const MaterialState &now    = here.material;
          const double         alpha  = now.variables[0];
          const double         stress = now.volume_ratio * now.stress[0][0];
          EXPECT_NEAR(now.stress[1][1], 0, 1e-9);
          if (alpha == 0)
            {
              EXPECT_LT(stress, sy);
              continue;
            }
          ++n_flowed;
          EXPECT_NEAR(stress, sy + hardening * alpha, 1e-9);
          EXPECT_NEAR(std::log(1 + here.displacement[0]),
                      alpha + stress,
                      (stress + (alpha + stress) / n_flowed) *
                        (alpha + stress));
        }
      EXPECT_GT(n_flowed, n_steps / 2);
      EXPECT_NEAR((strain_totals(model, motion.displacement).strain_energy +
                   motion.plastic_work) /
                    motion.load_work,
                  1,
                  2e-3);
    }
}



// Pressed in plane strain the difference of the principal stresses is 2 sy /
// sqrt(3) where it flows (without hardening).
TEST(PlasticElements, PlaneStrainFlowsAtTwoOverRootThree)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const auto problem =
        problem_from<2>(cube<2>("j2"),
                        {"Reference/Element=" + element,
                         "Reference/Load steps=20",
                         "Body block/J2/Hardening modulus=0",
                         "Boundaries/right=velocity",
                         "Boundaries/Side right/Velocity=-0.01*x; 0.01*y",
                         "Boundaries/top=velocity",
                         "Boundaries/Side top/Velocity=-0.01*x; 0.01*y"});
      SolidModel<2>      model(problem, MPI_COMM_WORLD);
      ReferenceSolver<2> solver(model);
      for (unsigned int k = 0; k < 20; ++k)
        solver.advance(solver.longest_step());
      const auto &u = solver.motion().displacement;
      const auto &s =
        sample_at(model, dealii::Point<2>(0.5, 0.5), u, u).material.stress;
      EXPECT_NEAR(s[1][1] - s[0][0], 2 * sy / std::sqrt(3.), 2e-3 * sy);
    }
}



// A block flung against a wall: what flow takes is what the motion loses, with
// an error that falls with the step.
TEST(PlasticElements, EnergyIsKeptInTime)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const auto problem =
        problem_from<2>(cube<2>("j2"),
                        {"Reference/Element=" + element,
                         "Reference/Method=implicit",
                         "Grid/Upper corner=2, 2",
                         "Body block/Initial velocity=-0.05*x; 0"});
      std::vector<double> lost;
      for (const double step : {0.02, 0.01})
        {
          SolidModel<2>      model(problem, MPI_COMM_WORLD);
          ReferenceSolver<2> solver(model);
          const auto        &motion = solver.motion();
          const double       start  = kinetic_energy(model, motion.velocity);
          for (double time = 0; time < 1 - 0.5 * step; time += step)
            solver.advance(step);
          const double plastic = motion.plastic_work;
          EXPECT_GT(plastic, 0.1 * start);
          lost.push_back(
            (kinetic_energy(model, motion.velocity) + plastic +
             strain_totals(model, motion.displacement).strain_energy) /
              start -
            1);
        }
      EXPECT_LT(std::abs(lost[1]), 0.01);
      EXPECT_LT(std::abs(lost[1]), 0.7 * std::abs(lost[0]) + 1e-4);
    }
}



TEST(PlasticElements, WhatTheyDoNotKnowIsRefused)
{
  const auto message = [](const std::vector<std::string> &changes) {
    try
      {
        const auto    problem = problem_from<2>(cube<2>("j2"), changes);
        SolidModel<2> model(problem, MPI_COMM_WORLD);
      }
    catch (const InputError &error)
      {
        return std::string(error.what());
      }
    return std::string();
  };
  EXPECT_EQ(message({}), "");
  EXPECT_NE(message({"Body block/J2/Viscosity=1"}).find("flows at a rate"),
            std::string::npos);
  EXPECT_NE(message({"Reference/Method=explicit"}).find("explicit"),
            std::string::npos);
}
