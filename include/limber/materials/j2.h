// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_j2_h
#define limber_materials_j2_h

#include <limber/materials/finite_elasticity.h>
#include <limber/materials/radial_return.h>

namespace limber
{
  /**
   * J2 plasticity: elastic up to the von Mises yield surface, which grows with
   * the equivalent plastic strain alpha (isotropic hardening; Simo, CMAME 99
   * (1992) 61; Simo and Hughes, box 9.1):
   *
   *   |s| <= sqrt(2/3) k(alpha),
   *   k = sy + H alpha + Q (1 - exp(-delta alpha))
   *
   * With a viscosity the law is viscoplastic (Perzyna's overstress): in shear
   * at the rate g of plastic strain
   *
   *   tau = sy / sqrt(3) + eta g^n
   *
   * (Bingham with n = 1, Herschel-Bulkley otherwise), with an exact yield
   * stress, without regularisation.
   *
   * The trial strain contains the averages of the locking treatment; the
   * radial return, isochoric, is done point by point. Energy stored by
   * hardening and work of the viscosity count as plastic work as well.
   */
  class J2 : public FiniteElasticity<1>
  {
  public:
    static constexpr const char *name = "j2";
    static constexpr const char *text =
      "elastic and plastic with isotropic hardening (von Mises), at any "
      "deformation; with a viscosity a Bingham or Herschel-Bulkley fluid";
    static constexpr bool                        takes_pressure = false;
    static constexpr std::array<LawParameter, 9> parameters{
      {law_parameters::density,
       law_parameters::young_modulus,
       law_parameters::poisson_ratio,
       LawParameter{"Yield stress",
                    1e5,
                    0,
                    1e300,
                    false,
                    "sy, Pa, in uniaxial tension",
                    "",
                    true},
       LawParameter{"Hardening modulus",
                    0,
                    0,
                    1e300,
                    true,
                    "H, Pa: growth of the yield stress per equivalent plastic "
                    "strain"},
       LawParameter{"Saturation hardening",
                    0,
                    0,
                    1e300,
                    true,
                    "Q, Pa: growth of the yield stress that saturates, as Q (1 "
                    "- exp(-delta alpha))"},
       LawParameter{"Saturation rate",
                    10,
                    0,
                    1e300,
                    false,
                    "delta, dimensionless, of the saturation hardening"},
       LawParameter{"Viscosity",
                    0,
                    0,
                    1e300,
                    true,
                    "eta, Pa s^n: shear stress beyond that of yielding per "
                    "rate of plastic shear to the power n"},
       LawParameter{"Flow exponent",
                    1,
                    0.1,
                    1,
                    true,
                    "n, of the viscosity: 1 is Bingham's fluid, less thins "
                    "with the rate (Herschel and Bulkley)"}}};
    static constexpr std::array<StateVariable, 1> variables{
      {{"equivalent plastic strain", "", 0}}};

    static constexpr bool dissipates    = true;
    static constexpr bool is_elastic    = false;
    static constexpr bool is_plastic    = true;
    static constexpr bool is_frictional = false;

    explicit J2(const std::array<double, 9> &values)
      : FiniteElasticity(values[0], values[1], values[2])
      , yield_stress(values[3])
      , hardening(values[4])
      , saturation(values[5])
      , saturation_rate(values[6])
      , viscosity(values[7])
      , inverse_exponent(viscosity > 0 ? 1 / values[8] : 1)
    {}

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 9> &)
    {
      return true;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      strain<dim>(motion, state);
      state.pressure = pressure_at(state.history[0]);

      RadialReturn<dim, Number> trial(state, shear_modulus);
      Number             &alpha  = state.history[index_of_variable<dim, J2>(0)];
      const Number        radius = root * yield_strength(alpha);
      Dissipation<Number> result;
      if (rarely(!all(trial.norm() <= radius)))
        {
          const Number flow =
            viscosity > 0 ? viscous_flow(trial, radius, alpha, motion.step) :
                            flow_beyond(trial, radius, alpha);
          alpha += root * flow;
          result.plastic = trial.flow(flow, state);
        }
      trial.set_stress(state);
      return result;
    }

    /** Whether the stress is within the yield surface. */
    template <int dim>
    bool
    admits(const State<dim, double> &state) const
    {
      const double alpha = state.history[index_of_variable<dim, J2>(0)];
      return std::isfinite(state.pressure) &&
             std::sqrt(squared_norm<dim, double>(state.deviator)) <=
               (1 + 1e-9) * root * yield_strength(alpha);
    }

