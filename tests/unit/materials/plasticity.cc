// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/sample_laws.h>

#include <cmath>

/**
 * @file Laws that flow, on the paths of a single point that have a closed form
 * (doc/theory/plasticity.md).
 */
using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dimension>
  struct Dimension
  {
    static constexpr int dim = dimension;
  };

  using BothDimensions = testing::Types<Dimension<2>, Dimension<3>>;

  template <class Case>
  class MetalPaths : public testing::Test
  {};
  TYPED_TEST_SUITE(MetalPaths, BothDimensions);

  template <class Case>
  class SoilPaths : public testing::Test
  {};
  TYPED_TEST_SUITE(SoilPaths, BothDimensions);



  constexpr double E = 1e9, nu = 0.3, sy = 1e5;

  /** Parameters of a law, in the order of its entries; the rest by default. */
  template <class Law, class... Value>
  std::array<double, Law::parameters.size()>
  values_of(const Value... value)
  {
    std::array<double, Law::parameters.size()> result{{double(value)...}};
    for (std::size_t k = sizeof...(Value); k < result.size(); ++k)
      result[k] = Law::parameters[k].standard;
    return result;
  }



  template <class Law, class... Value>
  Law
  law_of(const Value... value)
  {
    return Law(values_of<Law>(value...));
  }



  J2
  metal(const double H         = 0,
        const double Q         = 0,
        const double delta     = 10,
        const double viscosity = 0,
        const double exponent  = 1)
  {
    return law_of<J2>(1000, E, nu, sy, H, Q, delta, viscosity, exponent);
  }



  /** Grains whose friction grows with the rate: mu(I). */
  DruckerPrager<false>
  grains(const double limit = 35)
  {
    constexpr double I_0 = 0.3, diameter = 0.01, density = 2500;
    return law_of<DruckerPrager<false>>(
      2000, E, nu, 20, 0, 0, 0, 0, limit, I_0, diameter, density);
  }



  template <int dim>
  Matrix<dim>
  diagonal(const double x, const double y, const double z = 0)
  {
    Matrix<dim> result{};
    result[0][0] = x;
    result[1][1] = y;
    if constexpr (dim == 3)
      result[2][2] = z;
    return result;
  }



  /** Plastic work; the step is long by default, so that no rate counts. */
  template <int dim, class Law, class State>
  double
  move(const Law         &law,
       State             &state,
       const Matrix<dim> &gradient,
       const double       step = 1e30)
  {
    return law.template update<dim>(motion_of<dim>(gradient, step), state)
      .plastic;
  }



  /** Simple shear, by so much in each of so many steps. */
  template <int dim, class Law, class State>
  double
  shear(const Law   &law,
        State       &state,
        const double by,
        const int    n_steps,
        const double step)
  {
    Matrix<dim> gradient{};
    gradient[0][1] = by;
    double work    = 0;
    for (int k = 0; k < n_steps; ++k)
      work += move<dim>(law, state, gradient, step);
    return work;
  }



  template <class Law, class State>
  double
  alpha_of(const Law &, const State &state)
  {
    return state.history[state.history.size() - Law::variables.size()];
  }
} // namespace



TYPED_TEST(MetalPaths, SteadyShearIsAtTheYieldStressOverRootThree)
{
  constexpr int dim   = TypeParam::dim;
  const J2      law   = metal();
  auto          state = law.template initialise<dim>(0);
  Matrix<dim>   shear{};
  shear[0][1] = 1e-5;
  for (int k = 0; k < 1000; ++k)
    move<dim>(law, state, shear);
  EXPECT_NEAR(state.deviator[2], sy / std::sqrt(3.), 1e-5 * sy);
  EXPECT_NEAR(state.pressure, 0, 1e-9 * law.bulk_modulus);
  // 0.01 of shear, but for the elastic part
  EXPECT_NEAR(alpha_of(law, state),
              0.01 / std::sqrt(3.) - sy / (3 * law.shear_modulus),
              1e-6 * 0.01);
}



// |s1 - s2| = 2 sy / sqrt(3): the third axis is held.
TYPED_TEST(MetalPaths, PlaneCompressionBearsMoreThanUniaxial)
{
  constexpr int dim   = TypeParam::dim;
  const J2      law   = metal();
  auto          state = law.template initialise<dim>(0);
  for (int k = 0; k < 1000; ++k)
    move<dim>(law, state, diagonal<dim>(-1e-5, 1e-5));
  EXPECT_NEAR(state.deviator[1] - state.deviator[0],
              2 / std::sqrt(3.) * sy,
              1e-4 * sy);
}



// Uniaxial stress without its pressure: s1 - s2 = k(alpha), the plastic strain
// is what is not elastic.
TEST(Metal, HardensByItsFormula)
{
  for (const J2 &law :
       {metal(1e7), metal(0, 5e4, 200), metal(1e6, 1e5, 50), metal()})
    for (const int steps : {10, 1000})
      {
        auto         state = law.initialise<3>(0);
        const double e     = 0.02 / steps;
        for (int k = 0; k < steps; ++k)
          {
            move<3>(law, state, diagonal<3>(e, -e / 2, -e / 2));
            const double q = state.deviator[0] - state.deviator[1];
            if (alpha_of(law, state) > 0)
              {
                ASSERT_NEAR(q,
                            law.yield_strength(alpha_of(law, state)),
                            1e-8 * sy);
              }
          }
        // steps are those of 1 + a, which is not e^a
        const double strain =
          steps * 2. / 3. * (std::log1p(e) - std::log1p(-e / 2));
        const double q = state.deviator[0] - state.deviator[1];
        EXPECT_NEAR(alpha_of(law, state),
                    strain - q / (3 * law.shear_modulus),
                    0.02 * (e + 2 * sy / E));
      }
}



