// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_law_h
#define limber_materials_law_h

#include <limber/base/expected.h>
#include <limber/base/law_parameter.h>
#include <limber/base/pack.h>
#include <limber/base/small_matrix.h>

#include <array>
#include <type_traits>

/**
 * @file The interface of a constitutive law. Laws know numbers only, neither
 * mesh nor points. Everything is written for a type @p Number that is a double
 * in the tests and a pack of doubles (SIMD) in the sweeps.
 *
 * Conventions: stress positive in tension, pressure positive in compression.
 * Points store Kirchhoff stress, tau = J sigma, so that the internal force of a
 * point is (m / rho_0) tau grad N whatever its law. Two dimensions mean plane
 * strain; the deviator is always that of three dimensions.
 */
namespace limber
{
  /** The deformation increment of a point in one step. */
  template <int dim, class Number>
  struct MotionIncrement
  {
    std::array<std::array<Number, dim>, dim> gradient; // dt grad v, no mean
    Number volumetric; // dt div v, averaged by the locking treatment
    double step;       // dt, s
    double square = 0; // c in f = 1 + a + c a^2, see StressSweep
    // Whether J grows by the factor 1 + volumetric, as with implicit pressure
    bool mean_volume = false;

    Number
    trace() const
    {
      Number result = gradient[0][0];
      for (int d = 1; d < dim; ++d)
        result += gradient[d][d];
      return result;
    }

    /**
     * The increment f of the deformation gradient, not averaged by the
     * treatment. In a small-cut cell the strain of a step may exceed one; f
     * then flattens points but its determinant remains positive.
     */
    SmallMatrix<dim, Number>
    deformation() const
    {
      Number size{}; // |a|^2
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          size += gradient[i][j] * gradient[i][j];
      Number curvature = broadcast<Number>(square);
      if (rarely(!all(size < 0.04)))
        // keeps the eigenvalues 1 + x + (c + k) x^2 positive for all real x and
        // any c >= -1/2
        curvature += 0.7 * larger(size - 0.04, broadcast<Number>(0.));
      SmallMatrix<dim, Number> f;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          {
            f[i][j] = gradient[i][0] * gradient[0][j];
            for (int k = 1; k < dim; ++k)
              f[i][j] += gradient[i][k] * gradient[k][j];
            f[i][j] = gradient[i][j] + curvature * f[i][j];
          }
      for (int d = 0; d < dim; ++d)
        f[d][d] += 1.;
      return f;
    }

    /**
     * det(f) to second order in a, with the averaged volumetric increment as
     * its first order part. The second order part is limited to -1/4.
     */
    Number
    volume_ratio() const
    {
      if (mean_volume)
        return 1. + volumetric;
      const Number tr = trace();
      Number       tr_square{}; // tr(a^2)
      for (int i = 0; i < dim; ++i)
        {
          tr_square += gradient[i][i] * gradient[i][i];
          for (int j = 0; j < i; ++j)
            tr_square += 2. * (gradient[i][j] * gradient[j][i]);
        }
      return 1. + volumetric +
             larger(0.5 * tr * tr + (square - 0.5) * tr_square,
                    broadcast<Number>(-0.25));
    }
  };



  /**
   * Stored by rows; for a deformation gradient or a symmetric velocity
   * gradient.
   */
  template <int dim>
  using SquareMatrix = SmallMatrix<dim, double>;



  /**
   * Components of a symmetric deviator: xx, yy, xy (2d) or xx, yy, xy, yz, zx
   * (3d); zz follows from the trace.
   */
  template <int dim, class Number>
  using Deviator = std::array<Number, dim == 2 ? 3 : 5>;



  /** Stress and history variables of a point. */
  template <int dim, class Number, int n_history>
  struct PointState
  {
    Number                        pressure{}; // J p, Pa
    Deviator<dim, Number>         deviator{}; // of J sigma, Pa
    std::array<Number, n_history> history{};
  };



  /** Energy per reference volume that a step has dissipated, J/m^3. */
  template <class Number>
  struct Dissipation
  {
    Number viscous{};
    Number cutoff{};  // volumetric energy removed by a tension cutoff
    Number plastic{}; // work of the stress on plastic strain, never negative
  };



  /** The deviator of the symmetric part of a matrix. */
  template <int dim, class Number>
  inline Deviator<dim, Number>
  symmetric_deviator(const std::array<std::array<Number, dim>, dim> &a)
  {
    if constexpr (dim == 2)
      {
        const Number third = (a[0][0] + a[1][1]) * (1. / 3.);
        return {{a[0][0] - third, a[1][1] - third, 0.5 * (a[0][1] + a[1][0])}};
      }
    else
      {
        const Number third = (a[0][0] + a[1][1] + a[2][2]) * (1. / 3.);
        return {{a[0][0] - third,
                 a[1][1] - third,
                 0.5 * (a[0][1] + a[1][0]),
                 0.5 * (a[1][2] + a[2][1]),
                 0.5 * (a[2][0] + a[0][2])}};
      }
  }



