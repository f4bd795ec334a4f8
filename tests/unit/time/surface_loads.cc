// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>

#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/resultant.h>

#include <array>
#include <cmath>
#include <iostream>

/**
 * @file Loads on the surfaces of shapes that have no faces: force and moment,
 * what bears them, and solids at rest under pressure against exact solutions.
 */

using namespace limber;
using dealii::Point;
using dealii::Tensor;
using dealii::numbers::PI;

namespace
{
  /** A body in a grid of cubes, its load to be completed. */
  template <int dim>
  std::string
  scene(const std::string &shape, const unsigned int n_cells)
  {
    std::string cells = std::to_string(n_cells);
    for (int d = 1; d < dim; ++d)
      cells += ", " + std::to_string(n_cells);
    return R"(
      set Dimension = )" +
           std::to_string(dim) + R"(
      set Bodies = body
      subsection Body body
        )" +
           shape +
           R"(
        subsection Linear elastic
          set Density = 1
          set Young's modulus = 1000
          set Poisson's ratio = 0.3
        end
      end
      subsection Grid
        set Lower corner = )" +
           (dim == 2 ? "0, 0" : "0, 0, 0") + R"(
        set Upper corner = )" +
           (dim == 2 ? "2.25, 2.25" : "2.25, 2.25, 2.25") + R"(
        set Cells = )" +
           cells + R"(
      end
      subsection Loads
        set Face loads = load
        subsection Face load load
          set Body = body
          set Face = surface
          )";
  }



  const std::string end = "\nend\nend\n";

  template <int dim>
  const std::string ball = R"(
    set Shape = ball
    subsection Ball
      set Centre = )" +
                           std::string(dim == 2 ? "1.13, 1.07" :
                                                  "1.13, 1.07, 1.11") +
                           R"(
      set Radius = 0.8
    end)";

  const std::string ring = R"(
    set Shape = formula
    set Placement = cut
    subsection Formula
      set Inside = (x^2 + y^2 - 1)*(4 - x^2 - y^2)
    end)";



  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
} // namespace

template <typename T>
class SurfaceLoads : public testing::Test
{};

TYPED_TEST_SUITE(SurfaceLoads, Dimensions);



// The work of a pressure under any linear velocity field is p dV/dt, so sum x_i
// (x) f_i is p V times the unit tensor; V is that of the polygon or
// polyhedron.
TYPED_TEST(SurfaceLoads, UniformPressureOnAClosedSurfaceDoesTheWorkOfItsVolume)
{
  constexpr int        dim = TypeParam::value;
  const Tensor<2, dim> one(dealii::unit_symmetric_tensor<dim>());
  const double volume = dim == 2 ? PI * 0.64 : 4 * PI / 3 * 0.512, p = 2.5;
  for (const std::string placement : {"regular", "cut", "jittered"})
    {
      SCOPED_TRACE(placement);
      double former = 0;
      for (const unsigned int n : {10, 21})
        {
          SceneRun<dim> run(scene<dim>(ball<dim>, n) + "set Pressure = 2.5" +
                              end,
                            {"Body body/Placement=" + placement});
          ExternalLoads<dim>   loads(run.problem, run.grid, run.bodies);
          const Resultant<dim> result(run, loads);
          EXPECT_LT(result.force.norm(), 1e-12 * p);
          const double found = -trace(result.moment) / dim;
          EXPECT_LT((result.moment + found * one).norm(), 1e-12 * p);
          const double miss = std::abs(found / (p * volume) - 1);
          EXPECT_LT(miss, n == 10 ? 0.02 : 0.3 * former);
          former = miss;

          // and it stays closed where all deforms alike
          Tensor<2, dim> gradient;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              gradient[d][e] = 0.3 * (d == e) + 0.8 * (d - e) + 0.2 * d * e;
          set_nodal_velocity(run, gradient);
          StressSweep motion;
          motion.step = 0.1;
          loads.deform(run.nodes, motion);
          EXPECT_LT(Resultant<dim>(run, loads).force.norm(), 1e-12 * p);
        }
    }
}