TEST(Metal, YieldStrengthSaturates)
{
  const J2 law = metal(1e4, 5e4, 20);
  EXPECT_DOUBLE_EQ(law.yield_strength(0.), sy);
  EXPECT_NEAR(law.yield_strength(0.05),
              sy + 500 + 5e4 * (1 - std::exp(-1.)),
              1e-9 * sy);
  EXPECT_NEAR(law.yield_strength(10.), sy + 1e5 + 5e4, 1e-9 * sy);
}



// tau = sy / sqrt(3) + eta g^n, at rates that span six decades of what the
// viscosity adds.
TYPED_TEST(MetalPaths, ViscosityAddsToTheStressOfSteadyFlow)
{
  constexpr int    dim = TypeParam::dim;
  constexpr double eta = 1e4, by = 1e-5;
  for (const double n : {1., 0.6, 0.2})
    for (const double added : {1e-4, 1e-2, 1., 100.}) // over sy
      {
        const J2     law   = metal(0, 0, 10, eta, n);
        const double rate  = std::pow(added * sy / eta, 1 / n);
        auto         state = law.template initialise<dim>(0);
        const int    n_steps =
          int(20 * (1 + added) * sy / (law.shear_modulus * by));
        shear<dim>(law, state, by, n_steps, by / rate);
        const double expected = sy / std::sqrt(3.) + eta * std::pow(rate, n);
        // the elastic strain lets axes turn
        const double elastic = expected / law.shear_modulus;
        EXPECT_NEAR(state.deviator[2],
                    expected,
                    (1e-5 + elastic * elastic) * expected)
          << n << ' ' << added;
      }
}



// One step, from hardly any flow to a hundred times the yield stress: what is
// beyond the radius is what the rate of the flow brings.
TEST(Metal, ViscousReturnMeetsItsEquation)
{
  for (const double n : {1., 0.7, 0.3, 0.1})
    for (const double Q : {0., 5e4})
      for (double step = 1e-12; step < 1e12; step *= 100)
        for (const double by : {2e-4, 1e-3, 1e-2})
          {
            const J2 law   = metal(1e5, Q, 50, 1e4, n);
            auto     state = law.initialise<2>(0);
            shear<2>(law, state, by, 1, step);
            const double alpha = alpha_of(law, state);
            const double rate  = std::sqrt(3.) * alpha / step;
            const double q =
              std::sqrt(1.5 * squared_norm<2, double>(state.deviator));
            EXPECT_NEAR(q,
                        law.yield_strength(alpha) +
                          std::sqrt(3.) * 1e4 * std::pow(rate, n),
                        1e-8 * q)
              << n << ' ' << Q << ' ' << step << ' ' << by;
          }
}



// Stress beyond that of yielding decays as exp(-G t / eta), implicit Euler
// being of first order, and what decays becomes work.
TEST(Metal, BinghamsOverstressRelaxes)
{
  constexpr double eta = 1e4;
  double           error[2];
  for (int k = 0; k < 2; ++k)
    {
      const J2 law   = metal(0, 0, 10, eta);
      auto     state = law.initialise<2>(0);
      // as fast as if there were no flow
      shear<2>(law, state, 2 * sy / law.shear_modulus, 1, 1e-30);
      const double start = state.deviator[2] - sy / std::sqrt(3.);
      EXPECT_NEAR(state.deviator[2], 2 * sy, 1e-3 * sy);
      const double before = law.strain_energy<2>(state);
      const int    n      = 50 << k;
      const double work =
        shear<2>(law, state, 0, n, 2 * eta / law.shear_modulus / n);
      error[k] =
        (state.deviator[2] - sy / std::sqrt(3.)) / start / std::exp(-2.) - 1;
      EXPECT_NEAR(work, before - law.strain_energy<2>(state), 1e-6 * work);
    }
  EXPECT_LT(std::abs(error[1]), 0.03);
  EXPECT_NEAR(error[0] / error[1], 2, 0.1);
}



// With hardening of both kinds, and as slow as one likes.
TYPED_TEST(MetalPaths, SlowFlowIsThatWithoutViscosity)
{
  constexpr int dim = TypeParam::dim;
  const J2 law = metal(1e6, 5e4, 100), viscous = metal(1e6, 5e4, 100, 1e4, 0.7);
  auto     state         = law.template initialise<dim>(0);
  auto     other         = state;
  const double work      = shear<dim>(law, state, 1e-4, 50, 1);
  const double same_work = shear<dim>(viscous, other, 1e-4, 50, 1e12);
  EXPECT_NEAR(same_work, work, 1e-6 * work);
  EXPECT_NEAR(alpha_of(viscous, other),
              alpha_of(law, state),
              1e-6 * alpha_of(law, state));
  EXPECT_NEAR(other.deviator[2], state.deviator[2], 1e-6 * sy);
}



