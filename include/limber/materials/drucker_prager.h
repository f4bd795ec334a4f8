// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_drucker_prager_h
#define limber_materials_drucker_prager_h

#include <limber/materials/finite_elasticity.h>
#include <limber/materials/radial_return.h>

namespace limber
{
  /**
   * Drucker-Prager plasticity for sand and soil: a shear strength that grows
   * with the pressure (Quart. Appl. Math. 10 (1952) 157),
   *
   *   sqrt(J2) <= k + eta p,
   *
   * fitted to the Mohr-Coulomb strength, t = P sin(phi) + c cos(phi), in plane
   * strain or in triaxial tests. The flow is non-associated: the plastic
   * volume strain is eta_bar (from the dilatancy angle) times sqrt(2) the
   * length of the deviatoric plastic strain. Without dilatancy it is isochoric,
   * and the return map scales the deviator. Stress is Kirchhoff's. The
   * pressure cannot fall below that of the tensile strength: there the
   * material separates, without shear stress, and bears pressure again when
   * the volume that has opened is closed (Tampubolon et al., ACM Trans. Graph.
   * 36 (2017) 105), so that separation does not create volume.
   *
   * With a limit friction angle the slope eta grows with the rate g of plastic
   * shear, as in dense granular flow of grain diameter d and grain density
   * rho_s (mu(I) rheology; Jop, Forterre and Pouliquen, Nature 441 (2006) 727),
   *
   *   eta(I) = eta + (eta_2 - eta) / (I_0 / I + 1),  I = g d / sqrt(p / rho_s).
   *
   * J in the history is the elastic volume ratio; the total one is J (1 +
   * opening) (1 + dilation).
   */
  template <bool dilatant>
  class DruckerPrager : public FiniteElasticity<dilatant ? 3 : 2>
  {
    using Elasticity = FiniteElasticity<dilatant ? 3 : 2>;
    using Elasticity::pressure_at;

  public:
    using Elasticity::bulk_modulus;
    using Elasticity::shear_modulus;
    template <int dim, class Number>
    using State = typename Elasticity::template State<dim, Number>;

    static constexpr const char *name = "drucker prager";
    static constexpr const char *text =
      "elastic and plastic with friction and cohesion, for sand and soil; with "
      "a limit friction angle the rheology mu(I)";
    static constexpr bool                         takes_pressure = false;
    static constexpr std::array<LawParameter, 12> parameters{
      {law_parameters::density,
       law_parameters::young_modulus,
       law_parameters::poisson_ratio,
       LawParameter{"Friction angle",
                    30,
                    0,
                    89,
                    true,
                    "phi, degrees",
                    "",
                    true},
       LawParameter{"Cohesion", 0, 0, 1e300, true, "c, Pa"},
       LawParameter{"Dilatancy angle",
                    0,
                    0,
                    89,
                    true,
                    "psi, degrees, at most phi: how much flow dilates; it does "
                    "so without end"},
       LawParameter{
         "Tensile strength",
         0,
         0,
         1e300,
         true,
         "Pa: mean tension -p at which the material parts; never more than "
         "c cot(phi)"},
       LawParameter{"Fit",
                    0,
                    0,
                    2,
                    true,
                    "under which motion the strength is that of Mohr and "
                    "Coulomb",
                    "plane strain|triaxial compression|triaxial extension"},
       LawParameter{"Limit friction angle",
                    0,
                    0,
                    89,
                    true,
                    "degrees: that of fast flow, in the rheology mu(I); 0: the "
                    "rate does not matter"},
       LawParameter{"Inertial number",
                    0.279,
                    0,
                    1e300,
                    false,
                    "I_0, dimensionless, of mu(I): at which strength has grown "
                    "by half of what it can"},
       LawParameter{"Grain diameter", 1e-3, 0, 1e300, false, "d, m, of mu(I)"},
       LawParameter{"Grain density",
                    2500,
                    0,
                    1e300,
                    false,
                    "rho_s, kg/m^3, of mu(I)"}}};
    static constexpr std::array<StateVariable, dilatant ? 3 : 2> variables{
      []() {
        std::array<StateVariable, dilatant ? 3 : 2> result{
          {{"equivalent plastic strain", "", 0}, {"opening", "", 0}}};
        if constexpr (dilatant)
          result[2] = {"dilation", "", 0};
        return result;
      }()};

    static constexpr bool dissipates    = true;
    static constexpr bool is_elastic    = false;
    static constexpr bool is_plastic    = true;
    static constexpr bool is_frictional = true;

    explicit DruckerPrager(const std::array<double, 12> &values)
      : Elasticity(values[0], values[1], values[2])
      , cone(values)
      , least_pressure(-std::min(values[6], cone.apex_tension))
      , largest_volume(std::sqrt(1 - 2 * least_pressure / bulk_modulus))
      , growth(values[8] > 0 ?
                 Cone(with_angle(values, values[8])).slope - cone.slope :
                 0)
      , flow_time(
          growth > 0 ? values[9] / (values[10] * std::sqrt(values[11])) : 0)
      , friction_modulus(modulus_of_friction(cone.slope + growth))
    {}

