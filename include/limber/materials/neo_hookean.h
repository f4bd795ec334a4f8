// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_neo_hookean_h
#define limber_materials_neo_hookean_h

#include <limber/base/law_parameter.h>
#include <limber/materials/finite_elasticity.h>

namespace limber
{
  /**
   * Neo-Hookean solid at finite strain: FiniteElasticity without plasticity, be
   * = J^(-2/3) F F^T. The history is updated by the increment f with which
   * points move (MotionIncrement), of which be takes the isochoric part:
   * averaging the volumetric part does not affect be, and det(be) = 1 holds
   * without drift.
   */
  class NeoHookean : public FiniteElasticity<0>
  {
  public:
    static constexpr const char *name           = "neo hookean";
    static constexpr const char *text           = "elastic, at any deformation";
    static constexpr bool        takes_pressure = false;
    static constexpr std::array<LawParameter, 3> parameters{
      {law_parameters::density,
       law_parameters::young_modulus,
       law_parameters::poisson_ratio}};
    static constexpr std::array<StateVariable, 0> variables{};

    static constexpr bool dissipates = false;
    static constexpr bool is_elastic = true;
    static constexpr bool is_plastic = false;

    explicit NeoHookean(const std::array<double, 3> &values)
      : FiniteElasticity(values[0], values[1], values[2])
    {}

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 3> &)
    {
      return true;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      strain<dim>(motion, state);
      set_stress<dim>(state);
      return {};
    }

    /**
     * be = det(F)^(-2/3) F F^T with the determinant of F, not the averaged J.
     */
    template <int dim, class Number>
    State<dim, Number>
    at_deformation(const SmallMatrix<dim, Number> &F, const Number &J) const
    {
      State<dim, Number> state;
      state.history[0] = J;
      isochoric::set_at<dim>(state.history, F);
      set_stress<dim>(state);
      return state;
    }

    double
    volumetric_stiffness(const double J) const
    {
      return 0.5 * bulk_modulus * (1 + 1 / (J * J));
    }

    /**
     * 2/3 G tr(be) dev(e) - 2/3 (s tr(e) + (s : e) 1), s = dev(tau): Simo and
     * Hughes, 9.2, with the deviator s of the law.
     */
    template <int dim>
    SquareMatrix<dim>
    deviatoric_tangent(const State<dim, double> &state,
                       const SquareMatrix<dim>  &e) const
    {
      const auto   be          = isochoric::strain<dim>(state.history);
      const double twice_shear = 2. / 3. * shear_modulus * isochoric::trace(be);
      const double mean        = isochoric::trace(be) / 3;
      double       trace = 0, power = 0; // power: s : e
      for (int i = 0; i < dim; ++i)
        {
          trace += e[i][i];
          for (int j = 0; j < dim; ++j)
            power += shear_modulus * (be[i][j] - (i == j) * mean) * e[i][j];
        }
      SquareMatrix<dim> rate;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          rate[i][j] = twice_shear * (e[i][j] - (i == j) * trace / 3) -
                       2. / 3. *
                         (shear_modulus * (be[i][j] - (i == j) * mean) * trace +
                          (i == j) * power);
      return rate;
    }
  };
} // namespace limber

#endif
