// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_cam_clay_h
#define limber_materials_cam_clay_h

#include <limber/materials/finite_elasticity.h>
#include <limber/materials/radial_return.h>

namespace limber
{
  /**
   * Modified Cam-clay, for clay and other soils that compact under pressure
   * and shear (Roscoe and Burland 1968), at finite strain (Borja and
   * Tamagnini, CMAME 155 (1998) 73). With Kirchhoff stress, and the pressure
   * shifted by an attraction a, the isotropic tension that no state exceeds,
   * x = J p + a:
   *
   *   x = a Je^(-1/kappa)                          elastic, G constant
   *   q^2 / M^2 + x (x - c) <= 0,  c = pc + a      associated flow
   *   c ~ Jp^(-1 / (lambda - kappa))               hardening and softening
   *
   * so that under growing pressure ln J falls by kappa per ln(x) elastically,
   * by lambda in plastic flow. The attraction gives the stress-free state a
   * bulk modulus a / kappa and a defined volume; for a small one the law tends
   * to that of the textbooks. As the tension is bounded at any Je, torn
   * material bears pressure again only when the gap is closed. Softening ends
   * at pc = 0, where the stress-free state is just within the yield surface,
   * so that plastic work is never negative. The yield surface is a circle in
   * the deviatoric plane (as von Mises): M is that of triaxial compression
   * for all Lode angles.
   *
   * J in the history is the elastic volume ratio Je; the total one is
   * Je exp(plastic volume strain).
   */
  class CamClay : public FiniteElasticity<3>
  {
    using Elasticity = FiniteElasticity<3>;

  public:
    static constexpr const char *name = "cam clay";
    static constexpr const char *text =
      "modified Cam-clay: elastic and plastic with a strength and a density "
      "that follow the pressure borne before, for soft soil";
    static constexpr bool                        takes_pressure = false;
    static constexpr std::array<LawParameter, 7> parameters{
      {law_parameters::density,
       LawParameter{"Shear modulus", 1e6, 0, 1e300, false, "G, Pa", "", true},
       LawParameter{"Compression index",
                    0.1,
                    0,
                    10,
                    false,
                    "lambda, dimensionless: fall of ln J per ln of the "
                    "pressure where pressure is larger than ever before; that "
                    "of the books over 1 + e",
                    "",
                    true},
       LawParameter{"Swelling index",
                    0.02,
                    0,
                    10,
                    false,
                    "kappa, dimensionless: the same for pressure that was "
                    "borne before; less than lambda",
                    "",
                    true},
       LawParameter{"Critical state slope",
                    1,
                    0,
                    3,
                    false,
                    "M, dimensionless: q over p in steady shear, 6 sin(phi) / "
                    "(3 - sin(phi)) for the friction angle phi in triaxial "
                    "compression",
                    "",
                    true},
       LawParameter{"Preconsolidation pressure",
                    0,
                    0,
                    1e300,
                    true,
                    "pc, Pa: the largest pressure borne before; 'Initial "
                    "state' may give it by a formula; 0: what an 'Initial "
                    "stress' is on the yield surface with"},
       LawParameter{"Attraction",
                    1000,
                    0,
                    1e300,
                    false,
                    "a, Pa: isotropic tension that is never exceeded, c "
                    "cot(phi) of the steady state; a / kappa is the bulk "
                    "modulus without stress. Small against the pressures of "
                    "the scene"}}};
    static constexpr std::array<StateVariable, 3> variables{
      {{"equivalent plastic strain", "", 0},
       {"preconsolidation pressure", "Pa", 0},
       {"plastic volume strain", "", -1e300}}};

    static constexpr bool dissipates    = true;
    static constexpr bool is_elastic    = false;
    static constexpr bool is_plastic    = true;
    static constexpr bool is_frictional = true;

    explicit CamClay(const std::array<double, 7> &values)
      : Elasticity(values[0],
                   young_modulus(values[6] / values[3], values[1]),
                   poisson_ratio(values[6] / values[3], values[1]))
      , compression(values[2])
      , swelling(values[3])
      , slope(values[4])
      , preconsolidation(values[5])
      , attraction(values[6])
    {}

    static const char *
    objection(const std::array<double, 7> &values)
    {
      if (values[2] <= values[3])
        return "the 'Compression index' is not larger than the 'Swelling "
               "index', so pressure would leave no compaction. "
               "Usually the two are swapped. Give lambda > kappa, for instance "
               "five times as large";
      return nullptr;
    }

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
      const Number former_pressure = state.pressure;
      strain<dim>(motion, state);
      Number                    x = stress_at(state.history[0]);
      const Number              c = larger(variable<dim>(state, 1) + attraction,
                              broadcast<Number>(attraction));
      RadialReturn<dim, Number> trial(state, shear_modulus);
      const Number              q = std::sqrt(1.5) * trial.norm();
      const Number outside        = q * q * (1 / (slope * slope)) + x * (x - c);