    static const char *
    objection(const std::array<double, 12> &values)
    {
      if (values[5] > values[3])
        return "the 'Dilatancy angle' is larger than the 'Friction angle', so "
               "that flow would give energy. Usually the two are swapped. Give "
               "a smaller one, for instance 0";
      if (values[3] == 0 && values[4] == 0)
        return "both 'Friction angle' and 'Cohesion' are zero, so that nothing "
               "bears shear. Usually the cohesion was forgotten. Give one of "
               "them, or use 'Material = newtonian fluid'";
      if (values[8] > 0 && values[8] < values[3])
        return "the 'Limit friction angle' is smaller than the 'Friction "
               "angle', so that flow would weaken with its rate. Usually the "
               "two are swapped";
      if (values[8] > 0 && (values[4] > 0 || values[5] > 0))
        return "a 'Limit friction angle' (mu(I)) goes with neither 'Cohesion' "
               "nor 'Dilatancy angle': it is for loose grains in flow. Set "
               "these to 0, or the limit angle";
      return nullptr;
    }

    /** Whether this variant of the law serves these parameters. */
    static bool
    accepts(const std::array<double, 12> &values)
    {
      return (values[5] > 0) == dilatant;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      const Number former_pressure = state.pressure;
      this->template strain<dim>(motion, state);
      Dissipation<Number> result;
      Number             &J       = state.history[0];
      Number             &opening = variable<dim>(state, 1);
      if (!all(J <= 1.) || !all(opening <= 0.))
        result.plastic = part_or_close(J, opening);
      state.pressure = pressure_at(J);

      RadialReturn<dim, Number> trial(state, shear_modulus);
      const Number              radius = radius_at(state.pressure, opening);
      if (!all(trial.norm() <= radius))
        {
          Number flow = larger(trial.norm() - radius, Number{});
          Number volume{}; // plastic, logarithmic
          if constexpr (dilatant)
            {
              const Number square = J * J;
              const Number rate =
                opening > 0. ? Number{} : broadcast<Number>(cone.dilatancy);
              // Return mapping with dilatancy: J^2 at the end is its trial
              // value over 1 + 2 eta_bar g, so that J p grows by K J^2 eta_bar
              // g / (1 + 2 eta_bar g). With f = excess of sqrt(J2), g solves f
              // = G I g + eta times that growth, which has a solution for any
              // f; the norm |s| is sqrt(2) sqrt(J2)
              const Number f         = std::sqrt(0.5) * flow;
              const Number stiffness = 0.5 * trial.stiffness();
              const Number linear =
                stiffness +
                rate * (bulk_modulus * cone.slope * square - 2. * f);
              const Number plastic =
                2. * f /
                (linear +
                 square_root(linear * linear + 8. * rate * stiffness * f));
              const Number ratio = 1. / square_root(1. + 2. * rate * plastic);
              volume             = -logarithm(ratio);
              J *= ratio;
              variable<dim>(state, 2) =
                (1. + variable<dim>(state, 2)) / ratio - 1.;
              state.pressure = pressure_at(J);
              flow           = std::sqrt(0.5) * plastic;
            }
          else
            {
              if (growth > 0)
                flow -= gain(flow,
                             trial.stiffness(),
                             opening > 0. ? Number{} : state.pressure,
                             motion.step);
              flow /= trial.stiffness();
            }
          variable<dim>(state, 0) += std::sqrt(2. / 3.) * flow;
          const Number work = trial.flow(flow, state) -
                              0.5 * (former_pressure + state.pressure) * volume;
          result.plastic += larger(work, Number{});
        }
      trial.set_stress(state);
      return result;
    }

    /**
     * Whether the stress is within the cone and its pressure above that of the
     * tensile strength; a point that has opened bears no stress.
     */
    template <int dim>
    bool
    admits(const State<dim, double> &state) const
    {
      const double p = state.pressure, opening = variable<dim>(state, 1);
      const double tolerance = 1e-9 * (cone.cohesion + std::abs(p));
      return std::sqrt(squared_norm<dim, double>(state.deviator)) <=
               radius_at(p, opening) + tolerance &&
             p >= least_pressure - tolerance &&
             (opening == 0 || p <= tolerance);
    }

    /** Whether the law is viscoplastic. */
    bool
    depends_on_rate() const
    {
      return growth > 0;
    }

    /**
     * Shear stiffness that tangents keep where there is none, Pa: without
     * cohesion a point has none at zero stress, so that no first correction
     * could be found.
     */
    double
    stiffness_at_apex() const
    {
      return 1e-9 * shear_modulus;
    }

    /** The total volume ratio J, with opening and dilation. */
    template <int dim, class Number>
    Number
    volume_ratio(const State<dim, Number> &state) const
    {
      Number result = state.history[0] * (1. + variable<dim>(state, 1));
      if constexpr (dilatant)
        result *= 1. + variable<dim>(state, 2);
      return result;
    }

