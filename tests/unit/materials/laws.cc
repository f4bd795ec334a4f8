// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/sample_laws.h>

#include <cmath>
#include <functional>

/**
 * @file What every law in the list has to satisfy, whatever it is.
 */
using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class Case>
  class EveryLaw : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Law                = typename Case::Law;
    using State              = typename Case::State;

    static constexpr bool linear  = std::is_same_v<Law, LinearElastic>;
    static constexpr bool fluid   = Law::dissipates && !Law::is_plastic;
    static constexpr bool plastic = Law::is_plastic;
    // Whether the pressure says how much shear stress there may be, and none
    // is borne without it.
    static constexpr bool frictional = is_frictional<Law>;
    static constexpr bool pointwise  = Law::volumetric < 0;

    static double
    stiffness(const Law &law)
    {
      return law.density * law.template wave_speed_squared<dim>(
                             law.template initialise<dim>(0));
    }

    static State
    moved(const Law &law, State state, const Matrix<dim> &gradient)
    {
      law.template update<dim>(motion_of<dim>(gradient), state);
      return state;
    }

    static Matrix<dim>
    times(const double factor, Matrix<dim> a)
    {
      for (auto &row : a)
        for (double &x : row)
          x *= factor;
      return a;
    }

    /** J sigma : grad v. */
    static double
    power(const State &state, const Matrix<dim> &gradient)
    {
      const auto t      = kirchhoff_stress_of<dim>(state);
      double     result = 0;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          result += t[i][j] * gradient[i][j];
      return result;
    }

    /** The variable of the state that holds the volumetric history. */
    static double &
    volumetric(State &state)
    {
      if constexpr (pointwise)
        return state.pressure;
      else
        return state.history[Law::volumetric];
    }

    /** Whether the material bears nothing at all, as sand that was pulled. */
    static bool
    parted(const Law &, const State &state)
    {
      if constexpr (may_part<Law>)
        return state.history[index_of_variable<dim, Law>(1)] > 0;
      return false;
    }

    Random random;
  };

  TYPED_TEST_SUITE(EveryLaw, AllLawCases);
} // namespace



TYPED_TEST(EveryLaw, SamplesAreServedByThisVariant)
{
  for (const auto &values : sample_parameters<typename TestFixture::Law>())
    EXPECT_TRUE(TestFixture::Law::accepts(values));
}



// dW = J sigma : grad v dt; of a viscous fluid only pressure stores energy,
// and with plastic flow its work is the rest. That is known to second order of
// a step, so that its two sides leave an error of first order in h.
TYPED_TEST(EveryLaw, StressIsTheDerivativeOfStrainEnergy)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    for (int k = 0; k < 20; ++k)
      {
        const auto state = random_state<TypeParam>(law, this->random);
        const auto a     = this->random.template matrix<dim>();

        const double h      = this->plastic ? 1e-8 : 1e-5;
        const auto   energy = [&](const double t) {
          auto         now = state;
          const double work =
            law.template update<dim>(motion_of<dim>(this->times(t, a)), now)
              .plastic;
          return law.template strain_energy<dim>(now) + work;
        };
        // The first step of a central difference of second order in h
        EXPECT_NEAR((energy(h) - energy(-h)) / (2 * h),
                    this->power(state, a),
                    1e-7 * this->stiffness(law));
      }
}



TYPED_TEST(EveryLaw, EnergyIsZeroAtRestAndPositiveElsewhere)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    {
      EXPECT_NEAR(law.template strain_energy<dim>(
                    law.template initialise<dim>(0)),
                  0.,
                  1e-15 * this->stiffness(law));
      for (int k = 0; k < 20; ++k)
        {
          const auto state = random_state<TypeParam>(law, this->random);
          if (!this->parted(law, state))
            {
              EXPECT_GT(law.template strain_energy<dim>(state), 0.);
            }
        }
    }
}



