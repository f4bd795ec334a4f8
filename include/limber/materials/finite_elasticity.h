// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_finite_elasticity_h
#define limber_materials_finite_elasticity_h

#include <limber/materials/isochoric_strain.h>

#include <cmath>

namespace limber
{
  /**
   * Base of the solids at finite strain, with the hyperelastic energy of Simo
   * and Hughes (Computational Inelasticity, 9.2), split into volumetric and
   * isochoric parts:
   *
   *   W = K/2 ((J^2 - 1)/2 - ln J) + G/2 (tr(be) - 3)
   *   J p = -K/2 (J^2 - 1),   dev(tau) = G dev(be)
   *
   * A point keeps J, the free entries of be (isochoric_strain.h), then
   * @p n_variables history variables of the law. Functions that a sweep calls
   * per point are always inlined: as several laws share them, GCC would emit
   * calls, which took a tenth of the sweep of the neo-Hookean solid.
   */
  template <int n_variables>
  class FiniteElasticity
  {
  public:
    template <int dim>
    static constexpr int n_history =
      1 + isochoric::n_entries<dim> + n_variables;
    static constexpr bool has_deviator   = true;
    static constexpr bool keeps_deviator = true;
    static constexpr bool uses_spin      = true;
    static constexpr int  volumetric     = 0;
    static constexpr bool finite_strain  = true;

    template <int dim, class Number>
    using State = PointState<dim, Number, n_history<dim>>;

    FiniteElasticity(const double density,
                     const double young_modulus,
                     const double poisson_ratio)
      : density(density)
      , bulk_modulus(young_modulus / (3 * (1 - 2 * poisson_ratio)))
      , shear_modulus(young_modulus / (2 * (1 + poisson_ratio)))
    {}

    template <class Values>
    static const char *
    objection(const Values &)
    {
      return nullptr;
    }

    double
    dynamic_viscosity() const
    {
      return 0;
    }

    bool
    has_constant_wave_speed() const
    {
      return false;
    }

    /**
     * Set the elastic strain of a state, whose named variables are given, such
     * that it is under the Cauchy stress with this pressure and deviator, both
     * times the inelastic volume ratio that the variables mean (Pa).
     */
    template <int dim>
    void
    start_under(State<dim, double>          &state,
                const double                 pressure,
                const Deviator<dim, double> &deviator) const
    {
      state.history[0] = volume_at(pressure);
      set_deviator_of_start<dim>(state, deviator);
      state.pressure = pressure_at(state.history[0]);
    }

    /** Whether the law admits a state. */
    template <int dim>
    bool
    admits(const State<dim, double> &state) const
    {
      return std::isfinite(state.pressure) &&
             std::isfinite(squared_norm<dim, double>(state.deviator));
    }

    /** The state at rest under a pressure; named variables are zero. */
    template <int dim>
    State<dim, double>
    initialise(const double pressure) const
    {
      State<dim, double> state;
      state.history[0] = volume_at(pressure);
      state.history[1] = state.history[2] = 1;
      set_stress<dim>(state);
      return state;
    }

    template <int dim, class Number>
    Number
    volume_ratio(const State<dim, Number> &state) const
    {
      return state.history[0];
    }

    /**
     * sqrt(n . b . n), b = J^(2/3) be: the elastic stretch along the unit
     * vector n.
     */
    template <int dim>
    double
    stretch_along(const State<dim, double>      &state,
                  const std::array<double, dim> &n) const
    {
      const auto be     = isochoric::strain<dim>(state.history);
      double     square = 0;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          square += n[i] * be[i][j] * n[j];
      return std::cbrt(state.history[0]) * std::sqrt(square);
    }

    template <class Number>
    Number
    volumetric_energy(const Number &J) const
    {
      return 0.5 * bulk_modulus * (0.5 * (J * J - 1.) - logarithm(J));
    }

    template <class Number>
    Number
    volumetric_energy_gain(const Number &from, const Number &to) const
    {
      return 0.5 * bulk_modulus *
             (0.5 * (to - from) * (to + from) - logarithm_of_ratio(to, from));
    }

