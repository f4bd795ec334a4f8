// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_newtonian_fluid_h
#define limber_materials_newtonian_fluid_h

#include <limber/base/law_parameter.h>
#include <limber/materials/law.h>

namespace limber
{
  /**
   * Weakly compressible Newtonian fluid,
   *
   *   sigma = -p 1 + 2 mu dev(D),   J <- J det(f)
   *   p = K (1/J - 1)                     (linear in the density)
   *   p = K/gamma (J^-gamma - 1)          (Tait, Cole)
   *
   * A point keeps the volume ratio J and no deformation gradient; without
   * viscosity it keeps no deviator either. The tension cutoff sets p = 0 and
   * J = 1 where p < 0: the fluid then separates freely, and gains volume.
   */
  template <bool viscous>
  class NewtonianFluid
  {
  public:
    static constexpr const char *name = "newtonian fluid";
    static constexpr const char *text = "viscous, weakly compressible";
    static constexpr bool        takes_pressure = true;
    static constexpr std::array<LawParameter, 6> parameters{
      {law_parameters::density,
       LawParameter{"Bulk modulus",
                    2e9,
                    0,
                    1e300,
                    false,
                    "K, Pa; 'auto' takes the softest one that keeps the Mach "
                    "number below 0.1",
                    "auto"},
       LawParameter{"Viscosity", 0, 0, 1e300, true, "mu, Pa s"},
       LawParameter{"Tension cutoff",
                    0,
                    0,
                    1,
                    true,
                    "whether negative pressure is set to zero, with J = 1",
                    "false|true"},
       LawParameter{"Equation of state",
                    0,
                    0,
                    1,
                    true,
                    "linear: p = K (1/J - 1); tait: p = K/gamma (J^-gamma - 1)",
                    "linear|tait"},
       LawParameter{"Tait exponent", 7, 0, 100, false, "gamma, for tait"}}};

    static constexpr std::array<StateVariable, 0> variables{};

    template <int>
    static constexpr int  n_history    = 1;
    static constexpr bool has_deviator = viscous;
    // Indices in the parameters
    static constexpr unsigned int viscosity_entry = 2, tension_entry = 3;

    static constexpr bool keeps_deviator = false;
    static constexpr bool uses_spin      = true;
    static constexpr bool dissipates     = true;
    static constexpr int  volumetric     = 0;
    static constexpr bool is_elastic     = false;
    static constexpr bool is_plastic     = false;

    template <int dim, class Number>
    using State = PointState<dim, Number, 1>;

    explicit NewtonianFluid(const std::array<double, 6> &values)
      : density(values[0])
      , bulk_modulus(values[1])
      , viscosity(values[viscosity_entry])
      , tension_cutoff(values[tension_entry] != 0)
      // for gamma = 1 both equations of state agree, but the energy of Tait's
      // has a pole
      , tait(values[4] != 0 && values[5] != 1)
      , exponent(values[5])
    {}

    static const char *
    objection(const std::array<double, 6> &)
    {
      return nullptr;
    }

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 6> &values)
    {
      return (values[2] > 0) == viscous;
    }

    double
    dynamic_viscosity() const
    {
      return viscosity;
    }

    bool
    has_constant_wave_speed() const
    {
      return !tait;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      Dissipation<Number> dissipation;
      Number              J = state.history[0] * motion.volume_ratio();
      if (tension_cutoff)
        {
          const Number cut   = larger(J, broadcast<Number>(1.));
          dissipation.cutoff = J > 1. ? volumetric_energy(cut) : Number{};
          J                  = J > 1. ? broadcast<Number>(1.) : J;
        }
      state.history[0] = J;
      state.pressure   = J * pressure(J);

      if constexpr (viscous)
        {
          auto strain = symmetric_deviator<dim, Number>(motion.gradient);
          for (auto &component : strain)
            component *= 1. / motion.step;
          for (unsigned int k = 0; k < strain.size(); ++k)
            state.deviator[k] = 2. * viscosity * J * strain[k];
          dissipation.viscous = motion.step * 2. * viscosity * J *
                                squared_norm<dim, Number>(strain);
        }
      return dissipation;
    }

    template <int dim>
    State<dim, double>
    initialise(const double pressure) const
    {
      const double       ratio = pressure / bulk_modulus;
      State<dim, double> state;
      state.history[0] =
        tait ? std::pow(1 + exponent * ratio, -1 / exponent) : 1 / (1 + ratio);
      state.pressure = state.history[0] * pressure;
      return state;
    }

    template <int dim, class Number>
    Number
    volume_ratio(const State<dim, Number> &state) const
    {
      return state.history[0];
    }

    /**
     * The isotropic part J^(1/dim): a liquid has no elastic deviatoric strain.
     */
    template <int dim>
    double
    stretch_along(const State<dim, double> &state,
                  const std::array<double, dim> &) const
    {
      return std::pow(state.history[0], 1. / dim);
    }

    /** J p, Pa; exact also where the bulk modulus is very large. */
    double
    kirchhoff_pressure(const double J) const
    {
      return tait ? bulk_modulus / exponent * (std::pow(J, 1 - exponent) - J) :
                    bulk_modulus * (1 - J);
    }

    /** -J d(J p)/dJ, Pa. */
    double
    kirchhoff_stiffness(const double J) const
    {
      return tait ? bulk_modulus / exponent *
                      (J + (exponent - 1) * std::pow(J, 1 - exponent)) :
                    bulk_modulus * J;
    }

    /** The energy whose derivative with respect to J is -p. */
    template <class Number>
    Number
    volumetric_energy(const Number &J) const
    {
      if (tait)
        return bulk_modulus / exponent *
               ((power(J, 1 - exponent) - 1.) / (exponent - 1) + J - 1.);
      return bulk_modulus * (J - 1. - logarithm(J));
    }

    template <class Number>
    Number
    volumetric_energy_gain(const Number &from, const Number &to) const
    {
      if (tait)
        return volumetric_energy(to) - volumetric_energy(from);
      return bulk_modulus * (to - from - logarithm_of_ratio(to, from));
    }

    template <int dim, class Number>
    Number
    strain_energy(const State<dim, Number> &state) const
    {
      return volumetric_energy(state.history[0]);
    }

    template <int dim, class Number>
    Number
    wave_speed_squared(const State<dim, Number> &state) const
    {
      const double at_rest = bulk_modulus / density;
      if (tait)
        return at_rest * power(state.history[0], 1 - exponent);
      return broadcast<Number>(at_rest);
    }

    const double            density;           // rho_0, kg/m^3
    static constexpr double shear_modulus = 0; // Pa; viscosity is no modulus

    const double bulk_modulus; // K, Pa
    const double viscosity;    // mu, Pa s
    const bool   tension_cutoff;
    const bool   tait;
    const double exponent; // gamma

  private:
    template <class Number>
    static Number
    power(const Number &a, const double b)
    {
      return each_lane(a, [b](const double x) { return std::pow(x, b); });
    }

    template <class Number>
    Number
    pressure(const Number &J) const
    {
      if (tait)
        return bulk_modulus / exponent * (power(J, -exponent) - 1.);
      return bulk_modulus * (1. - J) / J;
    }
  };
} // namespace limber

#endif
