// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/natural_modes.h>
#include <limber/fem/solid_samples.h>
#include <limber/fem/solid_totals.h>

#include <gtest/gtest.h>
#include <support/solid_scene.h>

#include <cmath>

/** @file Finite elements in motion: energy, order in time, rigid motion. */
using namespace limber;

namespace
{
  // A rubber block on a shaking wall under gravity, or free
  const std::string block = R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Upper corner = 1, 0.5
      end
      set Material = neo hookean
      subsection Neo hookean
        set Density = 2
        set Young's modulus = 10
        set Poisson's ratio = 0.4
      end
    end
    subsection Grid
      set Lower corner = 0, -1
      set Upper corner = 4, 4
    end
    subsection Boundaries
      set left = velocity
      subsection Side left
        set Velocity = 0.2*sin(3*t); -0.1*t
      end
    end
    subsection Loads
      set Gravity = 0, -0.3
      set Body force = 0.1*t; 0.2
      set Face loads = push
      subsection Face load push
        set Body = block
        set Face = right
        set Traction = 0.2*sin(t); 0.1
      end
    end)";



  struct Outcome
  {
    double               drift = 0; // over the kinetic energy
    dealii::Tensor<1, 2> corner;    // displacement, m
    dealii::Tensor<1, 2> momentum_gap;
  };



  Outcome
  shake(const std::string &element,
        const std::string &method,
        const double       step)
  {
    const auto         problem = problem_from<2>(block,
                                         {"Reference/Element=" + element,
                                                  "Reference/Method=" + method,
                                                  "Reference/Tolerance=1e-10",
                                                  "Reference/Elements over depth=4"});
    SolidModel<2>      model(problem, MPI_COMM_WORLD);
    ReferenceSolver<2> solver(model);
    const unsigned int n      = std::lround(1 / step);
    const auto         energy = [&]() {
      const auto &m = solver.motion();
      return kinetic_energy(model, m.velocity) +
             strain_totals(model, m.displacement).strain_energy -
             problem.loads.gravity * mass_moment(model, m.displacement) -
             m.boundary_work - m.load_work;
    };
    const double start = energy();
    for (unsigned int k = 0; k < n; ++k)
      solver.advance(step);
    const auto &motion = solver.motion();
    EXPECT_NEAR(motion.time, 1, 1e-12);
    Outcome result;
    result.drift  = (energy() - start) / kinetic_energy(model, motion.velocity);
    result.corner = sample_at(model,
                              dealii::Point<2>(1, 0.5),
                              motion.displacement,
                              motion.velocity)
                      .displacement;
    result.momentum_gap =
      momentum(model, motion.velocity) - motion.load_impulse -
      total_mass(model) * motion.time * problem.loads.gravity;
    for (const auto &impulse : motion.side_impulse)
      result.momentum_gap -= impulse;
    return result;
  }
} // namespace



TEST(ReferenceInTime, BodyForceAtPresentAndInitialPlaces)
{
  for (const std::string place : {"present place", "initial place"})
    {
      SCOPED_TRACE(place);
      const auto problem =
        problem_from<2>(block,
                        {"Loads/Face load push/Traction=0; 0",
                         "Loads/Body force=3*x; 0",
                         "Loads/Body force at=" + place});
      SolidModel<2> model(problem, MPI_COMM_WORLD);
      const auto    force_along_x = [&](const double displacement) {
        NodalVector u(model.nodal_masses()), forces(u);
        u = displacement;
        model.loads(u, 0, forces);
        double sum = 0;
        for (const double force : forces)
          sum += force;
        return sum;
      };
      const double mass = total_mass(model);
      EXPECT_NEAR(force_along_x(0), mass * 3 * 0.5, 1e-12);
      EXPECT_NEAR(force_along_x(0.2),
                  mass * 3 * (place == "present place" ? 0.7 : 0.5),
                  1e-12);
    }
}



TEST(ReferenceInTime, NewmarkKeepsEnergyToSecondOrder)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const Outcome coarse = shake(element, "implicit", 0.02);
      const Outcome fine   = shake(element, "implicit", 0.01);
      EXPECT_LT(std::abs(fine.drift), 1e-3);
      EXPECT_LT(std::abs(fine.drift), std::abs(coarse.drift) / 2.5 + 1e-8);
    }
}



TEST(ReferenceInTime, BothMethodsAgree)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const Outcome implicit = shake(element, "implicit", 0.01);
      const Outcome direct   = shake(element, "explicit", 0.002);
      EXPECT_LT(std::abs(direct.drift), 1e-3);
      EXPECT_GT(implicit.corner.norm(), 0.05);
      // lumped masses are of second order with Q1, of fourth with Q2
      EXPECT_LT((implicit.corner - direct.corner).norm(),
                (element[1] == '1' ? 3e-2 : 5e-3) * implicit.corner.norm());
    }
}



// What the wall and the loads give is what the body has.
TEST(ReferenceInTime, ImpulsesMakeTheMomentum)
{
  for (const std::string method : {"implicit", "explicit"})
    {
      const Outcome outcome = shake("Q2-P1-P1", method, 0.002);
      EXPECT_LT(outcome.momentum_gap.norm(), 1e-4);
    }
}



TEST(NaturalModes, AFreeBodyHasItsRigidMotions)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const auto    problem = problem_from<2>(block,
                                           {"Reference/Element=" + element,
                                               "Boundaries/left=free"});
      SolidModel<2> model(problem, MPI_COMM_WORLD);
      const auto    found = natural_frequencies(model, 3);
      EXPECT_EQ(found.n_rigid_motions, 3u);
      ASSERT_EQ(found.frequencies.size(), 3u);
      // a bar of this length has its first axial mode near c / 2 L
      EXPECT_GT(found.frequencies[0], 0.3);
      EXPECT_LT(found.frequencies[2], 3);
    }
  const auto problem = problem_from<3>(
    R"(
    set Dimension = 3
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0.1, 0.1, 0.1
        set Upper corner = 0.9, 0.5, 0.5
      end
      set Material = linear elastic
    end)");
  const SolidModel<3> model(problem, MPI_COMM_WORLD);
  EXPECT_EQ(natural_frequencies(model, 1).n_rigid_motions, 6u);
}
