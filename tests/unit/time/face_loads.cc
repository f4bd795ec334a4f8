// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/adaptation/adaptation.h>
#include <limber/problem/read_parts.h>

#include <gtest/gtest.h>
#include <support/resultant.h>

/**
 * @file Loads on faces of boxes and blocks: force and moment of what the
 * nodes get, and how both follow the motion.
 */

using namespace limber;
using dealii::Point;
using dealii::Tensor;

namespace
{
  /** Cook's panel, or a twisted hexahedron none of whose faces is plane. */
  template <int dim>
  std::string
  block_scene(const unsigned int n_cells)
  {
    const std::string corners = dim == 2 ?
                                  "0, 0; 48, 44; 48, 60; 0, 44" :
                                  "4, 4, 2; 40, 8, 6; 44, 40, 2; 8, 44, 4;"
                                  "6, 2, 30; 44, 6, 40; 40, 48, 36; 2, 40, 44";
    std::string       cells   = std::to_string(n_cells);
    for (int d = 1; d < dim; ++d)
      cells += ", " + std::to_string(n_cells);
    return R"(
      set Dimension = )" +
           std::to_string(dim) + R"(
      set Bodies = panel
      subsection Body panel
        set Shape = block
        set Placement = fitted
        subsection Block
          set Corners = )" +
           corners + R"(
        end
        subsection Linear elastic
          set Density = 1
          set Young's modulus = 1e-9
        end
      end
      subsection Grid
        set Lower corner = )" +
           (dim == 2 ? "-8, -8" : "-8, -8, -8") + R"(
        set Upper corner = )" +
           (dim == 2 ? "72, 72" : "72, 72, 72") + R"(
        set Cells = )" +
           cells + R"(
      end
      subsection Loads
        set Face loads = load
        subsection Face load load
          set Body = panel)";
  }



  /** The same, of a load t(x) da or -p(x) n da on a face, by Gauss's rule. */
  template <int dim, class Load>
  Resultant<dim>
  exact(const SceneRun<dim> &run, const unsigned int face, const Load &load)
  {
    const auto &block =
      dynamic_cast<const BlockShape<dim> &>(*run.problem.bodies[0].shape);
    const dealii::QGauss<dim - 1> gauss(20);
    const unsigned int            normal = face / 2;
    Resultant<dim>                result;
    for (unsigned int q = 0; q < gauss.size(); ++q)
      {
        Point<dim> xi;
        xi[normal]     = face % 2;
        unsigned int e = 0;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != normal)
            xi[d] = gauss.point(q)[e++];
        // n da = det J J^-T n_xi da_xi
        const auto     slopes = block.jacobian(xi);
        Tensor<1, dim> unit;
        unit[normal] = face % 2 == 1 ? 1 : -1;
        const Tensor<1, dim> area =
          determinant(slopes) * (transpose(invert(slopes)) * unit);
        const Tensor<1, dim> force = load(block.place(xi), area);
        result.force += gauss.weight(q) * force;
        result.moment +=
          gauss.weight(q) * outer_product(block.place(xi), force);
      }
    return result;
  }



  std::string
  vector_formula(const int dim, const std::string &x_and_y)
  {
    return x_and_y + (dim == 2 ? "" : "; -0.5");
  }



  /** "x; 3 - 0.1*y" and, in three dimensions, "; -0.5", times the area. */
  template <int dim>
  Tensor<1, dim>
  linear_traction(const Point<dim> &place, const Tensor<1, dim> &area)
  {
    Tensor<1, dim> traction;
    traction[dim - 1] = -0.5;
    traction[0]       = place[0];
    traction[1]       = 3 - 0.1 * place[1];
    return area.norm() * traction;
  }



  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
} // namespace

template <typename T>
class FaceLoads : public testing::Test
{};

TYPED_TEST_SUITE(FaceLoads, Dimensions);



