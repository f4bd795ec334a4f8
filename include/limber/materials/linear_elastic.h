// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_linear_elastic_h
#define limber_materials_linear_elastic_h

#include <limber/base/law_parameter.h>
#include <limber/materials/law.h>

#include <cmath>

namespace limber
{
  /**
   * Linear elasticity for small strain and rotation, in rate form:
   *
   *   dp = -K tr(d eps),   ds = 2 G dev(d eps)
   *
   * The stress is the only state: a point keeps no deformation gradient.
   * Energy per volume p^2 / 2K + s:s / 4G.
   */
  class LinearElastic
  {
  public:
    static constexpr const char *name           = "linear elastic";
    static constexpr const char *text           = "small strain and rotation";
    static constexpr bool        takes_pressure = false;
    static constexpr std::array<LawParameter, 3> parameters{
      {law_parameters::density,
       law_parameters::young_modulus,
       law_parameters::poisson_ratio}};

    static constexpr std::array<StateVariable, 0> variables{};

    template <int>
    static constexpr int  n_history      = 0;
    static constexpr bool has_deviator   = true;
    static constexpr bool keeps_deviator = true;
    static constexpr bool uses_spin      = false;
    static constexpr bool dissipates     = false;
    static constexpr int  volumetric     = -1;
    static constexpr bool is_elastic     = true;
    static constexpr bool is_plastic     = false;
    static constexpr bool finite_strain  = false;

    template <int dim, class Number>
    using State = PointState<dim, Number, 0>;

    explicit LinearElastic(const std::array<double, 3> &values)
      : density(values[0])
      , bulk_modulus(values[1] / (3 * (1 - 2 * values[2])))
      , shear_modulus(values[1] / (2 * (1 + values[2])))
    {}

    static const char *
    objection(const std::array<double, 3> &)
    {
      return nullptr;
    }

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 3> &)
    {
      return true;
    }

    double
    dynamic_viscosity() const
    {
      return 0;
    }

    bool
    has_constant_wave_speed() const
    {
      return true;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      const auto strain = symmetric_deviator<dim, Number>(motion.gradient);
      state.pressure -= bulk_modulus * motion.volumetric;
      for (unsigned int k = 0; k < strain.size(); ++k)
        state.deviator[k] += 2. * shear_modulus * strain[k];
      return {};
    }

    /** The strain is sym(F) - 1. */
    template <int dim, class Number>
    State<dim, Number>
    at_deformation(const SmallMatrix<dim, Number> &F, const Number &J) const
    {
      auto displacement_gradient = F;
      for (int d = 0; d < dim; ++d)
        displacement_gradient[d][d] -= 1.;
      State<dim, Number> state;
      state.pressure = -bulk_modulus * (J - 1.);
      state.deviator = symmetric_deviator<dim, Number>(displacement_gradient);
      for (Number &component : state.deviator)
        component *= 2 * shear_modulus;
      return state;
    }

    double
    volumetric_stiffness(const double) const
    {
      return bulk_modulus;
    }

    /** 2 G dev(e) */
    template <int dim>
    SquareMatrix<dim>
    deviatoric_tangent(const State<dim, double> &,
                       const SquareMatrix<dim> &e) const
    {
      double trace = 0;
      for (int d = 0; d < dim; ++d)
        trace += e[d][d];
      SquareMatrix<dim> rate;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          rate[i][j] = 2 * shear_modulus * (e[i][j] - (i == j) * trace / 3);
      return rate;
    }

    template <int dim>
    State<dim, double>
    initialise(const double pressure) const
    {
      State<dim, double> state;
      state.pressure = pressure;
      return state;
    }

    /** Small strain: Kirchhoff and Cauchy stress are the same. */
    template <int dim>
    void
    start_under(State<dim, double>          &state,
                const double                 pressure,
                const Deviator<dim, double> &deviator) const
    {
      state.pressure = pressure;
      state.deviator = deviator;
    }

    template <int dim>
    bool
    admits(const State<dim, double> &state) const
    {
      return std::isfinite(state.pressure) &&
             std::isfinite(squared_norm<dim, double>(state.deviator));
    }

    template <int dim, class Number>
    Number
    volume_ratio(const State<dim, Number> &state) const
    {
      return 1. - state.pressure / bulk_modulus;
    }

    /** Stretch along n, exp(n . eps . n): positive for any strain. */
    template <int dim>
    double
    stretch_along(const State<dim, double>      &state,
                  const std::array<double, dim> &n) const
    {
      const auto matrix = full_matrix<dim>(state.deviator);
      double     stress = 0; // n . s . n
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          stress += n[i] * matrix[i][j] * n[j];
      return std::exp(stress / (2 * shear_modulus) -
                      state.pressure / (3 * bulk_modulus));
    }

    template <class Number>
    Number
    volumetric_energy(const Number &pressure) const
    {
      return pressure * pressure / (2. * bulk_modulus);
    }

    template <class Number>
    Number
    volumetric_energy_gain(const Number &from, const Number &to) const
    {
      return volumetric_energy(to) - volumetric_energy(from);
    }

    template <int dim>
    Deviator<dim, double>
    deviatoric_strain(const State<dim, double> &state) const
    {
      auto strain = state.deviator;
      for (double &component : strain)
        component /= 2 * shear_modulus;
      return strain;
    }

    template <int dim>
    void
    set_deviatoric_strain(State<dim, double>          &state,
                          const Deviator<dim, double> &strain) const
    {
      for (unsigned int k = 0; k < strain.size(); ++k)
        state.deviator[k] = 2 * shear_modulus * strain[k];
    }

    template <int dim, class Number>
    Number
    deviatoric_energy(const State<dim, Number> &state) const
    {
      return squared_norm<dim, Number>(state.deviator) / (4. * shear_modulus);
    }

    template <int dim, class Number>
    Number
    strain_energy(const State<dim, Number> &state) const
    {
      return volumetric_energy(state.pressure) +
             deviatoric_energy<dim, Number>(state);
    }

    template <int dim, class Number>
    Number
    wave_speed_squared(const State<dim, Number> &) const
    {
      return broadcast<Number>((bulk_modulus + 4. / 3. * shear_modulus) /
                               density);
    }

    /** The same for the deviatoric part alone. */
    template <int dim, class Number>
    Number
    deviatoric_wave_speed_squared(const State<dim, Number> &) const
    {
      return broadcast<Number>(4. / 3. * shear_modulus / density);
    }

    /** The volumetric variable is the pressure itself. */
    double
    kirchhoff_pressure(const double pressure) const
    {
      return pressure;
    }

    /** -J d(J p)/dJ at small strain: the bulk modulus, Pa. */
    double
    kirchhoff_stiffness(const double) const
    {
      return bulk_modulus;
    }

    const double density;       // rho_0, kg/m^3
    const double bulk_modulus;  // K, Pa
    const double shear_modulus; // G, Pa
  };
} // namespace limber

#endif