// The force of a constant traction is the area that bears it.
TYPED_TEST(SurfaceLoads, TractionActsWhereItIsWanted)
{
  constexpr int     dim = TypeParam::value;
  const std::string traction =
    "\nset Traction = 0; 1" + std::string(dim == 2 ? "" : "; 0");
  const auto area = [&](const std::string &shape,
                        const unsigned int n,
                        const std::string &where) {
    SceneRun<dim> run(scene<dim>(shape, n) + "set Where = " + where + traction +
                      end);
    return Resultant<dim>(run).force[1];
  };

  // a cap and the rest
  const double height = 0.31, r = 0.8;
  const double cap =
    dim == 2 ? 2 * r * std::acos(1 - height / r) : 2 * PI * r * height;
  const double whole = dim == 2 ? 2 * PI * r : 4 * PI * r * r;
  EXPECT_NEAR(area(ball<dim>, 24, "y - 1.56"), cap, 2e-3 * whole);
  EXPECT_NEAR(area(ball<dim>, 24, "1.56 - y"), whole - cap, 3e-3 * whole);

  // A block is divided to the last bit, and so is a face of it.
  const std::string box = R"(
    set Shape = box
    subsection Box
      set Lower corner = )" +
                          std::string(dim == 2 ? "0.2, 0.3" : "0.2, 0.3, 0.4") +
                          R"(
      set Upper corner = )" +
                          std::string(dim == 2 ? "1.2, 1.3" : "1.2, 1.3, 1.4") +
                          "\nend\n";
  const double wanted = dim == 2 ? 1 + 2 * 0.37 : 1 + 4 * 0.37;
  EXPECT_NEAR(area(box, 12, "y - 0.93"), wanted, 1e-12);
  SceneRun<dim> face(scene<dim>(box, 12) + "set Where = y - 0.93" + traction +
                       end,
                     {"Loads/Face load load/Face=right"});
  EXPECT_NEAR(Resultant<dim>(face).force[1], 0.37, 1e-12);
}



// A union of two boxes has no surface where they meet.
TYPED_TEST(SurfaceLoads, UnionsHaveOneSurface)
{
  constexpr int     dim  = TypeParam::value;
  const std::string last = dim == 2 ? "" : ", 0.5";
  const std::string next = dim == 2 ? "" : ", 1.5";
  const std::string both = R"(
    set Shape = union
    subsection Union
      set Shapes = a, b
      subsection Shape a
        subsection Box
          set Lower corner = 0.25, 0.5)" +
                           last + R"(
          set Upper corner = 1, 1.5)" +
                           next + R"(
        end
      end
      subsection Shape b
        subsection Box
          set Lower corner = 1, 0.5)" +
                           last + R"(
          set Upper corner = 1.75, 1.5)" +
                           next + R"(
        end
      end
    end)";
  SceneRun<dim> run(scene<dim>(both, 9) + "set Traction = 1; 0" +
                    (dim == 2 ? "" : "; 0") + end);
  EXPECT_NEAR(Resultant<dim>(run).force[0], dim == 2 ? 5 : 8, 1e-11);
}



// What lies in the sides of the grid is held there. The rest of the closed
// surface has the opposite force.
TEST(SurfaceLoads, SidesOfTheGridAreNoFreeSurface)
{
  const std::string box = "set Shape = box\n"
                          "subsection Box\nset Lower corner = 0, 0\n"
                          "set Upper corner = 1, 1\nend\n";
  for (const std::string &shape : {ring, box})
    {
      SceneRun<2>        run(scene<2>(shape, 18) + "set Pressure = 3" + end);
      const Resultant<2> result(run);
      EXPECT_LT((result.force + Point<2>(3, 3)).norm(), 1e-9);
    }
}



