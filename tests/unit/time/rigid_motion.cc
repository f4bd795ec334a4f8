// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

/**
 * @file Motions that the method must represent exactly, whatever the law, the
 * treatment, the order of the stress update and the transfer: translation,
 * free fall, homogeneous deformation; and rotation up to the order of the law.
 */

using namespace limber;

namespace
{
  struct Variant
  {
    std::string law, treatment, order, transfer, kernel = "linear";
  };



  std::vector<Variant>
  all_variants(const std::vector<std::string> &transfers)
  {
    std::vector<Variant> result;
    for (const std::string law :
         {"linear elastic", "neo hookean", "newtonian fluid"})
      for (const std::string treatment : {"none", "cell"})
        for (const std::string &order : stress_update_orders)
          for (const std::string &transfer : transfers)
            result.push_back({law, treatment, order, transfer});
    // gradients that partly come from the nodes, of solids
    for (const std::string law : {"linear elastic", "neo hookean"})
      for (const std::string treatment : {"none", "cell", "node"})
        for (const std::string &order : stress_update_orders)
          for (const std::string &transfer : transfers)
            result.push_back({law, treatment, order, transfer, "ddmp"});
    return result;
  }



  std::string
  name_of(const Variant &v)
  {
    return v.law + ", " + v.treatment + ", " + v.order + ", " + v.transfer +
           ", " + v.kernel;
  }



  // Shifted points would have velocities of where they have been, and density
  // control would give them the volume that their nodes tell.
  std::vector<std::string>
  overrides(const Variant &v)
  {
    return {"Body block/Material=" + v.law,
            "Body block/Particle shifting=0",
            "Body block/Density control=0",
            "Body block/Locking treatment=" + v.treatment,
            "Method/Stress update=" + v.order,
            "Method/Transfer=" + v.transfer,
            "Method/Kernel=" + v.kernel};
  }



  const std::string block = R"(
    set Bodies = block
    subsection Body block
      set Points per cell edge = 2
      subsection Box
        set Lower corner = 2, 2
        set Upper corner = 5, 4
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e3
      end
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e3
      end
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 1e3
        set Viscosity = 0.1
      end
    end
    subsection Grid
      set Upper corner = 20, 12
      set Cells = 20, 12
    end
)" + free_sides;

  constexpr double modulus = 1e3; // Pa, of all three laws



  /** What makes f = 1 + a + c a^2 the motion of the points (StressSweep). */
  double
  square_of(const Variant &variant)
  {
    return variant.order == "usf" ? 1 : variant.order == "usavg" ? 0.5 : 0;
  }



  double
  largest_stress(const PointView<2> &points)
  {
    double result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        result = std::max(result, std::abs(points.pressure[p]));
        for (const double *const component : points.deviator)
          if (component != nullptr) // of an inviscid fluid
            result = std::max(result, std::abs(component[p]));
      }
    return result;
  }
} // namespace



// Theory, 6.3: ten cells at an angle, crossing at ever new places.
TEST(RigidMotion, TranslationIsExact)
{
  const dealii::Tensor<1, 2> v({10., 3.});
  for (const Variant &variant : all_variants({"pic", "flip", "apic", "aflip"}))
    {
      SCOPED_TRACE(name_of(variant));
      auto set = overrides(variant);
      set.push_back("Body block/Initial velocity=10; 3");
      SceneRun<2> run(block, set);
      const auto  before = run.positions();
      const auto  start  = run.totals().all;

      run.advance(0.0317182, 32);
      const auto end = run.totals().all;
      EXPECT_NEAR((end.momentum - start.momentum).norm(),
                  0,
                  1e-12 * start.momentum.norm());
      EXPECT_NEAR(end.kinetic_energy,
                  start.kinetic_energy,
                  1e-12 * start.kinetic_energy);
      EXPECT_LT(largest_stress(run.points()), 1e-10 * modulus);
      double velocity_error = 0, position_error = 0;
      for (std::size_t p = 0; p < run.points().size; ++p)
        velocity_error =
          std::max(velocity_error, (run.velocity(p) - v).norm() / v.norm());
      const auto after = run.positions();
      for (std::size_t p = 0; p < after.size(); ++p)
        position_error = std::max(position_error,
                                  (after[p] - before[p] - run.time * v).norm());
      EXPECT_LT(velocity_error, 1e-12);
      EXPECT_LT(position_error, 1e-11);
    }
}



// v_n = n dt g and, with symplectic Euler, x_n = x_0 + n (n + 1) / 2 dt^2 g;
// with the velocity of the middle of the step x is exact.
TEST(RigidMotion, FreeFall)
{
  for (const Variant &variant : all_variants({"pic", "flip", "apic", "aflip"}))
    {
      SCOPED_TRACE(name_of(variant));
      auto set = overrides(variant);
      set.push_back("Loads/Gravity=5, 2");
      SceneRun<2>                run(block, set);
      const dealii::Tensor<1, 2> g({5., 2.});
      const double               mass = run.totals().all.mass;
      const auto                 x0   = run.positions();

      const double       step = 0.0271828;
      const unsigned int n    = 60;
      run.advance(step, n);
      EXPECT_NEAR((run.totals().all.momentum / mass - n * step * g).norm(),
                  0,
                  1e-12 * n * step * g.norm());
      const auto x = run.positions();
      const auto fall =
        0.5 * n * (variant.order == "usavg" ? n : n + 1) * step * step * g;
      for (std::size_t p = 0; p < x.size(); ++p)
        EXPECT_NEAR((x[p] - x0[p] - fall).norm(), 0, 1e-11);
      EXPECT_LT(run.totals().momentum_error, 1e-12);
    }
}



