// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_neo_hookean_h
#define limber_materials_neo_hookean_h

#include <limber/base/law_parameter.h>
#include <limber/base/small_matrix.h>
#include <limber/materials/law.h>
#include <limber/materials/symmetric_function.h>

namespace limber
{
  /**
   * Neo-Hookean solid at finite strain with the volumetric and isochoric parts
   * apart (Simo and Hughes, Computational Inelasticity, 9.2):
   *
   *   W = K/2 ((J^2 - 1)/2 - ln J) + G/2 (tr(be) - 3),  be = J^(-2/3) F F^T
   *   J p = -K/2 (J^2 - 1),   dev(tau) = G dev(be)
   *
   * A point keeps J and the part of be that det(be) = 1 leaves free: xx, yy,
   * xy in plane strain; all but zz in three dimensions, where zz follows from
   * the determinant as well. The motion enters through the f by which points
   * move (MotionIncrement); be takes its isochoric part, so averaging the
   * volumetric part leaves be alone and be cannot drift away from det(be) = 1.
   */
  class NeoHookean
  {
  public:
    static constexpr const char *name           = "neo hookean";
    static constexpr const char *text           = "elastic, at any deformation";
    static constexpr bool        takes_pressure = false;
    static constexpr std::array<LawParameter, 3> parameters{
      {law_parameters::density,
       law_parameters::young_modulus,
       law_parameters::poisson_ratio}};

    template <int dim>
    static constexpr int  n_history      = dim == 2 ? 4 : 6;
    static constexpr bool has_deviator   = true;
    static constexpr bool keeps_deviator = true;
    static constexpr bool uses_spin      = true;
    static constexpr bool dissipates     = false;
    static constexpr int  volumetric     = 0;
    static constexpr bool is_elastic     = true;
    static constexpr bool finite_strain  = true;

    template <int dim, class Number>
    using State = PointState<dim, Number, n_history<dim>>;

    explicit NeoHookean(const std::array<double, 3> &values)
      : density(values[0])
      , bulk_modulus(values[1] / (3 * (1 - 2 * values[2])))
      , shear_modulus(values[1] / (2 * (1 + values[2])))
    {}

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
      return false;
    }

    template <int dim, class Number>
    Dissipation<Number>
    update(const MotionIncrement<dim, Number> &motion,
           State<dim, Number>                 &state) const
    {
      const auto f = motion.deformation();

      // be = (det f)^(-2/3) f be f^T
      const Number J_of_step = determinant<dim>(f);
      const Number root      = inverse_cube_root(J_of_step);
      const Number scale     = root * root;
      const auto   be        = isochoric_strain<dim>(state);
      std::array<std::array<Number, dim>, dim> fb;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          {
            fb[i][j] = f[i][0] * be[0][j];
            for (int k = 1; k < dim; ++k)
              fb[i][j] += f[i][k] * be[k][j];
          }
      const auto entry = [&](const int i, const int j) {
        Number result = fb[i][0] * f[j][0];
        for (int k = 1; k < dim; ++k)
          result += fb[i][k] * f[j][k];
        return scale * result;
      };
      state.history[1] = entry(0, 0);
      state.history[2] = entry(1, 1);
      state.history[3] = entry(0, 1);
      if constexpr (dim == 3)
        {
          state.history[4] = entry(1, 2);
          state.history[5] = entry(2, 0);
        }

      state.history[0] *= J_of_step + (motion.volumetric - motion.trace());
      set_stress<dim>(state);
      return {};
    }