// In and out again within the yield surface: nothing flows, energy comes back.
TYPED_TEST(MetalPaths, BelowTheYieldStressIsElastic)
{
  constexpr int dim     = TypeParam::dim;
  const J2      law     = metal();
  const auto    elastic = law_of<NeoHookean>(1000, E, nu);
  auto          state   = law.template initialise<dim>(0);
  auto          other   = elastic.template initialise<dim>(0);
  Matrix<dim>   shear{};
  shear[0][1] = shear[1][0] = 1e-5;
  shear[0][0]               = -2e-6;
  for (const double sign : {1., 1., -1., -1., -1.})
    {
      Matrix<dim> a = shear;
      for (auto &row : a)
        for (double &x : row)
          x *= sign;
      EXPECT_EQ(move<dim>(law, state, a), 0);
      move<dim>(elastic, other, a);
      EXPECT_EQ(alpha_of(law, state), 0);
      EXPECT_DOUBLE_EQ(state.pressure, other.pressure);
      for (std::size_t k = 0; k < other.deviator.size(); ++k)
        EXPECT_NEAR(state.deviator[k], other.deviator[k], 1e-12 * sy);
    }
}



// A full turn of a body that is about to flow.
TYPED_TEST(MetalPaths, TurningDoesNotFlow)
{
  constexpr int dim   = TypeParam::dim;
  const J2      law   = metal(1e6);
  auto          state = law.template initialise<dim>(0);
  Matrix<dim>   shear{};
  shear[0][1] = 1e-5;
  for (int k = 0; k < 100; ++k)
    move<dim>(law, state, shear);
  const auto    before = state;
  constexpr int n      = 90;
  const double  angle  = 2 * 3.14159265358979323846 / n;
  Matrix<dim>   turn{};
  turn[0][0] = turn[1][1] = std::cos(angle) - 1;
  turn[0][1]              = -std::sin(angle);
  turn[1][0]              = std::sin(angle);
  double work             = 0;
  for (int k = 0; k < n; ++k)
    work += move<dim>(law, state, turn);
  for (std::size_t k = 0; k < before.deviator.size(); ++k)
    EXPECT_NEAR(state.deviator[k], before.deviator[k], 1e-13 * E);
  EXPECT_NEAR(state.pressure, before.pressure, 1e-13 * E);
  EXPECT_NEAR(alpha_of(law, state), alpha_of(law, before), 1e-15);
  EXPECT_LT(work, 1e-12 * sy);
}



namespace
{
  // Work and dissipation along a path that turns in strain space
  template <int dim, class Law>
  struct Path
  {
    Path(const Law &law, const int n_steps)
      : state(law.template initialise<dim>(0.01 * law.bulk_modulus * 1e-2))
    {
      const double start = law.template strain_energy<dim>(state);
      const double h     = 1. / n_steps;
      double       done = 0, work = 0;
      for (int k = 0; k < n_steps; ++k)
        {
          const double t = (k + 0.5) * h * 3;
          Matrix<dim>  a{};
          a[0][0] = -4e-3 * h * std::cos(t);
          a[1][1] = -a[0][0];
          a[0][1] = a[1][0] = 4e-3 * h * std::sin(t);
          const auto before = kirchhoff_stress_of<dim>(state);
          work += move<dim>(law, state, a);
          const auto after = kirchhoff_stress_of<dim>(state);
          // on the strain of the step 1 + a to its second order
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              {
                double strain = a[i][j];
                for (int l = 0; l < dim; ++l)
                  strain -= 0.5 * a[i][l] * a[l][j];
                done += 0.5 * (before[i][j] + after[i][j]) * strain;
              }
        }
      left = done - work - (law.template strain_energy<dim>(state) - start);
      dissipated = work;
    }

    typename Law::template State<dim, double> state;
    double                                    left = 0, dissipated = 0;
  };



  // The work is what is stored and what is dissipated, in steps of any size;
  // the stress of a path that turns is reached with an error of first order, as
  // the return is implicit Euler.
  template <int dim, class Law>
  void
  test_balance(const Law &law)
  {
    const Path<dim, Law> fine(law, 12800);
    double               errors[3];
    for (int k = 0; k < 3; ++k)
      {
        const Path<dim, Law> path(law, 100 << k);
        errors[k] = 0;
        for (std::size_t i = 0; i < path.state.deviator.size(); ++i)
          errors[k] =
            std::max(errors[k],
                     std::abs(path.state.deviator[i] - fine.state.deviator[i]));
        EXPECT_GT(path.dissipated, 0);
        EXPECT_NEAR(path.left, 0, 2e-8 * path.dissipated);
      }
    EXPECT_GT(errors[0] / errors[1], 1.8);
    EXPECT_GT(errors[1] / errors[2], 1.8);
  }
} // namespace



TYPED_TEST(MetalPaths, WorkIsStoredOrDissipated)
{
  test_balance<TypeParam::dim>(metal(1e7));
  test_balance<TypeParam::dim>(metal(0, 5e4, 100));
}



TYPED_TEST(SoilPaths, WorkIsStoredOrDissipated)
{
  test_balance<TypeParam::dim>(
    law_of<DruckerPrager<false>>(2000, E, nu, 30, 0, 0, 0, 0));
  test_balance<TypeParam::dim>(
    law_of<DruckerPrager<true>>(2000, E, nu, 30, 0, 10, 0, 0));
}



namespace
{
  template <class Case>
  class EveryFlow : public testing::Test
  {};
  TYPED_TEST_SUITE(EveryFlow, AllLawCases);
} // namespace



