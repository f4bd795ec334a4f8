// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/solid_samples.h>

#include <gtest/gtest.h>
#include <support/solid_scene.h>

#include <cmath>

/**
 * @file The patch test: a body whose boundary moves linearly deforms
 * linearly, on a distorted mesh, at large strain and with every element; and
 * the tangent is the derivative of the forces.
 */
using namespace limber;

namespace
{
  template <int dim>
  std::string
  unit_body()
  {
    const std::string corner = dim == 2 ? "1, 1" : "1, 1, 1";
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = block\n"
           "subsection Body block\n"
           "  subsection Box\n set Upper corner = " +
           corner +
           "\n end\n set Material = neo hookean\n"
           "  subsection Neo hookean\n"
           "    set Density = 1\n set Young's modulus = 1\n"
           "    set Poisson's ratio = 0.45\n"
           "  end\nend\n"
           "subsection Grid\n set Upper corner = " +
           corner + "\nend\n";
  }



  const std::vector<std::string> laws = {"linear elastic", "neo hookean"};



  /** Unit body on a distorted mesh. */
  template <int dim>
  std::unique_ptr<Mesh<dim>>
  distorted_mesh()
  {
    BlockCorners<dim> corners;
    for (unsigned int v = 0; v < corners.size(); ++v)
      for (unsigned int d = 0; d < dim; ++d)
        corners[v][d] = (v >> d) % 2;
    std::array<unsigned int, dim> elements;
    elements.fill(dim == 2 ? 4 : 2);
    auto mesh = make_block_mesh<dim>(corners, elements, MPI_COMM_WORLD);
    distort(*mesh, 0.06);
    return mesh;
  }



  template <int dim>
  void
  run_patch_test(const std::string &element, const std::string &law)
  {
    SCOPED_TRACE(element + ", " + law + ", " + std::to_string(dim) + "d");
    // F - 1: stretch, shear and rotation
    const std::string field =
      dim == 2 ? "0.3*x + 0.2*y; -0.1*x + 0.15*y" :
                 "0.3*x + 0.2*y; -0.1*x + 0.15*y - 0.1*z; 0.05*x + 0.2*z";
    std::vector<std::string> changes = {"Reference/Element=" + element,
                                        "Reference/Method=quasi-static",
                                        "Reference/Tolerance=1e-12",
                                        "Body block/Material=" + law};
    std::vector<std::string> sides   = {"left", "right", "bottom", "top"};
    if (dim == 3)
      sides.insert(sides.end(), {"back", "front"});
    for (const std::string &side : sides)
      {
        changes.push_back("Boundaries/" + side + "=velocity");
        changes.push_back("Boundaries/Side " + side + "/Velocity=" + field);
      }
    const auto           problem = problem_from<dim>(unit_body<dim>(), changes);
    SolidModel<dim>      model(problem, distorted_mesh<dim>());
    ReferenceSolver<dim> solver(model);
    solver.advance(solver.longest_step());

    const Formula<dim> exact(field, {}, dim, "test");
    const auto        &u = solver.motion().displacement;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_NEAR(u[dofs[d]], exact.value(place, 0, d), 1e-10);
    });
    dealii::Point<dim> here, there;
    for (unsigned int d = 0; d < dim; ++d)
      {
        here[d]  = 0.3;
        there[d] = 0.9;
      }
    const auto a = sample_at(model, here, u, u),
               b = sample_at(model, there, u, u);
    ASSERT_TRUE(a.inside && b.inside);
    EXPECT_GT(a.material.stress.norm(), 0.1);
    EXPECT_NEAR((a.material.stress - b.material.stress).norm(), 0, 1e-8);
  }



  /** Directional differences of forces against tangent times direction. */
  template <int dim>
  void
  compare_tangent(const std::string &element, const std::string &law)
  {
    SCOPED_TRACE(element + ", " + law + ", " + std::to_string(dim) + "d");
    const auto      problem = problem_from<dim>(unit_body<dim>(),
                                           {"Reference/Element=" + element,
                                                 "Body block/Material=" + law,
                                                 "Boundaries/left=free",
                                                 "Boundaries/right=free",
                                                 "Boundaries/bottom=free",
                                                 "Boundaries/top=free"});
    SolidModel<dim> model(problem, distorted_mesh<dim>());

    NodalVector u = model.make_vector(), direction = model.make_vector();
    double      seed = 1;
    for (const auto i : u.locally_owned_elements())
      {
        seed         = std::fmod(16807 * seed, 2147483647.);
        u[i]         = 0.03 * (seed / 2147483647. - 0.5);
        seed         = std::fmod(16807 * seed, 2147483647.);
        direction[i] = seed / 2147483647. - 0.5;
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

    constexpr double h = 1e-6;
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
    EXPECT_LT(product.l2_norm(), 1e-7 * size);
  }
} // namespace



TEST(FittedElements, PassThePatchTestInThePlane)
{
  for (const std::string &element : reference_elements)
    for (const std::string &law : laws)
      run_patch_test<2>(element, law);
}



TEST(FittedElements, PassThePatchTestInSpace)
{
  for (const std::string &element : reference_elements)
    for (const std::string &law : laws)
      run_patch_test<3>(element, law);
}



TEST(FittedElements, TangentIsTheDerivativeOfTheForces)
{
  for (const std::string &element : reference_elements)
    for (const std::string &law : laws)
      {
        compare_tangent<2>(element, law);
        compare_tangent<3>(element, law);
      }
}



// A corner pushed so far into its element that the material there is inside
// out, while the quadrature points are not: its state is not known, all others
// are.
TEST(FittedElements, StateOfACornerInsideOutIsNotKnown)
{
  for (const std::string &element : reference_elements)
    {
      SCOPED_TRACE(element);
      const auto problem =
        problem_from<2>(unit_body<2>(), {"Reference/Element=" + element});
      const BlockCorners<2> corners = {{dealii::Point<2>(0, 0),
                                        dealii::Point<2>(1, 0),
                                        dealii::Point<2>(0, 1),
                                        dealii::Point<2>(1, 1)}};
      const SolidModel<2>   model(
        problem, make_block_mesh<2>(corners, {{1, 1}}, MPI_COMM_WORLD));
      NodalVector                   u = model.make_vector();
      std::vector<dealii::Point<2>> places;
      model.for_each_owned_node([&](const auto &place, const auto &dofs) {
        places.push_back(place);
        for (unsigned int d = 0; d < 2; ++d)
          u[dofs[d]] = -0.53 * place[0] * place[1];
      });
      u.compress(dealii::VectorOperation::insert);

      const auto states = nodal_states(model, u);
      ASSERT_EQ(states.size(), places.size());
      for (unsigned int n = 0; n < states.size(); ++n)
        {
          const bool inside_out = places[n].distance(corners[3]) < 1e-10;
          EXPECT_EQ(std::isfinite(states[n].pressure), !inside_out);
          EXPECT_EQ(std::isfinite(states[n].stress.norm()), !inside_out);
        }
      const auto samples = sample_at(model, {corners[0], corners[3]}, u, u);
      EXPECT_TRUE(std::isfinite(samples[0].material.pressure));
      EXPECT_TRUE(std::isnan(samples[1].material.pressure));
    }
}