    /**
     * The elastic bound plus what plastic flow may add, as strength grows with
     * the pressure: the acoustic tensor of non-associated flow exceeds the
     * elastic one in some directions.
     */
    template <int dim, class Number>
    Number
    wave_speed_squared(const State<dim, Number> &state) const
    {
      return Elasticity::template wave_speed_squared<dim>(state) +
             friction_modulus / this->density;
    }

    /** The yield condition sqrt(J2) <= cohesion + slope p and the dilatancy. */
    struct Cone
    {
      explicit Cone(const std::array<double, 12> &values)
      {
        const double degree = 3.14159265358979323846 / 180;
        const double sine   = std::sin(values[3] * degree),
                     c      = values[4] * std::cos(values[3] * degree),
                     psi    = std::sin(values[5] * degree);
        if (values[7] == 0)
          {
            // plane strain: no plastic strain along the third axis
            dilatancy = psi / std::sqrt(1 + psi * psi / 3);
            const double scale =
              std::sqrt(1 - dilatancy * dilatancy / 3) + dilatancy * sine / 3;
            slope    = sine / scale;
            cohesion = c / scale;
          }
        else
          {
            const double sign  = values[7] == 1 ? -1 : 1;
            const double scale = 6 / (std::sqrt(3.) * (3 + sign * sine));
            slope              = scale * sine;
            cohesion           = scale * c;
            dilatancy          = 6 * psi / (std::sqrt(3.) * (3 + sign * psi));
          }
        apex_tension = slope > 0 ? cohesion / slope : 1e300;
      }

      double slope        = 0; // eta
      double cohesion     = 0; // k, Pa
      double dilatancy    = 0; // eta_bar
      double apex_tension = 0; // at which no shear stress is left, Pa
    };

    const Cone cone;

  private:
    template <int dim, class AnyState>
    static auto &
    variable(AnyState &state, const int k)
    {
      return state.history[index_of_variable<dim, DruckerPrager>(k)];
    }

    /** The largest |s| within the cone; zero where the material has opened. */
    template <class Number>
    Number
    radius_at(const Number &pressure, const Number &opening) const
    {
      const Number radius =
        std::sqrt(2.) * larger(cone.cohesion + cone.slope * pressure, Number{});
      return opening > 0. ? Number{} : radius;
    }

    /**
     * By how much |s| exceeds the rate-independent strength in mu(I), by
     * implicit Euler: with T = @p excess / sqrt(2), D = (eta_2 - eta) p and
     * a = G I dt I_0 sqrt(p / rho_s) / d it is sqrt(2) x,
     *
     *   x (a + T - x) = D (T - x)
     *
     * (Dunatunga and Kamrin, J. Fluid Mech. 779 (2015) 483).
     */
    template <class Number>
    Number
    gain(const Number &excess,
         const Number &stiffness,
         const Number &pressure,
         const double  step) const
    {
      const Number p = larger(pressure, Number{});
      const Number T = std::sqrt(0.5) * excess, D = growth * p;
      const Number a   = (0.5 * flow_time * step) * stiffness * square_root(p);
      const Number sum = larger(a + T + D, broadcast<Number>(1e-100));
      const Number root =
        square_root(larger(sum * sum - 4. * (D * T), Number{}));
      return std::sqrt(2.) * (2. * (D * T)) / (sum + root);
    }

    /** The values with another friction angle. */
    static std::array<double, 12>
    with_angle(std::array<double, 12> values, const double angle)
    {
      values[3] = angle;
      return values;
    }

    /**
     * Tension cutoff: volume beyond that at the tensile strength becomes
     * opening, and opening is closed before the pressure grows. Returns the
     * work dissipated by it.
     */
    template <class Number>
    Number
    part_or_close(Number &J, Number &opening) const
    {
      const Number beyond =
        larger(J * (1 / largest_volume), broadcast<Number>(1.));
      J /= beyond;
      const Number gap      = (1. + opening) * beyond;
      const Number to_close = larger(1. / J, broadcast<Number>(1.));
      const Number closed   = to_close < gap ? to_close : gap;
      J *= closed;
      opening = gap / closed - 1.;
      return -least_pressure * (beyond - 1.);
    }

    /**
     * Maximum of -2 G x^2 + sqrt(2) eta K x over the shear x = m.(s / |s|) n of
     * a plane wave (normal n, polarisation m), |x| <= sqrt(2/3).
     */
    double
    modulus_of_friction(const double eta) const
    {
      const double G = shear_modulus, b = std::sqrt(2.) * eta * bulk_modulus;
      const double x = std::min(b / (4 * G), std::sqrt(2. / 3.));
      return (b - 2 * G * x) * x;
    }

    const double least_pressure;   // of the tensile strength, Pa
    const double largest_volume;   // J there
    const double growth;           // eta_2 - eta; 0: rate-independent
    const double flow_time;        // I_0 / (d sqrt(rho_s)), (Pa s^2)^(-1/2)
    const double friction_modulus; // Pa
  };
} // namespace limber

#endif