// A constant pressure has its exact force on any face, a constant traction on
// plane ones; so has the moment where edges are parallel. The rest converges
// with the second order of the midpoint rule.
TYPED_TEST(FaceLoads, HaveTheForceAndTheMomentOfTheirFormula)
{
  constexpr int dim   = TypeParam::value;
  const auto    names = side_names(dim);
  for (const std::string placement : {"fitted", "regular"})
    for (unsigned int face = 0; face < 2 * dim; ++face)
      {
        SCOPED_TRACE(placement + ", " + names[face]);
        const std::string end = "\nset Face = " + names[face] + "\nend\nend\n";
        const auto        on_grid = [&](const unsigned int n,
                                 const std::string &load) {
          return SceneRun<dim>(block_scene<dim>(n) + "\n" + load + end,
                               {"Body panel/Placement=" + placement});
        };

        SceneRun<dim>        pressed     = on_grid(8, "set Pressure = 2.5");
        const Resultant<dim> pressure    = Resultant<dim>(pressed),
                             of_pressure = exact(pressed,
                                                 face,
                                                 [](const Point<dim> &,
                                                    const Tensor<1, dim> &area)
                                                   -> Tensor<1, dim> {
                                                   return -2.5 * area;
                                                 });
        EXPECT_LT((pressure.force - of_pressure.force).norm(),
                  1e-12 * of_pressure.force.norm());

        // a formula of place
        const auto miss = [&](const unsigned int n) {
          SceneRun<dim> run =
            on_grid(n, "set Traction = " + vector_formula(dim, "x; 3 - 0.1*y"));
          const Resultant<dim> result(run),
            wanted = exact(run, face, linear_traction<dim>);
          return std::make_pair((result.force - wanted.force).norm() /
                                  wanted.force.norm(),
                                (result.moment - wanted.moment).norm() /
                                  (60 * wanted.force.norm()));
        };
        const unsigned int n      = dim == 2 ? 10 : 6;
        const auto         coarse = miss(n), fine = miss(2 * n);
        EXPECT_LT(coarse.first, dim == 2 ? 1e-12 : 2e-3);
        EXPECT_LT(coarse.second, 6e-4);
        EXPECT_LT(fine.first, std::max(0.3 * coarse.first, 1e-12));
        EXPECT_LT(fine.second, 0.3 * coarse.second);
      }
}



// Under a linear velocity field the body deforms homogeneously, here by F = 1 +
// dt L in each step, and n da = J F^-T N dA (Nanson) to round-off. A traction
// stays what it was, on its initial place.
TYPED_TEST(FaceLoads, PressureFollowsTheFaceAndTractionDoesNot)
{
  constexpr int  dim = TypeParam::value;
  Tensor<2, dim> gradient;
  for (int d = 0; d < dim; ++d)
    for (int e = 0; e < dim; ++e)
      gradient[d][e] = 0.03 * (d == e) + 0.3 * (d - e) + 0.02 * d * e;
  for (const bool is_pressure : {true, false})
    {
      SceneRun<dim>      run(block_scene<dim>(10) +
                        (is_pressure ?
                                "\nset Pressure = 2" :
                                "\nset Traction = " + vector_formula(dim, "x; 1")) +
                        "\nset Face = right\nend\nend\n");
      ExternalLoads<dim> loads(run.problem, run.grid, run.bodies);
      const auto         before = Resultant<dim>(run, loads).force;

      set_nodal_velocity(run, gradient);
      const double         dt = 0.1;
      const Tensor<2, dim> one(dealii::unit_symmetric_tensor<dim>());
      Tensor<2, dim>       F = one;
      for (const bool remapped : {false, true})
        {
          StressSweep motion;
          motion.step     = dt;
          motion.remapped = remapped;
          loads.deform(run.nodes, motion);
          F                = (one + (remapped ? 2 : 1) * dt * gradient) * F;
          const auto after = Resultant<dim>(run, loads).force;
          const auto wanted =
            is_pressure ?
              Tensor<1, dim>(determinant(F) * (transpose(invert(F)) * before)) :
              before;
          EXPECT_LT((after - wanted).norm(), 1e-12 * wanted.norm());
        }
    }
}



