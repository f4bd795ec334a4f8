// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_sample_laws_h
#define limber_tests_support_sample_laws_h

#include <limber/materials/law_list.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <vector>

/**
 * @file Laws with parameters for tests. A law that is not named here is
 * tested with the defaults of its entries.
 */
namespace limber
{
  namespace testing_support
  {
    /** All parameters of the sample laws of one type, in the order of entries.
     */
    template <class Law>
    std::vector<std::array<double, Law::parameters.size()>>
    sample_parameters()
    {
      if constexpr (std::is_same_v<Law, LinearElastic> ||
                    std::is_same_v<Law, NeoHookean>)
        return {{{1000, 1e6, 0.3}}, {{1200, 2e5, 0.49}}, {{900, 3e6, 0.}}};
      else if constexpr (std::is_same_v<Law, NewtonianFluid<false>> ||
                         std::is_same_v<Law, NewtonianFluid<true>>)
        {
          const double mu = Law::has_deviator ? 3. : 0.;
          return {{{1000, 2e5, mu, 0, 0, 7}},
                  {{1000, 2e5, mu, 0, 1, 7}},
                  {{800, 1e6, mu, 0, 1, 1.4}}};
        }
      else if constexpr (std::is_same_v<Law, J2>)
        return {{{1000, 1e6, 0.3, 5e4, 0, 0, 10}},
                {{1200, 2e5, 0.49, 4e3, 1e4, 0, 10}},
                {{8900, 3e6, 0.2, 2e5, 1e3, 1e5, 20}},
                {{1000, 1e6, 0.3, 5e4, 0, 0, 10, 20, 1}},
                {{1000, 1e6, 0.4, 2e4, 1e4, 2e4, 5, 200, 0.4}}};
      else if constexpr (std::is_same_v<Law, DruckerPrager<false>>)
        return {{{2000, 1e6, 0.3, 30, 0, 0, 0, 0}},
                {{1500, 2e6, 0.2, 20, 5e4, 0, 3e4, 1}},
                {{1800, 5e5, 0.45, 0, 2e4, 0, 1e4, 0}},
                {{2000, 1e6, 0.3, 20, 0, 0, 0, 0, 35, 0.3, 1e-2, 2500}}};
      else if constexpr (std::is_same_v<Law, DruckerPrager<true>>)
        return {{{2000, 1e6, 0.3, 30, 0, 10, 0, 0}},
                {{1500, 2e6, 0.2, 25, 5e4, 25, 1e9, 2}}};
      else if constexpr (std::is_same_v<Law, CamClay>)
        return {{{1800, 1e6, 0.5, 0.2, 1.2, 3e5, 3e5}},
                {{1600, 5e5, 0.4, 0.1, 0.9, 2e5, 1e5}}};
      else
        {
          std::array<double, Law::parameters.size()> defaults;
          for (std::size_t k = 0; k < defaults.size(); ++k)
            defaults[k] = Law::parameters[k].standard;
          return {defaults};
        }
    }



    /** Laws that part in tension. */
    template <class Law>
    inline constexpr bool may_part =
      std::is_same_v<Law, DruckerPrager<false>> ||
      std::is_same_v<Law, DruckerPrager<true>>;

    /** Laws whose strength follows the pressure, and that bear little tension.
     */
    template <class Law>
    inline constexpr bool is_frictional =
      may_part<Law> || std::is_same_v<Law, CamClay>;



    template <class Law>
    std::vector<Law>
    samples()
    {
      const auto parameters = sample_parameters<Law>();
      return {parameters.begin(), parameters.end()};
    }



    template <class LawType, int dimension>
    struct LawCase
    {
      using Law                = LawType;
      static constexpr int dim = dimension;
      using State =
        PointState<dimension, double, LawType::template n_history<dimension>>;
    };



    template <class Laws>
    struct LawCases;

    template <class... Laws>
    struct LawCases<std::tuple<Laws...>>
    {
      using types = testing::Types<LawCase<Laws, 2>..., LawCase<Laws, 3>...>;
    };

    /** All laws in the list in two and three dimensions. */
    using AllLawCases = LawCases<LawList>::types;



    /** @p step long by default: then viscous stress is nothing. */
    template <int dim>
    MotionIncrement<dim, double>
    motion_of(const Matrix<dim> &gradient, const double step = 1e30)
    {
      MotionIncrement<dim, double> motion;
      motion.gradient   = gradient;
      motion.volumetric = motion.trace();
      motion.step       = step;
      return motion;
    }



    /** A state that random motions of a given size have led to. */
    template <class Case>
    typename Case::State
    random_state(const typename Case::Law &law,
                 Random                   &random,
                 const double              size = 0.1)
    {
      constexpr int dim = Case::dim;
      auto          state =
        law.template initialise<dim>(0.02 * law.bulk_modulus * random(-1, 1));
      for (int k = 0; k < 5; ++k)
        law.template update<dim>(
          motion_of<dim>(random.template matrix<dim>(size)), state);
      return state;
    }



    /** J times the stress as a full matrix. */
    template <int dim, class State>
    Matrix<3>
    kirchhoff_stress_of(const State &state)
    {
      const auto &s = state.deviator;
      Matrix<3>   t{};
      t[0][0] = s[0];
      t[1][1] = s[1];
      t[2][2] = -s[0] - s[1];
      t[0][1] = t[1][0] = s[2];
      if constexpr (dim == 3)
        {
          t[1][2] = t[2][1] = s[3];
          t[2][0] = t[0][2] = s[4];
        }
      for (int d = 0; d < 3; ++d)
        t[d][d] -= state.pressure;
      return t;
    }
  } // namespace testing_support
} // namespace limber

#endif