// Steps from a thousandth to more than ten at random: elastic strain is what
// the strength allows, and as clay is compacted without end, so is its: to
// stretches of a hundred and more.
TYPED_TEST(EveryFlow, PlasticStrainAndWorkNeverFall)
{
  constexpr int dim = TypeParam::dim;
  using Law         = typename TypeParam::Law;
  if constexpr (Law::is_plastic)
    {
      Random random;
      double whole = 0;
      for (const double growth : {1.04, 1.1})
        for (const auto &law : samples<Law>())
          for (int run = 0; run < 100; ++run)
            {
              auto   state = law.template initialise<dim>(0);
              double alpha = 0;
              for (int k = 0; k < 1000; ++k)
                {
                  const auto gradient =
                    random.template matrix<dim>(0.001 * std::pow(growth, run));
                  const double work = move<dim>(law, state, gradient);
                  ASSERT_GE(work, 0.);
                  ASSERT_GE(alpha_of(law, state), alpha);
                  // the mean of eigenvalues whose product is one
                  const auto be = isochoric::strain<dim>(state.history);
                  ASSERT_GE(isochoric::trace(be), 3 - 1e-12);
                  alpha = alpha_of(law, state);
                  whole += work;
                  // steps that no volume stands for long
                  state.history[0] =
                    std::min(std::max(state.history[0], 0.7), 1.4);
                }
            }
      EXPECT_GT(whole, 0);
    }
}



// Flow of any length, from elastic strain of any size: be keeps its determinant
// and stays positive definite, so that the strain that is left is that of the
// share of the deviator. Stretches are as large as doubles resolve what the
// determinant leaves for the smallest eigenvalue.
TEST(RadialReturns, StayOnTheBranchOfPositiveStrain)
{
  using State = PointState<3, double, 6>;
  for (const double stretch : {0.05, 0.5, 0.9, 1.001, 1.3, 2., 3., 10.})
    for (const double share : {0., 1e-6, 0.1, 0.5, 0.9, 0.999, 1.})
      {
        SCOPED_TRACE(testing::Message() << stretch << ' ' << share);
        State state; // be = diag(stretch^2, 1 / stretch, 1 / stretch)
        state.history[1] = stretch * stretch;
        state.history[2] = 1 / stretch;
        RadialReturn<3, double> trial(state, 1.);
        const double            norm = trial.norm();
        EXPECT_GE(trial.flow((1 - share) * norm / trial.stiffness(), state), 0);
        const auto   be = isochoric::strain<3>(state.history);
        const double x  = std::sqrt(be[0][0]); // what is left of the stretch
        EXPECT_NEAR(x * x - 1 / x,
                    share * (stretch * stretch - 1 / stretch),
                    1e-8 * (norm + 1));
        EXPECT_NEAR(be[1][1], 1 / x, 1e-8 / x);
        EXPECT_NEAR(be[2][2], 1 / x, 1e-8 / x);
      }
}



// Uniaxial strain from zero on: elastic first, if that is inside the cone, or
// on it, K0 = (3 - M) / (3 + 2 M), M = 6 sin(phi) / (3 - sin(phi)).
TEST(Soil, OedometerSlidesOnTheCone)
{
  const double degree = 3.14159265358979323846 / 180;
  for (const double phi : {20., 30., 35.})
    {
      const auto law =
        law_of<DruckerPrager<false>>(2000, E, 0.1, phi, 0, 0, 0, 1);
      const double M =
        6 * std::sin(phi * degree) / (3 - std::sin(phi * degree));
      auto state = law.initialise<3>(0);
      for (int k = 0; k < 200; ++k)
        move<3>(law, state, diagonal<3>(-1e-6, 0, 0));
      const double axial   = state.deviator[0] - state.pressure,
                   lateral = state.deviator[1] - state.pressure;
      EXPECT_NEAR(lateral / axial, (3 - M) / (3 + 2 * M), 1e-4);
    }
}



// At constant lateral stress p0: q = 3 M p0 / (3 - M).
TEST(Soil, TriaxialCompressionFailsAtItsStrength)
{
  const double p0  = 1e5;
  const auto   law = law_of<DruckerPrager<false>>(2000, E, nu, 30, 0, 0, 0, 1);
  auto         state = law.initialise<3>(p0);
  double       wide  = 0; // lateral strain of a step
  for (int k = 0; k < 200; ++k)
    {
      const auto lateral_at = [&](const double e) {
        auto trial = state;
        move<3>(law, trial, diagonal<3>(-1e-5, e, e));
        return (trial.deviator[1] - trial.pressure) /
                 law.volume_ratio<3>(trial) +
               p0;
      };
      double a = wide, b = wide + 1e-7, fa = lateral_at(a), fb = lateral_at(b);
      for (int i = 0; i < 50 && std::abs(fb) > 1e-7 * p0; ++i)
        {
          const double c = b - fb * (b - a) / (fb - fa);
          a              = b;
          fa             = fb;
          b              = c;
          fb             = lateral_at(c);
        }
      ASSERT_LT(std::abs(fb), 1e-6 * p0);
      wide = b;
      move<3>(law, state, diagonal<3>(-1e-5, wide, wide));
    }
  const double q =
    (state.deviator[1] - state.deviator[0]) / law.volume_ratio<3>(state);
  EXPECT_NEAR(q, 2 * p0, 1e-3 * p0); // M = 1.2
}