TEST(SurfaceLoads, MustFindSomethingToLoad)
{
  const std::string text    = scene<2>(ball<2>, 10) + "set Pressure = 1" + end;
  const auto        message = [&](const std::string &change) -> std::string {
    try
      {
        SceneRun<2> run(text, {change});
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "nothing wrong";
  };
  const std::string where = message("Loads/Face load load/Where=y - 3");
  for (const std::string part :
       {"'Face load load'", "'body'", "'Where = y - 3'"})
    EXPECT_NE(where.find(part), std::string::npos) << where;
}



namespace
{
  /**
   * Set it to rest under a load that rises in 1 s, and return the error of the
   * displacement, weighted by mass, relative to the exact one (L2).
   */
  template <int dim, class Exact>
  double
  relative_error(const std::string &shape,
                 const std::string &load,
                 const unsigned int n_cells,
                 const std::string &treatment,
                 const Exact       &exact)
  {
    SceneRun<dim> run(scene<dim>(shape, n_cells) + load + end,
                      {"Method/Damping rate=40",
                       "Body body/Locking treatment=" + treatment});
    const auto    start = run.positions();
    run.advance_to(1.5);
    const PointView<dim> points = run.points();
    double               error = 0, whole = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const Point<dim>    &from   = start[run.bodies[0]->points.id(p)];
        const Tensor<1, dim> wanted = exact(from);
        const Tensor<1, dim> found  = run.position(p) - from;
        error += points.mass[p] * (found - wanted).norm_square();
        whole += points.mass[p] * wanted.norm_square();
      }
    return std::sqrt(error / whole);
  }



  const std::string slow_rise = "set Pressure = if(t < 1, t, 1)";
} // namespace



// Lame's solution in plane strain, a = 1, b = 2:
// u_r = (1 + nu)/E a^2 p/(b^2 - a^2) ((1 - 2 nu) r + b^2/r).
TEST(SurfaceLoads, PressedRingIsThatOfLame)
{
  const auto exact = [](const Point<2> &x) -> Tensor<1, 2> {
    const double r = x.norm();
    return 1.3e-3 / 3 * (0.4 * r + 4 / r) * x / r;
  };
  for (const std::string treatment : {"none", "cell"})
    {
      const auto error = [&](const unsigned int n) {
        return relative_error<2>(ring,
                                 "set Where = 1.5 - sqrt(x^2 + y^2)\n" +
                                   slow_rise,
                                 n,
                                 treatment,
                                 exact);
      };
      const double coarse = error(9), fine = error(18);
      EXPECT_LT(coarse, 0.015) << treatment;
      EXPECT_LT(fine, 0.4 * coarse) << treatment;
    }
}



namespace
{
  struct StressError
  {
    double rms, worst; // by mass, and of one point
  };



  // Quasi-static, in the initial frame; exact(r): radial and hoop stress at an
  // initial place
  template <class Exact>
  StressError
  stress_error(const std::string &where,
               const std::string &kernel,
               const std::string &placement,
               const Exact       &exact)
  {
    SceneRun<2> run(scene<2>(ring, 36) + where + "\nset Pressure = 1" + end,
                    {"Boundaries/right=free",
                     "Boundaries/top=free",
                     "Method/Kernel=" + kernel,
                     "Method/Time integration=quasi-static",
                     "Method/Time step=1",
                     "End time=1",
                     "Body body/Frame=initial",
                     "Body body/Placement=" + placement});
    const auto  start = run.positions();
    run.advance(1);
    const PointView<2> points = run.points();
    double             error = 0, whole = 0, worst = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const Point<2> x = start[run.bodies[0]->points.id(p)];
        const double   r = x.norm(), c = x[0] / r, s = x[1] / r;
        const auto [radial, hoop] = exact(r);
        const double xx           = points.deviator[0][p] - points.pressure[p] -
                          radial * c * c - hoop * s * s;
        const double yy = points.deviator[1][p] - points.pressure[p] -
                          radial * s * s - hoop * c * c;
        const double xy     = points.deviator[2][p] - (radial - hoop) * c * s;
        const double square = xx * xx + yy * yy + 2 * xy * xy;
        error += points.mass[p] * square;
        whole += points.mass[p] * (radial * radial + hoop * hoop);
        worst = std::max(worst, std::sqrt(square));
      }
    const StressError result{std::sqrt(error / whole), worst};
    std::cout << "pressed ring, " << kernel << ", " << placement << ": rms "
              << result.rms << " of the stress, worst point " << result.worst
              << " p\n";
    return result;
  }
} // namespace



// Pressed on both circles, also where these cut cells: a constant stress, with
// which the functions at the pieces are in balance.
TEST(SurfaceLoads, PressedAllAroundAConstantStressIsConstant)
{
  for (const std::string kernel : {"linear", "quadratic"})
    for (const std::string placement : {"cut", "gauss"})
      {
        SCOPED_TRACE(kernel + ", " + placement);
        const auto error =
          stress_error("", kernel, placement, [](const double) {
            return std::array<double, 2>{{-1., -1.}};
          });
        EXPECT_LT(error.rms, 0.0105);
        EXPECT_LT(error.worst, 0.3);
      }
}