      Dissipation<Number> result;
      if (!all(outside <= 0.))
        {
          const Return<Number> reached(*this, x, c, q, trial.stiffness());
          const Number         volume = // plastic, logarithmic
            outside > 0. ? -reached.compaction : Number{};
          const Number beyond = larger(q - reached.q, Number{}) /
                                (std::sqrt(1.5) * trial.stiffness());
          const Number flow = outside > 0. ? beyond : Number{};
          x                 = outside > 0. ? reached.x : x;
          state.history[0] *= exponential(-volume);
          variable<dim>(state, 0) += std::sqrt(2. / 3.) * flow;
          const Number reached_size = larger(reached.c - attraction, Number{});
          variable<dim>(state, 1) =
            outside > 0. ? reached_size : variable<dim>(state, 1);
          variable<dim>(state, 2) += volume;
          const Number work =
            trial.flow(flow, state) -
            (0.5 * (former_pressure + x) - 0.5 * attraction) * volume;
          result.plastic = larger(work, Number{});
        }
      state.pressure = x - attraction;
      trial.set_stress(state);
      return result;
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
      return false;
    }

    /**
     * The state at rest under a pressure up to which it is preconsolidated; a
     * tension has to be below the attraction.
     */
    template <int dim>
    State<dim, double>
    initialise(const double pressure) const
    {
      State<dim, double> state;
      state.history[0] = volume_at(pressure);
      state.history[1] = state.history[2] = 1;
      set_stress<dim>(state);
      state.pressure          = stress_at(state.history[0]) - attraction;
      variable<dim>(state, 1) = std::max(preconsolidation, state.pressure);
      return state;
    }

    /**
     * As FiniteElasticity::start_under(). The preconsolidation pressure is
     * given as a Cauchy stress at the initial volume; if it is zero, it is set
     * such that the initial stress lies on the yield surface.
     */
    template <int dim>
    void
    start_under(State<dim, double>          &state,
                const double                 pressure,
                const Deviator<dim, double> &deviator) const
    {
      state.history[0] = volume_at(pressure);
      this->template set_deviator_of_start<dim>(state, deviator);
      state.pressure = stress_at(state.history[0]) - attraction;
      if (double &borne = variable<dim>(state, 1); borne == 0)
        borne = std::max(needed_size<dim>(state) - attraction, 0.);
      else
        borne *= volume_ratio<dim>(state);
    }

    /** Whether the stress is within the yield surface. */
    template <int dim>
    bool
    admits(const State<dim, double> &state) const
    {
      return needed_size<dim>(state) <=
             (1 + 1e-9) * (variable<dim>(state, 1) + attraction);
    }

    /** The total volume ratio J. */
    template <int dim, class Number>
    Number
    volume_ratio(const State<dim, Number> &state) const
    {
      return state.history[0] * exponential(variable<dim>(state, 2));
    }

    template <class Number>
    Number
    volumetric_energy(const Number &J) const
    {
      const Number log_J = logarithm(J);
      return attraction *
             (swelling * (exponential(-log_J / swelling) - 1.) + log_J);
    }

    template <class Number>
    Number
    volumetric_energy_gain(const Number &from, const Number &to) const
    {
      return volumetric_energy(to) - volumetric_energy(from);
    }

    template <int dim>
    void
    set_deviatoric_strain(State<dim, double>          &state,
                          const Deviator<dim, double> &strain) const
    {
      Elasticity::set_deviatoric_strain<dim>(state, strain);
      state.pressure = stress_at(state.history[0]) - attraction;
    }

    template <int dim, class Number>
    Number
    strain_energy(const State<dim, Number> &state) const
    {
      return volumetric_energy(state.history[0]) +
             this->template deviatoric_energy<dim>(state);
    }

    /**
     * The elastic wave speed, a bound: associated plastic flow only softens.
     */
    template <int dim, class Number>
    Number
    wave_speed_squared(const State<dim, Number> &state) const
    {
      const auto   be = isochoric::strain<dim>(state.history);
      const Number x  = stress_at(state.history[0]);
      return (larger(x * (1 / swelling + 1.) - attraction, Number{}) +
              4. / 3. * shear_modulus * isochoric::largest_eigenvalue(be)) *
             (1. / density);
    }

    const double compression;      // lambda
    const double swelling;         // kappa
    const double slope;            // M
    const double preconsolidation; // at the start, Pa
    const double attraction;       // a, Pa

  private:
    static double
    young_modulus(const double K, const double G)
    {
      return 9 * K * G / (3 * K + G);
    }

    static double
    poisson_ratio(const double K, const double G)
    {
      return (3 * K - 2 * G) / (2 * (3 * K + G));
    }

    template <int dim, class AnyState>
    static auto &
    variable(AnyState &state, const int k)
    {
      return state.history[index_of_variable<dim, CamClay>(k)];
    }

