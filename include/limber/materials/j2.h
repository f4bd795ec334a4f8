// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_j2_h
#define limber_materials_j2_h

#include <limber/materials/finite_elasticity.h>
#include <limber/materials/radial_return.h>

namespace limber
{
  /**
   * Metal: elastic until the deviator meets the yield surface of von Mises,
   * which grows with the equivalent plastic strain alpha (isotropic hardening;
   * Simo, CMAME 99 (1992) 61; Simo and Hughes, box 9.1):
   *
   *   |s| <= sqrt(2/3) k(alpha),
   *   k = sy + H alpha + Q (1 - exp(-delta alpha))
   *
   * The trial strain takes whatever averages act on the motion; the point
   * returns from it on its own, radially and without a change of volume. What
   * is taken for hardening counts as plastic work as well.
   */
  class J2 : public FiniteElasticity<1>
  {
  public:
    static constexpr const char *name = "j2";
    static constexpr const char *text =
      "elastic and plastic with isotropic hardening (von Mises), at any "
      "deformation";
    static constexpr bool                        takes_pressure = false;
    static constexpr std::array<LawParameter, 7> parameters{
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
                    "delta, dimensionless, of the saturation hardening"}}};
    static constexpr std::array<StateVariable, 1> variables{
      {{"equivalent plastic strain", "", 0}}};

    static constexpr bool dissipates = true;
    static constexpr bool is_elastic = false;
    static constexpr bool is_plastic = true;

    explicit J2(const std::array<double, 7> &values)
      : FiniteElasticity(values[0], values[1], values[2])
      , yield_stress(values[3])
      , hardening(values[4])
      , saturation(values[5])
      , saturation_rate(values[6])
    {}

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 7> &)
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
          const Number flow = flow_beyond(trial, radius, alpha);
          alpha += root * flow;
          result.plastic = trial.flow(flow, state);
        }
      trial.set_stress(state);
      return result;
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

    const double yield_stress;    // sy, Pa
    const double hardening;       // H, Pa
    const double saturation;      // Q, Pa
    const double saturation_rate; // delta

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
     * The length of the plastic strain increment; zero in lanes that stay
     * elastic. Exact for linear hardening. The radius is a concave function of
     * it, so that Newton's method comes from below and cannot overshoot; three
     * sweeps leave less than 1e-8 of the yield stress in steps of 0.2 % with a
     * rate of 200 (tests/unit/materials/plasticity.cc).
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
        for (int sweep = 0; sweep < 3; ++sweep)
          {
            const Number now = alpha + root * result;
            const Number left =
              trial.norm() - stiffness * result - root * yield_strength(now);
            result +=
              larger(left, Number{}) / (stiffness + 2. / 3. * slope(now));
          }
      return excess > 0. ? result : Number{};
    }
  };
} // namespace limber

#endif