// Lame's stress, a^2 p / (b^2 - a^2) (1 -+ b^2 / r^2)
TEST(SurfaceLoads, PressedFromInsideTheStressIsThatOfLame)
{
  const auto error =
    stress_error("set Where = 1.5 - sqrt(x^2 + y^2)",
                 "quadratic",
                 "gauss",
                 [](const double r) {
                   const double b = 4 / (r * r);
                   return std::array<double, 2>{{(1 - b) / 3, (1 + b) / 3}};
                 });
  EXPECT_LT(error.rms, 0.01);
  EXPECT_LT(error.worst, 0.2);
}



// An eighth of a ball under pressure all around shrinks evenly:
// u = -(1 - 2 nu)/E p x.
TEST(SurfaceLoads, PressedBallShrinksEvenly)
{
  const std::string eighth = "set Shape = formula\nset Placement = cut\n"
                             "subsection Formula\n"
                             "set Inside = 1.9^2 - x^2 - y^2 - z^2\nend\n";
  for (const std::string treatment : {"none", "cell"})
    {
      const auto error = [&](const unsigned int n) {
        return relative_error<3>(eighth,
                                 slow_rise,
                                 n,
                                 treatment,
                                 [](const Point<3> &x) -> Tensor<1, 3> {
                                   return -0.4e-3 * x;
                                 });
      };
      const double coarse = error(7), fine = error(14);
      EXPECT_LT(coarse, 0.015) << treatment;
      EXPECT_LT(fine, 0.4 * coarse) << treatment;
    }
}



// A free disc, off the lattice, under a pressure of a tenth of its stiffness:
// pieces that follow one point each would push and turn it.
TEST(SurfaceLoads, APressureAllAroundDoesNotPushNorTurnAFreeBody)
{
  const std::string disc = "set Shape = ball\nsubsection Ball\n"
                           "set Centre = 1.13, 1.11\nset Radius = 0.7\nend\n";
  const std::string rise = "set Pressure = 100*if(t < 0.1, t/0.1, 1)\n";
  const std::vector<std::string> free = {"Boundaries/left=free",
                                         "Boundaries/right=free",
                                         "Boundaries/bottom=free",
                                         "Boundaries/top=free"};
  for (const std::vector<std::string> &way :
       {std::vector<std::string>{"Body body/Frame=initial"},
        {"Body body/Frame=current", "Method/Kernel=quadratic"},
        {"Body body/Frame=initial", "Method/Time integration=implicit"}})
    {
      std::vector<std::string> changes = free;
      changes.insert(changes.end(), way.begin(), way.end());
      const bool explicit_steps = way.back().find("implicit") == way[0].npos;
      if (!explicit_steps)
        changes.emplace_back("Method/Time step=0.01");
      SceneRun<2> run(scene<2>(disc, 16) + rise + end, changes);
      const auto  start = run.positions();
      if (explicit_steps)
        run.advance_to(0.3);
      else
        for (int step = 0; step < 30; ++step)
          run.advance(0.01);

      const PointView<2> points = run.points();
      double             mass = 0, spin = 0, inertia = 0, smallest = 1;
      Tensor<1, 2>       way_of_centre;
      Point<2>           centre;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          mass += points.mass[p];
          centre += points.mass[p] * run.position(p);
          way_of_centre +=
            points.mass[p] *
            (run.position(p) - start[run.bodies[0]->points.id(p)]);
        }
      centre /= mass;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const Tensor<1, 2> arm  = run.position(p) - centre;
          const Tensor<1, 2> from = start[run.bodies[0]->points.id(p)] - centre;
          spin += points.mass[p] * (from[0] * arm[1] - from[1] * arm[0]);
          inertia += points.mass[p] * arm.norm_square();
          smallest = std::min(smallest, arm.norm() / from.norm());
        }
      EXPECT_LT(smallest, 0.97) << way[0]; // it is pressed
      EXPECT_LT((way_of_centre / mass).norm(), 1e-5) << changes.back();
      EXPECT_LT(std::abs(spin / inertia), 1e-4) << changes.back();
    }
}