// Theory, section 7, row 2: the average of equal values changes nothing. A
// huge density holds the velocity gradient against the stress; APIC brings a
// linear field to the nodes without error. With 'usavg' a step strains in
// two halves; the square of the motion is the scheme's.
TEST(RigidMotion, HomogeneousDeformationIsExactAndUntouchedByTheTreatment)
{
  const dealii::Tensor<2, 2> L({{0.3, 0.5}, {-0.2, -0.1}});
  for (const Variant &variant : all_variants({"apic", "aflip"}))
    {
      SCOPED_TRACE(name_of(variant));
      const unsigned int parts = variant.order == "usavg" ? 2 : 1;
      const double       step  = 0.01 / parts;
      const unsigned int n     = 50 * parts;
      auto               set   = overrides(variant);
      for (const std::string law :
           {"Linear elastic", "Neo hookean", "Newtonian fluid"})
        set.push_back("Body block/" + law + "/Density=1e30");
      SceneRun<2> run(block, set);
      for (unsigned int k = 0; k < n / parts; ++k)
        {
          run.set_linear_velocity(L, dealii::Point<2>(3, 3));
          run.advance(parts * step);
        }

      // sigma or tau of the closed formulas of the laws
      const double trace    = dealii::trace(L);
      double       pressure = 0, xx = 0, xy = 0;
      if (variant.law == "linear elastic")
        {
          pressure = -modulus / 1.2 * n * step * trace;
          xx       = modulus / 1.3 * n * step * (L[0][0] - trace / 3);
          xy       = modulus / 1.3 * n * step * 0.5 * (L[0][1] + L[1][0]);
        }
      else if (variant.law == "newtonian fluid")
        {
          const double second =
            0.5 * trace * trace +
            (square_of(variant) - 0.5) * dealii::trace(L * L);
          const double J = std::pow(1 + step * trace + step * step * second, n);
          pressure       = modulus * (1 - J);
          xx             = 0.2 * J * (L[0][0] - trace / 3);
          xy             = 0.1 * J * (L[0][1] + L[1][0]);
        }
      else
        {
          dealii::Tensor<2, 2> F({{1, 0}, {0, 1}}), f = F;
          f += step * L + square_of(variant) * step * step * (L * L);
          for (unsigned int k = 0; k < n; ++k)
            F = f * F;
          const double J  = dealii::determinant(F);
          const auto   be = std::pow(J, -2. / 3) * (F * dealii::transpose(F));
          const double third = (dealii::trace(be) + std::pow(J, -2. / 3)) / 3;
          pressure           = -modulus / 2.4 * (J * J - 1);
          xx                 = modulus / 2.6 * (be[0][0] - third);
          xy                 = modulus / 2.6 * be[0][1];
        }
      const PointView<2> points = run.points();
      for (std::size_t p = 0; p < points.size; ++p)
        {
          EXPECT_NEAR(points.pressure[p], pressure, 1e-10 * std::abs(pressure));
          EXPECT_NEAR(points.deviator[0][p], xx, 1e-10 * std::abs(xx));
          EXPECT_NEAR(points.deviator[2][p], xy, 1e-10 * std::abs(xy));
        }
    }
}



// A velocity by which points move from x to R x in a step. Stress and volume
// follow to round-off where points are strained by this very motion, with 'usf'
// to third order, as by 1 + a + a^2 instead of (1 - a)^-1. 'usavg' keeps the
// energy of a body that turns instead.
TEST(RigidMotion, RotationLeavesSizeAndStress)
{
  const double         angle = 1.5;
  dealii::Tensor<2, 2> one({{1, 0}, {0, 1}});
  for (const Variant &variant : all_variants({"apic", "aflip"}))
    {
      if (variant.law == "linear elastic" || variant.order == "usavg")
        continue; // for small rotation only
      SCOPED_TRACE(name_of(variant));
      auto set = overrides(variant);
      for (const std::string law : {"Neo hookean", "Newtonian fluid"})
        set.push_back("Body block/" + law + "/Density=1e30");
      set.push_back("Body block/Newtonian fluid/Viscosity=0");

      std::vector<double> errors;
      for (const unsigned int n : {25u, 50u, 100u})
        {
          SceneRun<2> run(block, set);
          run.translate(dealii::Tensor<1, 2>({5., 3.}));
          const double               theta = angle / n;
          const double               c = std::cos(theta), s = std::sin(theta);
          const dealii::Tensor<2, 2> turn({{c, -s}, {s, c}});
          const auto                 gradient =
            variant.order == "usf" ? one - transpose(turn) : turn - one;
          for (unsigned int k = 0; k < n; ++k)
            {
              run.set_linear_velocity(gradient, dealii::Point<2>(8.5, 6));
              run.advance(1);
            }
          errors.push_back(largest_stress(run.points()));
        }
      if (square_of(variant) == 0)
        EXPECT_LT(errors[2], 1e-10 * modulus);
      else
        {
          EXPECT_LT(errors[2], 1e-4 * modulus);
          EXPECT_NEAR(errors[0] / errors[1], 8, 0.5);
          EXPECT_NEAR(errors[1] / errors[2], 8, 0.5);
        }
    }
}