namespace
{
  /** The rotation by an angle about z, or about a skew axis in 3d. */
  Matrix<3>
  rotation(const int dim, const double angle)
  {
    Vector<3> axis{{0, 0, 1}};
    if (dim == 3)
      axis = {{2. / 7, 3. / 7, 6. / 7}};
    const Matrix<3> w{{{{0, -axis[2], axis[1]}},
                       {{axis[2], 0, -axis[0]}},
                       {{-axis[1], axis[0], 0}}}};
    Matrix<3>       q{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        {
          q[i][j] += std::sin(angle) * w[i][j];
          for (int k = 0; k < 3; ++k)
            q[i][j] += (1 - std::cos(angle)) * w[i][k] * w[k][j];
        }
    return q;
  }



  /** a R(angle) + b 1 for the rows and columns that there are. */
  template <int dim>
  Matrix<dim>
  combined(const double a, const double angle, const double b)
  {
    const Matrix<3> q = rotation(dim, angle);
    Matrix<dim>     result{};
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        result[i][j] = a * q[i][j] + (i == j ? b : 0);
    return result;
  }
} // namespace



// Stress turns with the material, and the volume stays, with the square that
// belongs to how points move: exactly where they have moved by 1 + a, with an
// error of second order in the step where a velocity has moved them before
// (usf), or strains them by halves while they move by the sum. Linear
// elasticity is for small strain and rotation and exempt: there, stress keeps
// its direction in space.
TYPED_TEST(EveryLaw, RigidRotationTurnsTheStress)
{
  constexpr int   dim   = TestFixture::dim;
  const double    angle = 0.8;
  const Matrix<3> q     = rotation(dim, angle);

  // One step by so large an angle
  using Step     = std::function<void(
    const typename TestFixture::Law &, typename TestFixture::State &, double)>;
  const auto act = [](const auto        &law,
                      auto              &state,
                      const Matrix<dim> &a,
                      const double       square) {
    auto motion   = motion_of<dim>(a);
    motion.square = square;
    law.template update<dim>(motion, state);
  };
  const Step usl = [&](const auto &law, auto &state, const double part) {
    act(law, state, combined<dim>(1, part, -1), 0);
  };
  const Step usf = [&](const auto &law, auto &state, const double part) {
    act(law, state, combined<dim>(-1, -part, 1), 1);
  };
  // The velocity at the beginning, and what is then left of the motion
  const Step halves = [&](const auto &law, auto &state, const double part) {
    Matrix<dim>       first  = combined<dim>(0.25, part, 0);
    const Matrix<dim> back   = combined<dim>(0.25, -part, 0);
    Matrix<dim>       second = combined<dim>(1, part, -1);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        {
          first[i][j] -= back[i][j];
          second[i][j] -= first[i][j];
        }
    act(law, state, first, -0.5);
    act(law, state, second, -0.5);
  };

  for (const auto &law : samples<typename TestFixture::Law>())
    {
      const auto state  = random_state<TypeParam>(law, this->random);
      const auto before = kirchhoff_stress_of<dim>(state);
      Matrix<3>  turned{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
              turned[i][j] += q[i][k] * before[k][l] * q[j][l];

      const auto error = [&](const Step &step, const int n_steps) {
        auto now = state;
        for (int s = 0; s < n_steps; ++s)
          step(law, now, angle / n_steps);
        const auto  after  = kirchhoff_stress_of<dim>(now);
        const auto &wanted = this->linear ? before : turned;
        double      result = 0;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            result = std::max(result, std::abs(after[i][j] - wanted[i][j]));
        return result / this->stiffness(law);
      };

      if (this->linear)
        {
          const Step spin = [&](const auto &law, auto &state, const double) {
            Matrix<dim> a = combined<dim>(0.5, angle, 0);
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j <= i; ++j)
                a[j][i] = -(a[i][j] -= a[j][i]);
            act(law, state, a, 0);
          };
          EXPECT_LT(error(spin, 1), 1e-14);
          continue;
        }
      // A fluid knows the volume to second order alone, so in 3d
      if (!this->fluid || dim == 2)
        {
          EXPECT_LT(error(usl, 20), 1e-13);
        }
      for (const Step &step : {usl, usf, halves})
        {
          const double coarse = error(step, 20), fine = error(step, 40);
          EXPECT_LT(coarse, 1e-3);
          if (coarse > 1e-13)
            {
              EXPECT_GT(coarse / fine, 3.8);
            }
        }
    }
}



// Steps of cells that are hardly touched: by whatever they strain, in whichever
// scheme.
TYPED_TEST(EveryLaw, NoStepTurnsAPointInsideOut)
{
  constexpr int dim = TestFixture::dim;
  if constexpr (std::is_same_v<typename TestFixture::Law, NeoHookean>)
    for (const auto &law : samples<typename TestFixture::Law>())
      for (const double square : {0., 1., -0.5})
        for (int k = 0; k < 1000; ++k)
          {
            auto state  = law.template initialise<dim>(0);
            auto motion = motion_of<dim>(
              this->random.template matrix<dim>(0.003 * (k + 1)));
            motion.square = square;
            ASSERT_GT(determinant<dim>(motion.deformation()), 0);
            law.template update<dim>(motion, state);
            ASSERT_GT(law.template volume_ratio<dim>(state), 0);
          }
}



TYPED_TEST(EveryLaw, WaveSpeedAtRestIsThatOfTheModuli)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    {
      const auto   rest    = law.template initialise<dim>(0);
      const double squared = law.template wave_speed_squared<dim>(rest);
      double       modulus = law.bulk_modulus;
      if constexpr (!TestFixture::fluid)
        modulus += 4. / 3. * law.shear_modulus;
      // what is frictional bears nothing at rest, and adds to the bound
      if (TestFixture::frictional)
        {
          EXPECT_GE(squared, modulus / law.density);
          continue;
        }
      EXPECT_DOUBLE_EQ(squared, modulus / law.density);

      const double h = 1e-5;
      Matrix<dim>  stretch{};
      stretch[0][0]      = 1;
      const auto tension = [&](const double t) {
        return kirchhoff_stress_of<dim>(
          this->moved(law, rest, this->times(t, stretch)))[0][0];
      };
      EXPECT_NEAR((tension(h) - tension(-h)) / (2 * h * law.density),
                  squared,
                  1e-8 * squared);
    }
}