// t = P sin(phi) + c cos(phi) with the mean P and half the difference t of the
// stresses in the plane, whatever the dilatancy, in a motion that dilates by
// its angle: sin(psi) = -(d1 + d3) / (d1 - d3).
template <class Law, int dim>
void
test_plane_strain_fit(const double psi, const double c)
{
  const double degree = 3.14159265358979323846 / 180;
  const double phi    = 30 * degree;
  const auto   law    = law_of<Law>(2000, E, nu, 30, c, psi, 0, 0);
  auto         state  = law.template initialise<dim>(1e4);
  const double spread =
    (1 + std::sin(psi * degree)) / (1 - std::sin(psi * degree));
  for (int k = 0; k < 2000; ++k)
    move<dim>(law, state, diagonal<dim>(-1e-6, spread * 1e-6));
  const double t = (state.deviator[1] - state.deviator[0]) / 2;
  const double P = state.pressure - (state.deviator[0] + state.deviator[1]) / 2;
  EXPECT_NEAR(t, P * std::sin(phi) + c * std::cos(phi), 2e-3 * t);
}

TYPED_TEST(SoilPaths, PlaneStrainFitIsMohrCoulombs)
{
  constexpr int dim = TypeParam::dim;
  test_plane_strain_fit<DruckerPrager<false>, dim>(0, 0);
  test_plane_strain_fit<DruckerPrager<false>, dim>(0, 3e3);
  test_plane_strain_fit<DruckerPrager<true>, dim>(15, 3e3);
  test_plane_strain_fit<DruckerPrager<true>, dim>(30, 0);
}



// The plane strain fit of associated flow in closed form (3 tan(phi) / sqrt(9 +
// 12 tan^2(phi))), and those of the triaxial tests.
TEST(Soil, ConesAreThoseOfTheBooks)
{
  const double degree = 3.14159265358979323846 / 180;
  for (const double phi : {10., 25., 40.})
    {
      const double tangent = std::tan(phi * degree),
                   sine    = std::sin(phi * degree),
                   cosine  = std::cos(phi * degree);
      const auto cone      = [&](const double psi, const double fit) {
        return DruckerPrager<true>::Cone(
          values_of<DruckerPrager<true>>(1, 1, 0, phi, 100, psi, 0, fit));
      };
      const double root = std::sqrt(9 + 12 * tangent * tangent);
      EXPECT_NEAR(cone(phi, 0).slope, 3 * tangent / root, 1e-14);
      EXPECT_NEAR(cone(phi, 0).dilatancy, 3 * tangent / root, 1e-14);
      EXPECT_NEAR(cone(phi, 0).cohesion, 300 / root, 1e-11);
      EXPECT_NEAR(cone(0, 0).slope, sine, 1e-15);
      EXPECT_NEAR(cone(0, 0).cohesion, 100 * cosine, 1e-12);
      EXPECT_NEAR(cone(0, 1).slope,
                  6 * sine / (std::sqrt(3.) * (3 - sine)),
                  1e-14);
      EXPECT_NEAR(cone(0, 2).slope,
                  6 * sine / (std::sqrt(3.) * (3 + sine)),
                  1e-14);
      EXPECT_NEAR(cone(0, 1).cohesion,
                  600 * cosine / (std::sqrt(3.) * (3 - sine)),
                  1e-11);
      for (const double fit : {0., 1., 2.})
        EXPECT_NEAR(cone(0, fit).apex_tension, 100 * cosine / sine, 1e-10);
    }
}



// sqrt(J2) / p = mu(I), with I over four decades, and the friction of rest as
// the limit of slow flow.
TYPED_TEST(SoilPaths, FrictionGrowsWithTheInertialNumber)
{
  constexpr int    dim    = TypeParam::dim;
  constexpr double degree = 3.14159265358979323846 / 180;
  constexpr double p = 1e3, by = 1e-6;
  const double     slow = std::sin(20 * degree), fast = std::sin(35 * degree);
  const auto       law = grains();
  for (const double I : {1e-8, 1e-2, 0.1, 0.3, 1., 100.})
    {
      const double rate  = I / 0.01 * std::sqrt(p / 2500);
      auto         state = law.template initialise<dim>(p);
      shear<dim>(law, state, by, 100, by / rate);
      EXPECT_NEAR(std::abs(state.deviator[2]) / state.pressure,
                  slow + (fast - slow) / (0.3 / I + 1),
                  1e-5)
        << I;
    }
}



// With the angle of rest as the limit nothing depends on the rate.
TYPED_TEST(SoilPaths, EqualAnglesKnowNoRate)
{
  constexpr int dim   = TypeParam::dim;
  const auto    law   = law_of<DruckerPrager<false>>(2000, E, nu, 20);
  auto          state = law.template initialise<dim>(1e3);
  auto          other = state;
  shear<dim>(law, state, 1e-6, 100, 1e-6);
  shear<dim>(grains(20), other, 1e-6, 100, 1e-6);
  EXPECT_EQ(state.deviator, other.deviator);
  EXPECT_EQ(state.history, other.history);
}



// Pulled apart by 10 % and pushed together again: no stress until the volume is
// what it was, and then that of the elastic law.
TYPED_TEST(SoilPaths, WhatPartedBearsPressureOnlyWhenClosed)
{
  constexpr int dim = TypeParam::dim;
  const auto    law = law_of<DruckerPrager<false>>(2000, E, nu, 30, 0, 0, 0, 0);
  const auto    elastic = law_of<NeoHookean>(2000, E, nu);
  auto          state   = law.template initialise<dim>(1e5);
  auto          other   = elastic.template initialise<dim>(1e5);
  for (int k = 0; k < 400; ++k)
    {
      const double e = k < 200 ? 5e-4 : -5.005e-4;
      move<dim>(law, state, diagonal<dim>(e, 0));
      move<dim>(elastic, other, diagonal<dim>(e, 0));
      EXPECT_NEAR(law.template volume_ratio<dim>(state),
                  other.history[0],
                  1e-12);
      EXPECT_NEAR(state.pressure,
                  std::max(other.pressure, 0.),
                  1e-12 * law.bulk_modulus);
      if (other.history[0] > 1)
        for (const double s : state.deviator)
          {
            EXPECT_NEAR(s, 0, 1e-12 * law.bulk_modulus);
          }
    }
  EXPECT_GT(state.pressure, 0);
}