  /** A deviator as a full 3 x 3 matrix, including the zz component. */
  template <int dim>
  inline std::array<std::array<double, 3>, 3>
  full_matrix(const Deviator<dim, double> &s)
  {
    double yz = 0, zx = 0;
    if constexpr (dim == 3)
      {
        yz = s[3];
        zx = s[4];
      }
    return {{{{s[0], s[2], zx}}, {{s[2], s[1], yz}}, {{zx, yz, -s[0] - s[1]}}}};
  }



  /** The dim x dim part of a deviator as a matrix. */
  template <int dim, class Number>
  inline SmallMatrix<dim, Number>
  rows_of(const Deviator<dim, Number> &s)
  {
    if constexpr (dim == 2)
      return {{{{s[0], s[2]}}, {{s[2], s[1]}}}};
    else
      return {{{{s[0], s[2], s[4]}},
               {{s[2], s[1], s[3]}},
               {{s[4], s[3], -(s[0] + s[1])}}}};
  }



  /** s : s, including the zz component, which is not stored. */
  template <int dim, class Number>
  inline Number
  squared_norm(const Deviator<dim, Number> &s)
  {
    const Number zz     = s[0] + s[1];
    Number       result = s[0] * s[0] + s[1] * s[1] + zz * zz;
    for (unsigned int k = 2; k < s.size(); ++k)
      result += 2. * s[k] * s[k];
    return result;
  }



  /**
   * The interface of a law, checked when it enters the list. A law has
   *  - name, its word in the scene; text, one line of help; parameters, the
   *    entries of its section, density first; takes_pressure, whether a body
   *    may have an initial pressure;
   *  - n_history<dim>, number of history variables of a point;
   *  - variables, those of them with names in the scene: the last ones, in this
   *    order;
   *  - has_deviator, whether it has shear stress;
   *  - uses_spin, whether it uses the skew part of the gradient;
   *  - dissipates, whether update() may return dissipated energy;
   *  - objection(), why parameters that are admissible one by one are not
   *    together, as the end of a sentence; null if they are;
   *  - accepts(), whether this variant of a law is for given parameters;
   *  - has_constant_wave_speed(), whether it is the same in every state;
   *  - bulk_modulus, shear_modulus at rest, Pa;
   *  - volumetric, the index of the volumetric variable (J) in the history, or
   *    -1 if that is the pressure itself;
   *  - keeps_deviator, whether it has a deviatoric elastic strain; then also
   *    deviatoric_strain(), set_deviatoric_strain(), deviatoric_energy(): the
   *    strain in a form that may be averaged over points of one configuration
   *    (logarithmic and in the current configuration at finite strain);
   *  - update(): new stress and history for an increment;
   *  - initialise(): the state at rest under a given pressure;
   *  - start_under(), admits(), unless it takes pressure: the state under a
   *    given Cauchy stress, and whether the law admits a state;
   *  - volume_ratio(), stretch_along(), strain_energy(), volumetric_energy(),
   *    wave_speed_squared() of a state; volumetric_energy_gain() from one value
   *    of its volumetric variable to another; dynamic_viscosity();
   *  - is_elastic, whether the stress follows from the deformation alone;
   *  - is_plastic, whether it flows plastically: then update() returns plastic
   *    work, the total strain does not follow from the stress, and it has
   *    is_frictional, whether its strength grows with the pressure.
   *
   * A law that takes pressure or is elastic also has kirchhoff_pressure(),
   * J p, and kirchhoff_stiffness(), -J d(J p)/dJ, at a value of its volumetric
   * variable (implicit pressure).
   *
   * An elastic law also has
   *  - finite_strain: whether J = det F and forces act on the deformed body;
   *    otherwise J = 1 + tr(F - 1) and the geometry is the initial one;
   *  - at_deformation(F, J): the state after F from rest, with the volume
   *    ratio J in its volumetric part;
   *  - deviatoric_wave_speed_squared() of a state, without volumetric part;
   *  - volumetric_stiffness(J) = d^2 U / dJ^2 of the volumetric energy U;
   *  - deviatoric_tangent(state, e): the Oldroyd rate of the Kirchhoff deviator
   *    for the symmetric velocity gradient e, dim x dim.
   */
  template <class Law>
  struct CheckLaw
  {
    static_assert(!std::is_polymorphic_v<Law>,
                  "a law has no virtual function: it is called per point");
    static_assert(Law::has_deviator || !Law::keeps_deviator,
                  "a law that bears no shear keeps none");
    static_assert(Law::volumetric >= -1 &&
                    Law::volumetric < Law::template n_history<2>,
                  "the volumetric variable is one of the history variables");
    static_assert(Law::volumetric <
                    Law::template n_history<2> - int(Law::variables.size()),
                  "the named variables are the last ones of the history");
    static_assert(Law::variables.size() <= max_variables,
                  "more names than 'max_variables' has room for");
    static_assert(!Law::is_plastic || (Law::dissipates && !Law::is_elastic),
                  "what flows dissipates, by plastic work alone");
  };



  /** The index in the history of a law of its named variable @p k. */
  template <int dim, class Law>
  inline constexpr int
  index_of_variable(const int k)
  {
    return Law::template n_history<dim> - int(Law::variables.size()) + k;
  }
} // namespace limber

#endif