// rho_0 c^2 = m . A m with the acoustic tensor A of any direction n; in states
// under stress the law may answer with a bound.
TYPED_TEST(EveryLaw, WaveSpeedBoundsTheAcousticTensor)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    for (int k = 0; k < 200; ++k)
      {
        const auto   state   = random_state<TypeParam>(law, this->random, 0.15);
        const double squared = law.template wave_speed_squared<dim>(state);
        EXPECT_GT(squared, 0.);

        auto n = this->random.template vector<dim>(),
             m = k % 2 ? n : this->random.template vector<dim>();
        for (auto *a : {&n, &m})
          {
            double norm = 0;
            for (const double x : *a)
              norm += x * x;
            for (double &x : *a)
              x /= std::sqrt(norm);
          }
        Matrix<dim> a;
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j)
            a[i][j] = m[i] * n[j];
        double along = 0;
        for (int i = 0; i < dim; ++i)
          along += m[i] * n[i];

        // m . (tau f^-T) n with f = 1 + t m n; small strain does not tell tau
        // from the nominal stress
        const double h       = 1e-5;
        const auto   nominal = [&](const double t) {
          const double turn = this->linear ? 0 : t * along / (1 + t * along);
          const auto   stress = kirchhoff_stress_of<dim>(
            this->moved(law, state, this->times(t, a)));
          double result = 0;
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              result += m[i] * stress[i][j] * (1 - turn) * n[j];
          return result;
        };
        EXPECT_LT((nominal(h) - nominal(-h)) / (2 * h),
                  (1 + 1e-6) * law.density * squared);
      }
}



TYPED_TEST(EveryLaw, InitialStateIsAtRestUnderThePressure)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    for (const double ratio : {-0.05, 0., 1e-6, 0.03, 0.4})
      {
        // tension may be more than the material bears
        if (TestFixture::frictional && ratio < 0)
          continue;
        const double pressure = ratio * law.bulk_modulus;
        auto         state    = law.template initialise<dim>(pressure);
        const double J        = law.template volume_ratio<dim>(state);
        // Small strain does not tell J p from p.
        EXPECT_NEAR(state.pressure,
                    (this->linear ? 1 : J) * pressure,
                    1e-15 * law.bulk_modulus);
        for (const double s : state.deviator)
          EXPECT_EQ(s, 0.);

        // nothing moves: nothing changes
        const auto before = state;
        law.template update<dim>(motion_of<dim>({}), state);
        EXPECT_NEAR(state.pressure, before.pressure, 1e-15 * law.bulk_modulus);
        for (std::size_t k = 0; k < state.history.size(); ++k)
          EXPECT_NEAR(state.history[k],
                      before.history[k],
                      1e-15 * std::max(1., std::abs(before.history[k])));
        for (const double s : state.deviator)
          EXPECT_NEAR(s, 0., 1e-15 * this->stiffness(law));
      }
}