    /** See DruckerPrager; here there is always some. */
    double
    stiffness_at_apex() const
    {
      return 0;
    }

    /** Whether the law is viscoplastic. */
    bool
    depends_on_rate() const
    {
      return viscosity > 0;
    }

    /** k, Pa, in uniaxial tension. */
    template <class Number>
    Number
    yield_strength(const Number &alpha) const
    {
      Number result = yield_stress + hardening * alpha;
      if (saturation > 0)
        result += saturation * (1. - exponential(-saturation_rate * alpha));
      return result;
    }

    const double yield_stress;     // sy, Pa
    const double hardening;        // H, Pa
    const double saturation;       // Q, Pa
    const double saturation_rate;  // delta
    const double viscosity;        // eta, Pa s^n
    const double inverse_exponent; // 1/n

  private:
    static constexpr double root = 0.816496580927726; // sqrt(2/3)

    /** dk/dalpha */
    template <class Number>
    Number
    slope(const Number &alpha) const
    {
      Number result = broadcast<Number>(hardening);
      if (saturation > 0)
        result +=
          saturation * saturation_rate * exponential(-saturation_rate * alpha);
      return result;
    }

    /**
     * Radial return with hardening: the length of the plastic strain increment;
     * zero in elastic lanes. Exact for linear hardening. As the radius is a
     * concave function of it, Newton's method converges from below without
     * overshoot; three iterations leave less than 1e-8 of the yield stress in
     * steps of 0.2 % with a rate of 200 (tests/unit/materials/plasticity.cc).
     */
    template <int dim, class Number>
    Number
    flow_beyond(const RadialReturn<dim, Number> &trial,
                const Number                    &radius,
                const Number                    &alpha) const
    {
      const Number stiffness = trial.stiffness();
      const Number excess    = trial.norm() - radius;
      Number       result =
        larger(excess, Number{}) / (stiffness + 2. / 3. * slope(alpha));
      if (saturation > 0)
        for (int iteration = 0; iteration < 3; ++iteration)
          {
            const Number now = alpha + root * result;
            const Number left =
              trial.norm() - stiffness * result - root * yield_strength(now);
            result +=
              larger(left, Number{}) / (stiffness + 2. / 3. * slope(now));
          }
      return excess > 0. ? result : Number{};
    }

    /**
     * The same with Perzyna's overstress: y = sqrt(2) eta g^n, the excess of
     * |s| over the radius, drives the flow dt g / sqrt(2); by implicit Euler
     *
     *   y + (2 G I + 2/3 k') flow(y) = excess.
     *
     * The left hand side is convex. y starts from the value at which one of
     * the two terms alone equals the excess, at most twice the solution, and
     * Newton's method converges from above. One iteration is exact for
     * Bingham's fluid.
     */
    template <int dim, class Number>
    Number
    viscous_flow(const RadialReturn<dim, Number> &trial,
                 const Number                    &radius,
                 const Number                    &alpha,
                 const double                     step) const
    {
      constexpr double root_2    = 1.4142135623730951;
      const double     scale     = 1 / (root_2 * viscosity); // g^n = scale y
      const double     rate      = step / root_2;            // flow = rate g
      const Number     stiffness = trial.stiffness();
      const Number     excess    = trial.norm() - radius;
      const auto       power     = [](const Number &x, const double exponent) {
        return exponent == 1 ? x : exponential(exponent * logarithm(x));
      };

      // elastic lanes need some positive number
      const Number target = excess > 0. ? excess : radius;
      const Number hard   = stiffness + 2. / 3. * slope(alpha);
      const Number alone =
        power(target / (rate * hard), 1 / inverse_exponent) * (1 / scale);
      Number    y          = alone < target ? alone : target, flow{};
      const int iterations = inverse_exponent == 1 && saturation == 0 ? 1 : 5;
      for (int iteration = 0; iteration < iterations; ++iteration)
        {
          flow             = rate * power(scale * y, inverse_exponent);
          const Number now = alpha + root * flow;
          const Number left =
            trial.norm() - y - stiffness * flow - root * yield_strength(now);
          const Number steepness = 1. + (stiffness + 2. / 3. * slope(now)) *
                                          (inverse_exponent * flow / y);
          y = larger(y + left / steepness, 1e-3 * y);
        }
      flow = rate * power(scale * y, inverse_exponent);
      return excess > 0. ? flow : Number{};
    }
  };
} // namespace limber

#endif