// Tension is borne up to the tensile strength T, and parting takes the work T
// per volume that opens.
TYPED_TEST(SoilPaths, PartingTakesTheTensileStrength)
{
  constexpr int dim = TypeParam::dim;
  const double  T   = 2e4;
  const auto law = law_of<DruckerPrager<false>>(2000, E, nu, 30, 5e4, 0, T, 0);
  auto       state = law.template initialise<dim>(0);
  double     work  = 0;
  for (int k = 0; k < 100; ++k)
    {
      auto motion       = motion_of<dim>({});
      motion.volumetric = 1e-5;
      work += law.template update<dim>(motion, state).plastic;
    }
  const double opening =
    law.template volume_ratio<dim>(state) / state.history[0] - 1;
  EXPECT_NEAR(state.pressure, -T, 1e-6 * T);
  EXPECT_NEAR(opening, 1e-3 - T / law.bulk_modulus, 1e-6);
  EXPECT_NEAR(work, T * opening, 1e-3 * T * opening);
}



// Per length of plastic strain, flow dilates by the angle: d ln J = sqrt(3)
// eta_bar d alpha.
TYPED_TEST(SoilPaths, FlowDilates)
{
  constexpr int dim = TypeParam::dim;
  const auto    law = law_of<DruckerPrager<true>>(2000, E, nu, 30, 0, 10, 0, 0);
  auto          state = law.template initialise<dim>(1e4);
  for (int k = 0; k < 100; ++k)
    move<dim>(law, state, diagonal<dim>(-1e-5, 1e-5));
  const double dilation = state.history.back();
  EXPECT_GT(dilation, 1e-5);
  EXPECT_NEAR(std::log1p(dilation),
              std::sqrt(3.) * law.cone.dilatancy * alpha_of(law, state),
              1e-3 * dilation);
  // held in volume, so the pressure has grown by it
  EXPECT_NEAR(law.template volume_ratio<dim>(state),
              1 - 1e4 / law.bulk_modulus,
              1e-7);
  EXPECT_NEAR(state.pressure,
              1e4 + law.bulk_modulus * dilation,
              1e-3 * state.pressure);
}



namespace
{
  constexpr double lambda = 0.2, kappa = 0.04, M = 1.2, a = 100.;

  /** Clay that has borne a pressure; M 1.2, lambda 0.2, kappa 0.04. */
  CamClay
  clay(const double borne = 0, const double attraction = a)
  {
    return law_of<CamClay>(1800, 5e6, lambda, kappa, M, borne, attraction);
  }

  /** J p + a. */
  template <class State>
  double
  x_of(const State &state)
  {
    return state.pressure + a;
  }

  /** pc */
  template <int dim, class State>
  double
  borne_by(const State &state)
  {
    return state.history[index_of_variable<dim, CamClay>(1)];
  }

  template <int dim, class State>
  double
  q_of(const State &state)
  {
    return std::sqrt(1.5 * squared_norm<dim, double>(state.deviator));
  }

  template <class Case>
  class ClayPaths : public testing::Test
  {};
  TYPED_TEST_SUITE(ClayPaths, BothDimensions);
} // namespace



// ln J falls by lambda per ln(x) where the pressure is new, by kappa elsewhere,
// and what has been borne is remembered.
TYPED_TEST(ClayPaths, PressureCompactsByLambdaAndSwellsByKappa)
{
  constexpr int dim   = TypeParam::dim;
  const CamClay law   = clay(1e4);
  auto          state = law.template initialise<dim>(1e4);
  double        x = x_of(state), log_J = 0, largest = 1e4 + a;
  const auto    J_of = [&]() {
    return std::log(law.template volume_ratio<dim>(state));
  };
  log_J           = J_of();
  const auto step = [&](const double volume) {
    auto motion       = motion_of<dim>({});
    motion.volumetric = volume;
    const double work = law.template update<dim>(motion, state).plastic;
    const double now = x_of(state), before = largest;
    largest             = std::max(largest, now);
    const double beyond = std::log(largest / before);
    EXPECT_NEAR(J_of() - log_J,
                -lambda * beyond - kappa * (std::log(now / x) - beyond),
                1e-13);
    EXPECT_EQ(work > 0, beyond > 1e-12);
    EXPECT_NEAR(borne_by<dim>(state), largest - a, 1e-12 * largest);
    x     = now;
    log_J = J_of();
  };
  for (int k = 0; k < 50; ++k)
    step(-0.005);
  const double highest = x;
  for (int k = 0; k < 40; ++k)
    step(0.002);
  EXPECT_LT(x, 0.2 * highest);
  for (int k = 0; k < 60; ++k)
    step(-0.002);
  EXPECT_GT(x, 1.1 * highest);
  EXPECT_EQ(alpha_of(law, state), 0);
}