// The derivative is -p in J; of the energy in p, where p is the history, it
// is p / K.
TYPED_TEST(EveryLaw, VolumetricEnergyBelongsToThePressure)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    for (const double ratio : {-0.05, 1e-3, 0.1, 0.4})
      {
        auto state     = law.template initialise<dim>(ratio * law.bulk_modulus);
        const double J = law.template volume_ratio<dim>(state);
        double      &x = this->volumetric(state);
        const double h = 1e-5 * (this->pointwise ? law.bulk_modulus : 1);
        const double slope =
          (law.volumetric_energy(x + h) - law.volumetric_energy(x - h)) /
          (2 * h);
        const double expected = this->pointwise ?
                                  state.pressure / law.bulk_modulus :
                                  -state.pressure / J;
        EXPECT_NEAR(slope,
                    expected,
                    1e-7 * (this->pointwise ? 1 : law.bulk_modulus));
        EXPECT_NEAR(law.volumetric_energy(x),
                    law.template strain_energy<dim>(state),
                    1e-14 * law.bulk_modulus);
      }
}



// Averages over cells replace the volumetric part of the motion only. Where
// strength follows the pressure, the deviator does as well.
TYPED_TEST(EveryLaw, VolumetricMotionActsOnThePressureAlone)
{
  constexpr int dim = TestFixture::dim;
  if (TestFixture::frictional)
    return;
  for (const auto &law : samples<typename TestFixture::Law>())
    {
      const auto before = random_state<TypeParam>(law, this->random);
      auto motion = motion_of<dim>(this->random.template matrix<dim>(0.05));
      auto own = before, averaged = before;
      law.template update<dim>(motion, own);
      motion.volumetric += 0.01;
      law.template update<dim>(motion, averaged);
      EXPECT_LT(averaged.pressure, own.pressure);
      for (std::size_t k = 0; k < own.deviator.size(); ++k)
        EXPECT_NEAR(own.deviator[k],
                    averaged.deviator[k],
                    1e-15 * this->stiffness(law));
      for (int k = 0; k < int(own.history.size()); ++k)
        if (k != TestFixture::Law::volumetric)
          {
            EXPECT_NEAR(own.history[k], averaged.history[k], 1e-15);
          }
    }
}



TYPED_TEST(EveryLaw, ConstantWaveSpeedIsConstant)
{
  constexpr int dim = TestFixture::dim;
  for (const auto &law : samples<typename TestFixture::Law>())
    if (law.has_constant_wave_speed())
      for (int k = 0; k < 10; ++k)
        {
          EXPECT_EQ(law.template wave_speed_squared<dim>(
                      random_state<TypeParam>(law, this->random)),
                    law.template wave_speed_squared<dim>(
                      typename TestFixture::State()));
        }
}