    /** be = det(F)^(-2/3) F F^T, whatever J is. */
    template <int dim, class Number>
    State<dim, Number>
    at_deformation(const SmallMatrix<dim, Number> &F, const Number &J) const
    {
      const auto entry = [&](const int i, const int j) {
        Number result = F[i][0] * F[j][0];
        for (int k = 1; k < dim; ++k)
          result += F[i][k] * F[j][k];
        return result;
      };
      const Number       root  = inverse_cube_root(determinant<dim>(F));
      const Number       scale = root * root;
      State<dim, Number> state;
      state.history[0] = J;
      state.history[1] = scale * entry(0, 0);
      state.history[2] = scale * entry(1, 1);
      state.history[3] = scale * entry(0, 1);
      if constexpr (dim == 3)
        {
          state.history[4] = scale * entry(1, 2);
          state.history[5] = scale * entry(2, 0);
        }
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
      const auto   be = isochoric_strain<dim>(state);
      const double twice_shear =
        2. / 3. * shear_modulus * (be[0][0] + be[1][1] + be[2][2]);
      const double mean  = (be[0][0] + be[1][1] + be[2][2]) / 3;
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

    template <int dim>
    State<dim, double>
    initialise(const double pressure) const
    {
      // J p with Cauchy pressure p: K/2 J^2 + p J - K/2 = 0
      const double       ratio = pressure / bulk_modulus;
      State<dim, double> state;
      state.history[0] = std::sqrt(ratio * ratio + 1) - ratio;
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

    template <class Number>
    Number
    volumetric_energy(const Number &J) const
    {
      return 0.5 * bulk_modulus * (0.5 * (J * J - 1.) - logarithm(J));
    }

    /** ln(be) / 2; be has the determinant one, so the trace is zero. */
    template <int dim>
    Deviator<dim, double>
    deviatoric_strain(const State<dim, double> &state) const
    {
      const auto e =
        symmetric_function(isochoric_strain<dim>(state),
                           [](const double x) { return 0.5 * std::log(x); });
      if constexpr (dim == 2)
        return {{e[0][0], e[1][1], e[0][1]}};
      else
        return {{e[0][0], e[1][1], e[0][1], e[1][2], e[2][0]}};
    }

    template <int dim>
    void
    set_deviatoric_strain(State<dim, double>          &state,
                          const Deviator<dim, double> &strain) const
    {
      const auto be =
        symmetric_function(full_matrix<dim>(strain),
                           [](const double x) { return std::exp(2 * x); });
      state.history[1] = be[0][0];
      state.history[2] = be[1][1];
      state.history[3] = be[0][1];
      if constexpr (dim == 3)
        {
          state.history[4] = be[1][2];
          state.history[5] = be[2][0];
        }
      set_stress<dim>(state);
    }

    template <int dim, class Number>
    Number
    deviatoric_energy(const State<dim, Number> &state) const
    {
      const auto be = isochoric_strain<dim>(state);
      return 0.5 * shear_modulus * ((be[0][0] + be[1][1] + be[2][2]) - 3.);
    }

    template <int dim, class Number>
    Number
    strain_energy(const State<dim, Number> &state) const
    {
      return volumetric_energy(state.history[0]) +
             deviatoric_energy<dim>(state);
    }

    /** An upper bound; exact at rest (largest eigenvalue by Gershgorin). */
    template <int dim, class Number>
    Number
    wave_speed_squared(const State<dim, Number> &state) const
    {
      const auto be    = isochoric_strain<dim>(state);
      Number     bound = be[2][2];
      for (int i = 0; i < 3; ++i)
        bound = larger(bound,
                       magnitude(be[i][0]) + magnitude(be[i][1]) +
                         magnitude(be[i][2]));
      const Number J = state.history[0];
      return (0.5 * bulk_modulus * (J * J + 1.) +
              4. / 3. * shear_modulus * bound) *
             (1. / density);
    }

    const double density;       // rho_0, kg/m^3
    const double bulk_modulus;  // K, Pa
    const double shear_modulus; // G, Pa

  private:
    /** be as a full matrix, zz from det(be) = 1. */
    template <int dim, class Number>
    static std::array<std::array<Number, 3>, 3>
    isochoric_strain(const State<dim, Number> &state)
    {
      const auto  &h  = state.history;
      const Number xx = h[1], yy = h[2], xy = h[3];
      Number       yz{}, zx{};
      if constexpr (dim == 3)
        {
          yz = h[4];
          zx = h[5];
        }
      const Number minor = xx * yy - xy * xy;
      const Number zz =
        (1. + xx * yz * yz + yy * zx * zx - 2. * xy * yz * zx) / minor;
      return {{{{xx, xy, zx}}, {{xy, yy, yz}}, {{zx, yz, zz}}}};
    }

    template <int dim, class Number>
    void
    set_stress(State<dim, Number> &state) const
    {
      const auto   be    = isochoric_strain<dim>(state);
      const Number third = (be[0][0] + be[1][1] + be[2][2]) * (1. / 3.);
      state.deviator[0]  = shear_modulus * (be[0][0] - third);
      state.deviator[1]  = shear_modulus * (be[1][1] - third);
      state.deviator[2]  = shear_modulus * be[0][1];
      if constexpr (dim == 3)
        {
          state.deviator[3] = shear_modulus * be[1][2];
          state.deviator[4] = shear_modulus * be[2][0];
        }
      const Number J = state.history[0];
      state.pressure = -0.5 * bulk_modulus * (J * J - 1.);
    }
  };
} // namespace limber

#endif