// Without a change of volume x / x0 = (R / (1 + (eta / M)^2))^(1 - kappa /
// lambda) once it flows, in steps of any size, up to the critical state q = M x
// with half the strength M (R / 2)^(1 - kappa / lambda) x0. The shear that
// belongs to eta of normally consolidated clay is that of the integral, to
// first order.
TYPED_TEST(ClayPaths, UndrainedShearFollowsTheClosedForm)
{
  constexpr int    dim     = TypeParam::dim;
  constexpr double x0      = 1e5;
  constexpr double drained = 1 - kappa / lambda;
  for (const double ratio : {1., 2., 4.})
    {
      double error[2];
      for (int k = 0; k < 2; ++k)
        {
          const CamClay law   = clay(ratio * x0 - a);
          auto          state = law.template initialise<dim>(x0 - a);
          // to the Kirchhoff pressure x0 - a
          state.history[0] = std::pow(x0 / a, -kappa);
          move<dim>(law, state, {});
          const int    n_steps = 1000 << k;
          const double e       = 0.3 / n_steps;
          error[k]             = 0;
          for (int i = 0; i < n_steps; ++i)
            {
              const double wide =
                dim == 2 ? 1 / (1 - e) - 1 : 1 / std::sqrt(1 - e) - 1;
              move<dim>(law, state, diagonal<dim>(-e, wide, wide));
              const double alpha = alpha_of(law, state);
              const double eta   = q_of<dim>(state) / x_of(state) / M;
              if (alpha > 0)
                {
                  ASSERT_NEAR(x_of(state),
                              x0 * std::pow(ratio / (1 + eta * eta), drained),
                              1e-10 * x0);
                }
              else
                {
                  ASSERT_NEAR(x_of(state), x0, 1e-10 * x0);
                }
              if (ratio == 1 && eta < 0.9)
                error[k] = std::max(error[k],
                                    std::abs(alpha - 2 * kappa * drained / M *
                                                       (std::atanh(eta) -
                                                        std::atan(eta))));
            }
          EXPECT_NEAR(q_of<dim>(state),
                      M * x0 * std::pow(ratio / 2, drained),
                      1e-3 * M * x0);
          EXPECT_NEAR(q_of<dim>(state), M * x_of(state), 1e-3 * M * x0);
        }
      if (ratio == 1)
        {
          EXPECT_LT(error[0], 1e-3);
          EXPECT_NEAR(error[0] / error[1], 2, 0.1);
        }
    }
}



// The same in numbers: normally consolidated clay at four stress ratios q / x,
// and the undrained strength q / 2 of clay that has borne once and twice the
// pressure.
TYPED_TEST(ClayPaths, UndrainedStressesAreThoseOfTheTable)
{
  constexpr int    dim         = TypeParam::dim;
  constexpr double x0          = 1e5;
  constexpr int    n_steps     = 10000;
  constexpr double ratios[]    = {0.3, 0.6, 0.9};
  constexpr double pressures[] = {0.95266, 0.83651, 0.69975};
  for (const double borne : {1., 2.})
    {
      const CamClay law   = clay(borne * x0 - a);
      auto          state = law.template initialise<dim>(x0 - a);
      // to the Kirchhoff pressure x0 - a
      state.history[0] = std::pow(x0 / a, -kappa);
      move<dim>(law, state, {});
      const double e    = 0.3 / n_steps;
      const double wide = dim == 2 ? 1 / (1 - e) - 1 : 1 / std::sqrt(1 - e) - 1;
      double       eta = 0, x = x_of(state);
      int          n_passed = 0;
      for (int k = 0; k < n_steps; ++k)
        {
          move<dim>(law, state, diagonal<dim>(-e, wide, wide));
          const double x_now   = x_of(state);
          const double eta_now = q_of<dim>(state) / x_now;
          if (borne == 1 && n_passed < 3 && eta_now >= ratios[n_passed])
            {
              const double share = (ratios[n_passed] - eta) / (eta_now - eta);
              EXPECT_NEAR((x + share * (x_now - x)) / x0,
                          pressures[n_passed],
                          1e-5);
              ++n_passed;
            }
          eta = eta_now;
          x   = x_now;
        }
      EXPECT_EQ(n_passed, borne == 1 ? 3 : 0);
      EXPECT_NEAR(eta, M, 2e-3);
      EXPECT_NEAR(x / x0, borne == 1 ? 0.57435 : 1., 1e-3);
      EXPECT_NEAR(q_of<dim>(state) / 2 / x0, borne == 1 ? 0.3446 : 0.6, 1e-3);
    }
}



// At constant lateral stress (Kirchhoff's) q = 3 (p - p0) up to q = M x; the
// volume there is that of the critical state line. Clay that has borne ten
// times the pressure dilates.
TEST(Clay, DrainedTriaxialTestEndsInTheCriticalState)
{
  constexpr double p0 = 1e5;
  for (const double borne : {p0, 10 * p0})
    {
      const CamClay law   = clay(borne);
      auto          state = law.initialise<3>(p0);
      state.history[0]    = std::pow((p0 + a) / a, -kappa);
      move<3>(law, state, {});
      const double start = std::log(law.volume_ratio<3>(state));
      double       wide = 0, highest = 0;
      for (int k = 0; k < 5000; ++k)
        {
          const auto lateral_at = [&](const double e) {
            auto trial = state;
            move<3>(law, trial, diagonal<3>(-5e-4, e, e));
            return trial.deviator[1] - trial.pressure + p0;
          };
          double c = wide, d = wide + 1e-7, fc = lateral_at(c),
                 fd = lateral_at(d);
          for (int i = 0; i < 50 && std::abs(fd) > 1e-8 * p0; ++i)
            {
              const double next = d - fd * (d - c) / (fd - fc);
              c                 = d;
              fc                = fd;
              d                 = next;
              fd                = lateral_at(d);
            }
          ASSERT_LT(std::abs(fd), 1e-6 * p0) << k;
          wide = d;
          move<3>(law, state, diagonal<3>(-5e-4, wide, wide));
          highest = std::max(highest, q_of<3>(state));
          EXPECT_NEAR(q_of<3>(state), 3 * (state.pressure - p0), 1e-5 * p0);
        }
      const double x = (3 * (p0 + a)) / (3 - M);
      EXPECT_NEAR(x_of(state), x, 1e-3 * x);
      EXPECT_NEAR(q_of<3>(state), M * x, 1e-3 * M * x);
      const double volume = -(lambda - kappa) * std::log(2 * x / (borne + a)) -
                            kappa * std::log(x / (p0 + a));
      EXPECT_NEAR(std::log(law.volume_ratio<3>(state)) - start, volume, 1e-3);
      if (borne > p0)
        {
          EXPECT_GT(highest, 1.2 * M * x); // softens
          EXPECT_GT(volume, 0.1);
        }
    }
}