namespace
{
  // Many states in the lanes of packs, and each on its own
  template <class Case, int width>
  void
  compare_with_packs(const typename Case::Law &law, Random &random)
  {
    constexpr int dim = Case::dim;
    using Number      = Pack<width>;
    constexpr int n   = Case::Law::template n_history<dim>;

    PointState<dim, Number, n>                      packed;
    MotionIncrement<dim, Number>                    packed_motion;
    std::array<typename Case::State, width>         states;
    std::array<MotionIncrement<dim, double>, width> motions;
    packed_motion.step = 0.5;
    for (int i = 0; i < width; ++i)
      {
        states[i]  = random_state<Case>(law, random);
        motions[i] = motion_of<dim>(random.template matrix<dim>(0.1), 0.5);
        motions[i].volumetric += random(-0.01, 0.01);
        packed.pressure[i]          = states[i].pressure;
        packed_motion.volumetric[i] = motions[i].volumetric;
        for (std::size_t k = 0; k < packed.deviator.size(); ++k)
          packed.deviator[k][i] = states[i].deviator[k];
        for (int k = 0; k < n; ++k)
          packed.history[k][i] = states[i].history[k];
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            packed_motion.gradient[d][e][i] = motions[i].gradient[d][e];
      }

    const Number before  = law.template strain_energy<dim>(packed);
    const auto   heat    = law.template update<dim>(packed_motion, packed);
    const Number after   = law.template strain_energy<dim>(packed);
    const Number squared = law.template wave_speed_squared<dim>(packed);
    const Number J       = law.template volume_ratio<dim>(packed);
    const double scale   = law.density * maximum(squared);
    for (int i = 0; i < width; ++i)
      {
        auto &state = states[i];
        EXPECT_NEAR(before[i],
                    law.template strain_energy<dim>(state),
                    1e-14 * scale);
        const auto own_heat = law.template update<dim>(motions[i], state);
        EXPECT_NEAR(after[i],
                    law.template strain_energy<dim>(state),
                    1e-14 * scale);
        EXPECT_NEAR(squared[i],
                    law.template wave_speed_squared<dim>(state),
                    1e-14 * squared[i]);
        EXPECT_NEAR(J[i], law.template volume_ratio<dim>(state), 1e-14);
        EXPECT_NEAR(heat.viscous[i], own_heat.viscous, 1e-14 * scale);
        EXPECT_NEAR(heat.cutoff[i], own_heat.cutoff, 1e-14 * scale);
        EXPECT_NEAR(packed.pressure[i], state.pressure, 1e-14 * scale);
        for (std::size_t k = 0; k < packed.deviator.size(); ++k)
          EXPECT_NEAR(packed.deviator[k][i], state.deviator[k], 1e-14 * scale);
        for (int k = 0; k < n; ++k)
          EXPECT_NEAR(packed.history[k][i],
                      state.history[k],
                      1e-14 * std::max(1., std::abs(state.history[k])));
      }
  }
} // namespace



TYPED_TEST(EveryLaw, PacksGiveWhatNumbersGive)
{
  for (const auto &law : samples<typename TestFixture::Law>())
    for (int k = 0; k < 10; ++k)
      {
        compare_with_packs<TypeParam, 2>(law, this->random);
        compare_with_packs<TypeParam, 4>(law, this->random);
        compare_with_packs<TypeParam, 8>(law, this->random);
      }
}



// What is averaged of a history is all of it: a state follows from its strain,
// which rotates as stress does.
TYPED_TEST(EveryLaw, DeviatoricStrainIsTheWholeDeviatoricHistory)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (Law::keeps_deviator)
    for (const auto &law : samples<Law>())
      for (int k = 0; k < 20; ++k)
        {
          const auto state  = random_state<TypeParam>(law, this->random);
          const auto strain = law.template deviatoric_strain<dim>(state);
          auto       again  = random_state<TypeParam>(law, this->random);
          again.pressure    = state.pressure;
          if constexpr (!TestFixture::pointwise)
            again.history[Law::volumetric] = state.history[Law::volumetric];
          for (unsigned int i = 0; i < Law::variables.size(); ++i)
            {
              const int j      = index_of_variable<dim, Law>(i);
              again.history[j] = state.history[j];
            }
          law.template set_deviatoric_strain<dim>(again, strain);
          const double scale = this->stiffness(law);
          EXPECT_NEAR(again.pressure, state.pressure, 1e-13 * scale);
          for (std::size_t i = 0; i < strain.size(); ++i)
            EXPECT_NEAR(again.deviator[i], state.deviator[i], 1e-13 * scale);
          for (std::size_t i = 0; i < state.history.size(); ++i)
            EXPECT_NEAR(again.history[i], state.history[i], 1e-13);
          EXPECT_NEAR(law.template deviatoric_energy<dim>(state) +
                        law.template volumetric_energy<double>(
                          this->volumetric(again)),
                      law.template strain_energy<dim>(state),
                      1e-13 * scale);

          // small strain: s = 2 G e
          auto small = strain;
          for (double &component : small)
            component *= 1e-6;
          law.template set_deviatoric_strain<dim>(again, small);
          for (std::size_t i = 0; i < small.size(); ++i)
            EXPECT_NEAR(again.deviator[i],
                        2 * law.shear_modulus * small[i],
                        1e-11 * law.shear_modulus);

          // none is rest
          law.template set_deviatoric_strain<dim>(again, {});
          EXPECT_NEAR(law.template deviatoric_energy<dim>(again), 0, 1e-15);
          for (const double s : again.deviator)
            EXPECT_NEAR(s, 0, 1e-15 * law.shear_modulus);
        }
}



