// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>

#include <gtest/gtest.h>
#include <support/sample_laws.h>

#include <cmath>

/**
 * @file Laws one by one against formulas worked out by hand.
 */
using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dim, class Law, class State>
  void
  move(const Law &law, State &state, const Matrix<dim> &gradient)
  {
    law.template update<dim>(motion_of<dim>(gradient), state);
  }



  /** A volumetric path: J after J, deviatoric motion none. */
  template <int dim, class Law, class Pressure>
  void
  compare_path(const Law &law, const Pressure &pressure)
  {
    auto state = law.template initialise<dim>(0);
    for (int k = 0; k < 60; ++k)
      {
        MotionIncrement<dim, double> motion = motion_of<dim>({});
        motion.volumetric                   = k < 40 ? -0.01 : 0.03;
        law.template update<dim>(motion, state);
        const double J = law.template volume_ratio<dim>(state);
        EXPECT_NEAR(state.pressure / J, pressure(J), 1e-13 * law.bulk_modulus);
        for (const double s : state.deviator)
          EXPECT_NEAR(s, 0., 1e-14 * law.bulk_modulus);
      }
    EXPECT_NEAR(law.template volume_ratio<dim>(state),
                std::pow(0.99, 40) * std::pow(1.03, 20),
                1e-14);
  }



  const double density = 1000, K = 2e5;

  std::array<double, 6>
  fluid(const double viscosity,
        const bool   cutoff,
        const bool   tait,
        double       gamma)
  {
    return {{density, K, viscosity, double(cutoff), double(tait), gamma}};
  }



  template <class Dimension>
  class ClosedForms : public testing::Test
  {
  public:
    static constexpr int dim = Dimension::value;
    Random               random;

    /** (det F)^(-2/3) F F^T and det F, with F_zz = 1 in plane strain. */
    static Matrix<3>
    isochoric(const Matrix<3> &f, double &J)
    {
      J = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) -
          f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
          f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
      Matrix<3> b{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k)
            b[i][j] += std::pow(J, -2. / 3.) * f[i][k] * f[j][k];
      return b;
    }

    /** Law and F carried along a motion of many steps. */
    static void
    follow(const NeoHookean               &law,
           const std::vector<Matrix<dim>> &steps,
           const double                    tolerance)
    {
      auto      state = law.initialise<dim>(0);
      Matrix<3> f{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
      for (const auto &a : steps)
        {
          move<dim>(law, state, a);
          Matrix<3> moved = f;
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < 3; ++j)
              for (int k = 0; k < dim; ++k)
                moved[i][j] += a[i][k] * f[k][j];
          f = moved;
        }
      double       J;
      const auto   be    = isochoric(f, J);
      const double third = (be[0][0] + be[1][1] + be[2][2]) / 3;
      const auto   t     = kirchhoff_stress_of<dim>(state);
      const double K = law.bulk_modulus, G = law.shear_modulus;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(t[i][j],
                      G * be[i][j] +
                        (i == j ? 0.5 * K * (J * J - 1) - G * third : 0.),
                      tolerance * (K + G));
      EXPECT_NEAR(state.history[0], J, tolerance);
    }
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(ClosedForms, Dimensions);
} // namespace



TYPED_TEST(ClosedForms, VolumetricPathOfNeoHookean)
{
  for (const auto &law : samples<NeoHookean>())
    compare_path<TestFixture::dim>(law, [&](const double J) {
      return -0.5 * law.bulk_modulus * (J - 1 / J);
    });
}



TYPED_TEST(ClosedForms, VolumetricPathOfFluids)
{
  const auto linear = [](const double J) { return K * (1 / J - 1); };
  const auto tait   = [](const double J) {
    return K / 7 * (std::pow(J, -7) - 1);
  };
  constexpr int dim = TestFixture::dim;
  compare_path<dim>(NewtonianFluid<false>(fluid(0, false, false, 7)), linear);
  compare_path<dim>(NewtonianFluid<true>(fluid(2, false, false, 7)), linear);
  compare_path<dim>(NewtonianFluid<false>(fluid(0, false, true, 7)), tait);
  compare_path<dim>(NewtonianFluid<true>(fluid(2, false, true, 7)), tait);
}



// With the exponent one the Tait equation is the linear one, and its energy
// has a limit there.
TYPED_TEST(ClosedForms, TaitWithExponentOneIsLinear)
{
  constexpr int               dim = TestFixture::dim;
  const NewtonianFluid<false> one(fluid(0, false, true, 1)),
    linear(fluid(0, false, false, 7));
  compare_path<dim>(one, [](const double J) { return K * (1 / J - 1); });
  const auto a = one.initialise<dim>(0.1 * K),
             b = linear.initialise<dim>(0.1 * K);
  EXPECT_NEAR(one.strain_energy<dim>(a),
              linear.strain_energy<dim>(b),
              1e-14 * K);
  EXPECT_NEAR(one.wave_speed_squared<dim>(a),
              linear.wave_speed_squared<dim>(b),
              1e-12 * K / density);
}



TYPED_TEST(ClosedForms, LinearElasticStressIsLinearInStrain)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<LinearElastic>())
    {
      const double K = law.bulk_modulus, G = law.shear_modulus;
      auto         state = law.template initialise<dim>(0);
      Matrix<dim>  total{};
      for (int k = 0; k < 10; ++k)
        {
          const auto a = this->random.template matrix<dim>(1e-3);
          move<dim>(law, state, a);
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              total[i][j] += 0.5 * (a[i][j] + a[j][i]);
        }
      double trace = 0;
      for (int d = 0; d < dim; ++d)
        trace += total[d][d];
      const auto t = kirchhoff_stress_of<dim>(state);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          EXPECT_NEAR(t[i][j],
                      2 * G * total[i][j] +
                        (i == j ? (K - 2. / 3. * G) * trace : 0.),
                      1e-16 * (K + G));
      // plane strain bears stress across the plane
      if (dim == 2)
        {
          EXPECT_NEAR(t[2][2], (K - 2. / 3. * G) * trace, 1e-16 * (K + G));
        }
    }
}