    /** The size c of the yield surface through this stress, Pa. */
    template <int dim>
    double
    needed_size(const State<dim, double> &state) const
    {
      const double x = state.pressure + attraction;
      return x + 1.5 * squared_norm<dim, double>(state.deviator) /
                   (slope * slope * x);
    }

    /**
     * J under a Cauchy pressure p: solves a (Je^(-1/kappa) - 1) = p Je for ln
     * Je by Newton's method from below; NaN for a tension that no volume can
     * bear.
     */
    double
    volume_at(const double pressure) const
    {
      double log_J =
        pressure > 0 ? -swelling * std::log1p(pressure / attraction) : 0;
      double left = 0;
      for (int iteration = 0; iteration < 30; ++iteration)
        {
          const double x = attraction * std::exp(-log_J / swelling),
                       p = pressure * std::exp(log_J);
          left           = x - attraction - p;
          log_J += left / (x / swelling + p);
        }
      return std::abs(left) <= 1e-9 * (attraction + std::abs(pressure)) ?
               std::exp(log_J) :
               std::nan("");
    }

    /** J p + a */
    template <class Number>
    Number
    stress_at(const Number &J) const
    {
      return attraction * exponential(-logarithm(J) / swelling);
    }

    /**
     * Return mapping: the point of the yield surface to which a trial state
     * outside returns, by implicit Euler for the flow rule, in terms of t in
     *
     *   x = c / (1 + t^2),  q = M c t / (1 + t^2),
     *
     * zero for isotropic pressure, one in the critical state. With r = x / c,
     * L = ln(r_trial / r), and h = kappa / lambda,
     *
     *   compaction = kappa (1 - h) L,  c = c_before exp(h L),
     *
     * and as the plastic shear is (q_trial - q) / (3 G I), I the mean of be,
     * its ratio to the compaction 2 t / (M (1 - t^2)) yields for t
     *
     *   (q_trial - q) (1 - t^2) - 6 G I kappa (1 - h) / M t L = 0.
     *
     * The solution lies between one and the t of r_trial; the left hand side
     * is positive below it and negative above: Newton's method safeguarded by
     * bisection. Each lane stops on its own. A state that has softened to
     * pc = 0 keeps c, with h = 0.
     */
    template <class Number>
    class Return
    {
    public:
      Return(const CamClay &law,
             const Number  &x_trial,
             const Number  &former_c,
             const Number  &q_trial,
             const Number  &stiffness) // 2 G I, Pa
        : law(law)
        , q_trial(q_trial)
        , former_c(former_c)
      {
        r_trial = x_trial / former_c;
        // lanes that remain elastic may get any value
        const Number zero{}, one = broadcast<Number>(1.);
        hardening = r_trial < 0.5 ?
                      (former_c > law.attraction ?
                         broadcast<Number>(law.swelling / law.compression) :
                         zero) :
                      broadcast<Number>(law.swelling / law.compression);
        resistance =
          (3 * law.swelling / law.slope) * ((1. - hardening) * stiffness);

        const Number place = square_root(larger(1. / r_trial - 1., zero));
        Number low = place < 1. ? place : one, high = place < 1. ? one : place,
               t          = place;
        Number unfinished = one;
        for (int iteration = 0; iteration < 60 && !all(unfinished <= 0.);
             ++iteration)
          {
            const Number left   = residual(t);
            low                 = left > 0. ? t : low;
            high                = left > 0. ? high : t;
            const Number newton = t - left / derivative;
            Number       next   = 0.5 * (low + high);
            next = newton >= low ? (newton <= high ? newton : next) : next;
            const Number change = magnitude(next - t) - 1e-13 * next;
            t                   = unfinished > 0. ? next : t;
            unfinished = unfinished > 0. ? (change > 0. ? one : zero) : zero;
          }
        residual(t);
        compaction = law.swelling * ((1. - hardening) * distance);
        x          = c / (1. + t * t);
        q          = law.slope * (t * x);
      }

      Number x{}, c{}, q{}, compaction{};

    private:
      /** The residual of the equation at t; sets its derivative. */
      Number
      residual(const Number &t)
      {
        const Number square = t * t, inverse = 1. / (1. + square);
        distance        = logarithm(r_trial * (1. + square));
        c               = former_c * exponential(hardening * distance);
        const Number Mc = law.slope * c, q = Mc * t * inverse;
        const Number q_by_t =
          Mc * inverse * inverse * (1. - square + 2. * hardening * square);
        derivative = -q_by_t * (1. - square) - 2. * t * (q_trial - q) -
                     resistance * (distance + 2. * square * inverse);
        return (q_trial - q) * (1. - square) - resistance * (t * distance);
      }

      const CamClay &law;
      const Number   q_trial, former_c;
      Number         r_trial, hardening, resistance, distance{}, derivative{};
    };
  };
} // namespace limber

#endif