// An elastic law gives the same at a deformation as after the motion there.
TYPED_TEST(EveryLaw, StateAtADeformationIsWhereMotionsLead)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (Law::is_elastic)
    for (const auto &law : samples<Law>())
      for (int k = 0; k < 5; ++k)
        {
          // Small strain knows the symmetric part of the sum of motions only
          auto A = this->random.template matrix<dim>(
            Law::finite_strain ? 0.015 : 1e-7);
          if (!Law::finite_strain)
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < i; ++j)
                A[i][j] = A[j][i];
          constexpr int n_steps = 10;
          auto          state   = law.template initialise<dim>(0);
          Matrix<dim>   F{};
          for (int d = 0; d < dim; ++d)
            F[d][d] = 1;
          for (int n = 0; n < n_steps; ++n)
            {
              state             = this->moved(law, state, A);
              const auto former = F;
              for (int i = 0; i < dim; ++i)
                for (int j = 0; j < dim; ++j)
                  if (Law::finite_strain)
                    for (int l = 0; l < dim; ++l)
                      F[i][j] += A[i][l] * former[l][j];
                  else
                    F[i][j] += A[i][j];
            }
          double trace = 0;
          for (int d = 0; d < dim; ++d)
            trace += n_steps * A[d][d];
          const double J = Law::finite_strain ? determinant<dim>(F) : 1 + trace;
          const auto   direct = law.template at_deformation<dim>(F, J);
          const double scale  = 1e-11 * this->stiffness(law);
          EXPECT_NEAR(direct.pressure, state.pressure, scale);
          for (unsigned int c = 0; c < direct.deviator.size(); ++c)
            EXPECT_NEAR(direct.deviator[c], state.deviator[c], scale);
        }
}



// The tangents of an elastic law against differences of its stress.
TYPED_TEST(EveryLaw, TangentsAreDerivatives)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (Law::is_elastic)
    for (const auto &law : samples<Law>())
      for (int k = 0; k < 20; ++k)
        {
          auto F = this->random.template matrix<dim>(0.3);
          for (int d = 0; d < dim; ++d)
            F[d][d] += 1;
          const auto   L           = this->random.template matrix<dim>();
          const double h           = 1e-6;
          const auto   deviator_at = [&](const double t) {
            auto moved = F;
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j)
                for (int l = 0; l < dim; ++l)
                  moved[i][j] +=
                    t * L[i][l] *
                    (Law::finite_strain ? F[l][j] : double(l == j));
            auto state     = law.template at_deformation<dim>(moved, 1.1);
            state.pressure = 0;
            return kirchhoff_stress_of<dim>(state);
          };
          const auto  ahead = deviator_at(h), behind = deviator_at(-h);
          const auto  s = deviator_at(0);
          Matrix<dim> e{};
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              e[i][j] = (L[i][j] + L[j][i]) / 2;
          const auto rate = law.template deviatoric_tangent<dim>(
            law.template at_deformation<dim>(F, 1.1), e);
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              {
                double expected = rate[i][j];
                if (Law::finite_strain)
                  for (int l = 0; l < dim; ++l)
                    expected += L[i][l] * s[l][j] + s[i][l] * L[j][l];
                EXPECT_NEAR((ahead[i][j] - behind[i][j]) / (2 * h),
                            expected,
                            1e-7 * this->stiffness(law));
              }

          // dU/dJ and its slope; small strain has U in terms of pressure
          const double J     = 1 + this->random(-0.2, 0.2);
          const auto   slope = [&](const double ratio) {
            const auto state = law.template at_deformation<dim>(F, ratio);
            return -state.pressure / (Law::finite_strain ? ratio : 1);
          };
          const auto energy = [&](const double ratio) {
            auto state = law.template at_deformation<dim>(F, ratio);
            return law.volumetric_energy(this->volumetric(state));
          };
          EXPECT_NEAR((energy(J + h) - energy(J - h)) / (2 * h),
                      slope(J),
                      1e-7 * this->stiffness(law));
          EXPECT_NEAR((slope(J + h) - slope(J - h)) / (2 * h),
                      law.volumetric_stiffness(J),
                      1e-6 * this->stiffness(law));
        }
}