// Trial states all over the plane, in one step: on the yield surface, by a flow
// along its normal there.
TEST(Clay, ReturnMeetsItsEquations)
{
  constexpr int size_of_c = index_of_variable<3, CamClay>(1);
  int           n_flowed  = 0;
  for (const double c : {2 * a, 1e3, 1e6})
    for (double ratio = 1e-6; ratio < 1e3; ratio *= 3)
      for (const double shear : {1e-6, 1e-3, 0.03, 0.4})
        {
          const CamClay law   = clay(c - a);
          auto          state = law.initialise<3>(0);
          state.history[0]    = std::pow(ratio * c / a, -kappa);
          Matrix<3> gradient{};
          gradient[0][1]             = shear;
          auto elastic               = state;
          elastic.history[size_of_c] = 1e100;
          move<3>(law, elastic, gradient);
          move<3>(law, state, gradient);
          const double x_trial = x_of(elastic), q_trial = q_of<3>(elastic);
          const double x = x_of(state), q = q_of<3>(state);
          SCOPED_TRACE(testing::Message() << c << ' ' << ratio << ' ' << shear);
          if (q_trial * q_trial / (M * M) + x_trial * (x_trial - c) <= 0)
            {
              EXPECT_EQ(alpha_of(law, state), 0);
              EXPECT_NEAR(x, x_trial, 1e-12 * x);
              continue;
            }
          ++n_flowed;
          const double volume = state.history[size_of_c + 1];
          const double now    = c * std::exp(-volume / (lambda - kappa));
          EXPECT_NEAR(state.history[size_of_c],
                      std::max(now - a, 0.),
                      1e-12 * c);
          EXPECT_NEAR(q * q / (M * M) + x * (x - now), 0, 1e-10 * now * now);
          EXPECT_NEAR(std::log(x / x_trial), volume / kappa, 1e-9);
          // d(volume) : d(shear) = -(2 x - c) : 2 q / M^2
          const double alpha = alpha_of(law, state);
          EXPECT_NEAR(-volume * 2 * q / (M * M),
                      alpha * (2 * x - now),
                      1e-10 * now * (alpha + std::abs(volume)));
        }
  EXPECT_GT(n_flowed, 50);
}



// Where softening has come to its end the strength is that of the attraction, q
// = M a / 2, in steady shear.
TYPED_TEST(ClayPaths, SofteningEndsAtTheAttraction)
{
  constexpr int dim   = TypeParam::dim;
  const CamClay law   = clay(0);
  auto          state = law.template initialise<dim>(0);
  state.history[0]    = std::pow(0.1, -kappa);
  const double work   = shear<dim>(law, state, 1e-3, 5000, 1);
  EXPECT_EQ(borne_by<dim>(state), 0);
  EXPECT_NEAR(x_of(state), a / 2, 1e-3 * a);
  EXPECT_NEAR(q_of<dim>(state), M * a / 2, 1e-3 * a);
  EXPECT_GT(work, 0);
}



// The work is what is stored and what is dissipated, to second order in the
// step at least.
TYPED_TEST(ClayPaths, WorkIsStoredOrDissipated)
{
  constexpr int            dim = TypeParam::dim;
  const CamClay            law = clay(0, 1e5);
  const Path<dim, CamClay> coarse(law, 200), middle(law, 400), fine(law, 800);
  EXPECT_GT(coarse.dissipated, 0);
  EXPECT_LT(std::abs(fine.left), 1e-5 * fine.dissipated);
  EXPECT_GT(std::abs(coarse.left / middle.left), 3.7);
  EXPECT_GT(std::abs(middle.left / fine.left), 3.7);
}



// Pulled apart and pushed together: no state needs more tension than the
// attraction, and the pressure comes back with the volume.
TYPED_TEST(ClayPaths, WhatIsPulledApartBearsPressureOnlyWhenClosed)
{
  constexpr int dim   = TypeParam::dim;
  const CamClay law   = clay(1e5);
  auto          state = law.template initialise<dim>(5e4);
  const double  start = state.pressure;
  for (const double volume : {0.2, -0.16 / 1.2})
    {
      auto motion       = motion_of<dim>({});
      motion.volumetric = volume;
      law.template update<dim>(motion, state);
      EXPECT_LT(state.pressure, 0.5 * start);
      EXPECT_GT(state.pressure, -a);
    }
  auto motion       = motion_of<dim>({});
  motion.volumetric = -0.04 / 1.04;
  EXPECT_EQ(law.template update<dim>(motion, state).plastic, 0);
  EXPECT_NEAR(state.pressure, start, 1e-10 * start);
}