// The same box by two corners and by four: the same run.
TYPED_TEST(FaceLoads, ABoxAsABlockIsTheSameBody)
{
  constexpr int     dim  = TypeParam::value;
  const std::string zero = dim == 2 ? "" : ", 0", two = dim == 2 ? "" : ", 2";
  const std::string text = R"(
    set Dimension = )" + std::to_string(dim) +
                           R"(
    set Bodies = block
    subsection Body block
      set Shape = box
      set Placement = regular
      subsection Box
        set Lower corner = 1, 1)" +
                           zero + R"(
        set Upper corner = 3, 2)" +
                           two + R"(
      end
      subsection Block
        set Corners = 1, 1)" +
                           zero + "; 3, 1" + zero + "; 3, 2" + zero + "; 1, 2" +
                           zero +
                           (dim == 2 ? "" :
                                       "; 1, 1, 2; 3, 1, 2; 3, 2, 2; 1, 2, 2") +
                           R"(
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e5
      end
    end
    subsection Grid
      set Upper corner = )" +
                           (dim == 2 ? "4, 4" : "4, 4, 4") + R"(
      set Cells = )" + (dim == 2 ? "8, 8" : "8, 8, 8") +
                           R"(
    end
    subsection Boundaries
      set left = no slip
    end
    subsection Loads
      set Face loads = press, pull
      subsection Face load press
        set Body = block
        set Face = top
        set Pressure = 100*x
      end
      subsection Face load pull
        set Body = block
        set Face = right
        set Traction = )" + vector_formula(dim, "100; 200*y") +
                           R"(
      end
    end)";
  SceneRun<dim> reference(text);
  reference.advance(1e-3, 100);
  const auto wanted = reference.totals();
  EXPECT_GT(wanted.load_work, 0);
  EXPECT_LT(std::abs(wanted.energy_drift), 1e-2);
  EXPECT_LT(wanted.momentum_error, 1e-12);
  for (const std::string shape : {"box", "block"})
    for (const std::string placement : {"regular", "cut", "fitted"})
      {
        SCOPED_TRACE(shape + ", " + placement);
        SceneRun<dim> run(text,
                          {"Body block/Shape=" + shape,
                           "Body block/Placement=" + placement});
        run.advance(1e-3, 100);
        const auto totals = run.totals();
        EXPECT_EQ(totals.points, wanted.points);
        EXPECT_NEAR(totals.load_work,
                    wanted.load_work,
                    1e-10 * wanted.load_work);
        EXPECT_NEAR(totals.all.strain_energy,
                    wanted.all.strain_energy,
                    1e-10 * wanted.all.strain_energy);
        EXPECT_LT((totals.all.momentum - wanted.all.momentum).norm(),
                  1e-10 * wanted.all.momentum.norm());
        EXPECT_LT((totals.all.mass_moment - wanted.all.mass_moment).norm(),
                  1e-10 * wanted.all.mass_moment.norm());
      }
}



namespace
{
  // A corner in either dimension, to end a line of a scene with
  template <int dim>
  std::string
  corner(const std::string &x_y, const std::string &z)
  {
    return x_y + (dim == 3 ? ", " + z : "") + "\n";
  }