namespace
{
  /** Laws that may start under any stress that is within their strength. */
  template <class Law>
  constexpr bool starts_under_stress = !Law::takes_pressure;

  /** A Cauchy stress that all sample laws admit, in parts of a modulus. */
  template <int dim>
  Deviator<dim, double>
  mild_deviator(const double size)
  {
    if constexpr (dim == 2)
      return {{0.5 * size, -0.7 * size, 0.3 * size}};
    else
      return {{0.5 * size, -0.7 * size, 0.3 * size, -0.2 * size, 0.4 * size}};
  }
} // namespace



// Kirchhoff's stress of a start over its J is the stress that is given, and at
// rest it stays; small strain knows no J.
TYPED_TEST(EveryLaw, StartsUnderAGivenStress)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (starts_under_stress<Law>)
    for (const auto &law : samples<Law>())
      for (const double pressure : {1e4, 3e4})
        {
          const auto deviator = mild_deviator<dim>(0.08 * pressure);
          auto       state    = law.template initialise<dim>(0);
          law.template start_under<dim>(state, pressure, deviator);
          EXPECT_TRUE(law.template admits<dim>(state));
          const double J =
            TestFixture::linear ? 1 : law.template volume_ratio<dim>(state);
          EXPECT_NEAR(state.pressure / J, pressure, 1e-9 * pressure);
          for (unsigned int k = 0; k < deviator.size(); ++k)
            EXPECT_NEAR(state.deviator[k] / J, deviator[k], 1e-12 * pressure);
          const auto   before = state;
          const double work =
            law.template update<dim>(motion_of<dim>({}), state).plastic;
          EXPECT_EQ(work, 0);
          EXPECT_NEAR(state.pressure, before.pressure, 1e-12 * pressure);
          for (unsigned int k = 0; k < deviator.size(); ++k)
            EXPECT_NEAR(state.deviator[k],
                        before.deviator[k],
                        1e-10 * pressure);

          // beyond any strength that is not that of elasticity
          auto beyond = law.template initialise<dim>(0);
          if constexpr (Law::is_plastic)
            beyond.history[index_of_variable<dim, Law>(0)] = 0;
          law.template start_under<dim>(beyond,
                                        pressure,
                                        mild_deviator<dim>(1e7));
          EXPECT_EQ(law.template admits<dim>(beyond), Law::is_elastic);
        }
}



// A soil that is not said to have borne more starts on its yield surface, and
// what has opened bears nothing.
TYPED_TEST(EveryLaw, StartsKnowWhatIsAdmitted)
{
  constexpr int dim = TestFixture::dim;
  using Law         = typename TestFixture::Law;
  if constexpr (std::is_same_v<Law, CamClay>)
    {
      auto parameters = sample_parameters<Law>().front();
      parameters[5]   = 0;
      const Law law(parameters);
      auto      state = law.template initialise<dim>(0);
      law.template start_under<dim>(state, 1e5, mild_deviator<dim>(3e4));
      double      &borne = state.history[index_of_variable<dim, Law>(1)];
      const double a = law.attraction, x = state.pressure + a,
                   q =
                     std::sqrt(1.5 * squared_norm<dim, double>(state.deviator));
      EXPECT_NEAR(borne + a, x + q * q / (law.slope * law.slope * x), 1e-9 * x);
      EXPECT_TRUE(law.template admits<dim>(state));
      borne *= 0.99;
      EXPECT_FALSE(law.template admits<dim>(state));
      law.template start_under<dim>(state, -20 * a, {});
      EXPECT_FALSE(law.template admits<dim>(state));
    }
  else if constexpr (may_part<Law>)
    {
      const Law law(sample_parameters<Law>().front()); // no tension
      auto      state = law.template initialise<dim>(0);
      law.template start_under<dim>(state, -1e3, {});
      EXPECT_FALSE(law.template admits<dim>(state));
      law.template start_under<dim>(state, 1e3, {});
      EXPECT_TRUE(law.template admits<dim>(state));
      state.history[index_of_variable<dim, Law>(1)] = 0.1;
      EXPECT_FALSE(law.template admits<dim>(state));
    }
}