    /** ln(be) / 2 */
    template <int dim>
    Deviator<dim, double>
    deviatoric_strain(const State<dim, double> &state) const
    {
      return isochoric::logarithmic<dim>(state.history);
    }

    template <int dim>
    void
    set_deviatoric_strain(State<dim, double>          &state,
                          const Deviator<dim, double> &strain) const
    {
      isochoric::set_logarithmic<dim>(state.history, strain);
      set_stress<dim>(state);
    }

    template <int dim, class Number>
    Number
    deviatoric_energy(const State<dim, Number> &state) const
    {
      const auto be = isochoric::strain<dim>(state.history);
      return 0.5 * shear_modulus * (isochoric::trace(be) - 3.);
    }

    template <int dim, class Number>
    Number
    strain_energy(const State<dim, Number> &state) const
    {
      return volumetric_energy(state.history[0]) +
             deviatoric_energy<dim>(state);
    }

    /** An upper bound by the largest eigenvalue (Gershgorin); exact at rest. */
    template <int dim, class Number>
    __attribute__((always_inline)) Number
    wave_speed_squared(const State<dim, Number> &state) const
    {
      const auto   be = isochoric::strain<dim>(state.history);
      const Number J  = state.history[0];
      return (0.5 * bulk_modulus * (J * J + 1.) +
              4. / 3. * shear_modulus * isochoric::largest_eigenvalue(be)) *
             (1. / density);
    }

    /** The same bound for the deviatoric part alone. */
    template <int dim, class Number>
    Number
    deviatoric_wave_speed_squared(const State<dim, Number> &state) const
    {
      return 4. / 3. * shear_modulus / density *
             isochoric::largest_eigenvalue(
               isochoric::strain<dim>(state.history));
    }

    /** J p, Pa. */
    double
    kirchhoff_pressure(const double J) const
    {
      return pressure_at(J);
    }

    /** -J d(J p)/dJ, Pa. */
    double
    kirchhoff_stiffness(const double J) const
    {
      return bulk_modulus * J * J;
    }

    const double density;       // rho_0, kg/m^3
    const double bulk_modulus;  // K, Pa
    const double shear_modulus; // G, Pa

  protected:
    /** J under a Cauchy pressure p: K/2 J^2 + p J - K/2 = 0. */
    double
    volume_at(const double pressure) const
    {
      const double ratio = pressure / bulk_modulus;
      return std::sqrt(ratio * ratio + 1) - ratio;
    }

    /** Set be and the Kirchhoff deviator, from a Cauchy deviator and J. */
    template <int dim>
    void
    set_deviator_of_start(State<dim, double>   &state,
                          Deviator<dim, double> deviator) const
    {
      for (double &component : deviator)
        component *= state.history[0];
      state.deviator = deviator;
      for (double &component : deviator)
        component /= shear_modulus;
      isochoric::set_deviator<dim>(state.history, deviator);
    }

    /**
     * Trial strain: update J and be by a purely elastic increment. The stress
     * is not updated.
     */
    template <int dim, class Number>
    __attribute__((always_inline)) static void
    strain(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state)
    {
      const auto   f         = motion.deformation();
      const Number J_of_step = determinant<dim>(f);
      isochoric::deform<dim>(state.history, f, J_of_step);
      if (rarely(motion.mean_volume))
        state.history[0] *= 1. + motion.volumetric;
      else
        state.history[0] *= J_of_step + (motion.volumetric - motion.trace());
    }

    /** J p */
    template <class Number>
    Number
    pressure_at(const Number &J) const
    {
      return -0.5 * bulk_modulus * (J * J - 1.);
    }

    template <int dim, class Number>
    __attribute__((always_inline)) void
    set_stress(State<dim, Number> &state) const
    {
      state.deviator =
        isochoric::deviator<dim>(isochoric::strain<dim>(state.history));
      for (Number &component : state.deviator)
        component *= shear_modulus;
      state.pressure = pressure_at(state.history[0]);
    }
  };
} // namespace limber

#endif