  /**
   * A block that a pressure on its top holds the stress of, with cells of three
   * sizes under that face, fine ones within @p refinement.
   */
  template <int dim>
  std::string
  held_block(const double height, const std::string &refinement)
  {
    return "set Dimension = " + std::to_string(dim) + R"(
      set Bodies = block
      subsection Body block
        set Material       = linear elastic
        set Initial stress = xx: -5; yy: -10; zz: -5
        subsection Box
          set Upper corner = )" +
           corner<dim>("1, " + digits(height), "0.4") + R"(
        end
        subsection Linear elastic
          set Density         = 1000
          set Young's modulus = 1e6
        end
      end
      subsection Grid
        set Upper corner = )" +
           corner<dim>("1, 1", "0.4") +
           "set Cells = " + corner<dim>("10, 10", "4") + R"(
        set Levels = 2
        set Refine = middle
        subsection Refine middle
          )" +
           refinement +
           R"(
        end
      end
      subsection Loads
        set Face loads = weight
        subsection Face load weight
          set Body     = block
          set Face     = top
          set Pressure = 10
        end
      end)";
  }



  // What the pressure alone would set a free face in motion by, m/s
  const double speed_of_wave = 10 * 2.7e-5;



  template <int dim>
  double
  largest_speed(SceneRun<dim> &run)
  {
    double result = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      result = std::max(result, run.velocity(p).norm());
    return result;
  }



  template <int dim>
  void
  expect_rest(const double height)
  {
    SCOPED_TRACE(std::to_string(dim) + " dimensions, " + digits(height));
    SceneRun<dim> run(held_block<dim>(
      height,
      "set Lower corner = " + corner<dim>("0.45, 0.4", "0") +
        "set Upper corner = " + corner<dim>("0.55, 0.8", "0.1")));
    run.advance(run.integrator.longest_step(), 5);
    EXPECT_LT(largest_speed(run), 1e-9 * speed_of_wave);
  }
} // namespace



// Whichever points carry the load, in fine cells or beside coarse ones, nothing
// moves. The face lies between two rows of cells, where round-off decides which
// of them it belongs to.
TEST(FaceLoadsOnLevels, APressureHoldsTheStressThatItBrings)
{
  for (const double height : {0.5, 0.6, 0.7, 0.8})
    {
      expect_rest<2>(height);
      expect_rest<3>(height);
    }
}



// Points that carry the load are split like others when fine cells come, and
// those that there are then carry it.
TEST(FaceLoadsOnLevels, PiecesFollowPointsThatAreSplit)
{
  SceneRun<2>   run(held_block<2>(0.7, "set Where = 0.1 - abs(x - t)"));
  Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  const double                    step     = run.integrator.longest_step();
  const auto                      n_before = run.points().size;
  for (unsigned int k = 1; k <= 5; ++k)
    {
      const auto loaded = run.integrator.detached_pieces();
      ASSERT_TRUE(adaptation.adapt(0.17 * k, kept));
      run.integrator.reinit();
      run.integrator.attach(loaded);
      run.advance(step, 3);
      EXPECT_LT(largest_speed(run), 1e-9 * speed_of_wave) << k;
    }
  EXPECT_GT(run.points().size, 2 * n_before);
}



// Also where the body has gone: the nearest point is that of now.
TEST(FaceLoadsOnLevels, PiecesFollowPointsThatHaveMoved)
{
  SceneRun<2>                     run(R"(
    set Bodies = block
    subsection Body block
      set Material         = linear elastic
      set Initial velocity = 0.5; 0.25
      subsection Box
        set Lower corner = 0.1, 0.1
        set Upper corner = 0.3, 0.3
      end
    end
    subsection Grid
      set Cells  = 10, 10
      set Levels = 1
      set Refine = right
      subsection Refine right
        set Where = if(t > 0.5, x - 0.4, -1)
      end
    end
    subsection Loads
      set Face loads = nothing
      subsection Face load nothing
        set Body     = block
        set Face     = surface
        set Pressure = 0
      end
    end)");
  Adaptation<2>                   adaptation(run.problem, run.grid, run.bodies);
  const Adaptation<2>::KeptPoints kept(1);
  run.advance_to(1);
  const auto loaded = run.integrator.detached_pieces();
  ASSERT_TRUE(adaptation.adapt(run.time, kept));
  run.integrator.reinit();
  run.integrator.attach(loaded);
  const auto faces = run.integrator.state().face_pieces;
  ASSERT_EQ(faces[0].size(), loaded[0].size());
  for (const auto &piece : faces[0]) // in fine cells of 0.05 m, 2 x 2 points
    EXPECT_LT(piece.arm.norm(), 0.026);
}