TYPED_TEST(ClosedForms, NeoHookeanSimpleShear)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<NeoHookean>())
    {
      // x += gamma y in ten steps: the motion of each is followed exactly
      auto        state = law.template initialise<dim>(0);
      Matrix<dim> a{};
      a[0][1] = 0.15;
      for (int k = 0; k < 10; ++k)
        move<dim>(law, state, a);
      const double gamma = 1.5, G = law.shear_modulus;
      const auto   t = kirchhoff_stress_of<dim>(state);
      EXPECT_NEAR(t[0][1], G * gamma, 1e-13 * G);
      EXPECT_NEAR(t[0][0], G * 2. / 3. * gamma * gamma, 1e-13 * G);
      EXPECT_NEAR(t[1][1], -G / 3 * gamma * gamma, 1e-13 * G);
      EXPECT_NEAR(t[2][2], -G / 3 * gamma * gamma, 1e-13 * G);
      EXPECT_NEAR(state.pressure, 0., 1e-13 * law.bulk_modulus);
    }
}



TYPED_TEST(ClosedForms, NeoHookeanFollowsTheDeformationGradient)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<NeoHookean>())
    {
      Matrix<dim> stretch{};
      stretch[0][0] = 0.02;
      this->follow(law, std::vector<Matrix<dim>>(50, stretch), 1e-12);
      stretch[0][0] = -0.02;
      this->follow(law, std::vector<Matrix<dim>>(50, stretch), 1e-12);

      std::vector<Matrix<dim>> steps;
      for (int k = 0; k < 20; ++k)
        steps.push_back(this->random.template matrix<dim>(0.015));
      this->follow(law, steps, 1e-12);
    }
}



// be and J keep to the deformation gradient over many cycles.
TYPED_TEST(ClosedForms, NeoHookeanDoesNotDrift)
{
  constexpr int            dim = TestFixture::dim;
  const NeoHookean         law(sample_parameters<NeoHookean>()[0]);
  std::vector<Matrix<dim>> steps(10000, Matrix<dim>{});
  for (std::size_t k = 0; k < steps.size(); ++k)
    steps[k][k % dim][(k + 1) % dim] = k / dim % 2 ? -0.01 : 0.01;
  this->follow(law, steps, 1e-11);

  auto state = law.template initialise<dim>(0);
  for (const auto &a : steps)
    move<dim>(law, state, a);
  EXPECT_NEAR(state.history[0], 1., 1e-11);
  // plane strain: the motion has no part in be_zz = 1
  if (dim == 2)
    {
      const auto &h = state.history;
      EXPECT_NEAR(h[1] * h[2] - h[3] * h[3], 1., 1e-11);
    }
}



TYPED_TEST(ClosedForms, ViscousStressFollowsTheRate)
{
  constexpr int              dim = TestFixture::dim;
  const double               mu = 3, step = 0.01;
  const NewtonianFluid<true> law(fluid(mu, false, false, 7));
  EXPECT_EQ(law.dynamic_viscosity(), mu);

  auto state = law.initialise<dim>(0.05 * K);
  for (int k = 0; k < 10; ++k)
    {
      const auto   a      = this->random.template matrix<dim>(0.05);
      const auto   motion = motion_of<dim>(a, step);
      const auto   heat   = law.update<dim>(motion, state);
      const double J      = state.history[0];
      const auto   t      = kirchhoff_stress_of<dim>(state);

      double power = 0;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          {
            double rate = 0.5 * (a[i][j] + a[j][i]) / step;
            if (i == j)
              rate -= motion.trace() / 3 / step;
            const double shear = t[i][j] + (i == j ? state.pressure : 0.);
            EXPECT_NEAR(shear, J * 2 * mu * rate, 1e-12 * mu / step);
            power += shear * a[i][j];
          }
      // all work of the viscous stress becomes heat
      EXPECT_NEAR(heat.viscous, power, 1e-12 * mu / step);
      EXPECT_GT(heat.viscous, 0.);
      EXPECT_EQ(heat.cutoff, 0.);
    }
}



// Tension is let go at once and for good: the fluid that comes together
// again resists at once.
TYPED_TEST(ClosedForms, TensionCutoffForgetsTheGap)
{
  constexpr int dim = TestFixture::dim;
  for (const bool tait : {false, true})
    {
      const NewtonianFluid<false> law(fluid(0, true, tait, 7)),
        tough(fluid(0, false, tait, 7));
      auto       state = law.initialise<dim>(0.01 * K), whole = state;
      const auto by = [&](const double volumetric) {
        auto motion       = motion_of<dim>({});
        motion.volumetric = volumetric;
        return motion;
      };
      // under pressure nothing is cut
      EXPECT_EQ(law.update<dim>(by(0.001), state).cutoff, 0.);
      tough.update<dim>(by(0.001), whole);
      EXPECT_EQ(state.pressure, whole.pressure);

      const auto cut = law.update<dim>(by(0.2), state);
      tough.update<dim>(by(0.2), whole);
      EXPECT_EQ(state.pressure, 0.);
      EXPECT_EQ(state.history[0], 1.);
      EXPECT_LT(whole.pressure, 0.);
      EXPECT_NEAR(cut.cutoff, tough.strain_energy<dim>(whole), 1e-14 * K);

      law.update<dim>(by(-0.01), state);
      EXPECT_GT(state.pressure, 0.005 * K);
    }
}
