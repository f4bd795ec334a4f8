// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_radial_return_h
#define limber_materials_radial_return_h

#include <limber/materials/isochoric_strain.h>

namespace limber
{
  /**
   * Radial return from a trial strain to a given length of the deviator,
   * without eigenvalues. The history of the state holds the trial be, its
   * deviator still the old stress. With s = G dev(be) and I = tr(be) / 3,
   * plastic flow of the length d shortens s by 2 G I d (Simo, CMAME 99 (1992)
   * 61); I then follows from det(be) = 1, where Simo keeps it constant.
   */
  template <int dim, class Number>
  class RadialReturn
  {
  public:
    template <class State>
    RadialReturn(const State &state, const double shear_modulus)
      : shear_modulus(shear_modulus)
    {
      const auto be = isochoric::strain<dim>(state.history);
      mean          = isochoric::trace(be) * (1. / 3.);
      strain        = isochoric::deviator<dim>(be);
      length        = square_root(squared_norm<dim, Number>(strain));
    }

    /** |s| */
    Number
    norm() const
    {
      return shear_modulus * length;
    }

    /** 2 G I, by which |s| falls per length of plastic strain. */
    Number
    stiffness() const
    {
      return 2. * shear_modulus * mean;
    }

    /**
     * Apply plastic flow of the length @p flow >= 0 in each lane. Returns the
     * plastic work: the decrease of the elastic energy along the return, at the
     * present strain and with the mean of the stress before and after in its
     * direction, which agrees with the work of the nodal forces to second order
     * in the step.
     */
    template <class State>
    Number
    flow(const Number &flow, State &state)
    {
      // a zero deviator stays zero; avoids 0/0, also of its squares and cubes
      const Number inverse = 1. / larger(length, broadcast<Number>(1e-100));
      const Number before  = product(state.deviator, strain) * inverse;
      const Number share   = larger(1. - 2. * mean * flow * inverse, Number{});
      const Number skew =
        isochoric::determinant_of<dim>(strain) * (inverse * inverse);
      length *= share;
      for (Number &component : strain)
        component *= share;

      // det(strain + I 1) = I^3 - I |strain|^2 / 2 + det(strain) = 1. Its
      // largest root, the only one with a positive definite be, is a convex
      // function of the share, so that the chord between share 1 (no flow) and
      // 0 is not below it; from there Newton's method converges from above. The
      // reciprocal of the slope gets a Newton iteration of its own, as
      // divisions have a long latency; it is never too large.
      const Number half       = 0.5 * length * length;
      const Number rest       = isochoric::determinant_of<dim>(strain) - 1.;
      Number       I          = 1. + share * (mean - 1.);
      Number       slope      = 3. * (I * I) - half;
      Number       reciprocal = 1. / slope;
      Number       step       = broadcast<Number>(1e300);
      // three iterations are enough at small elastic strain
      for (int iteration = 0;
           iteration < 3 || rarely(iteration < 100 && !all(step <= 1e-11 * I));
           ++iteration)
        {
          step = (I * (I * I - half) + rest) * reciprocal;
          I -= step;
          slope = 3. * (I * I) - half;
          reciprocal *= 2. - slope * reciprocal;
        }
      // d(3 G I / 2) = G |strain| d|strain| / 2 I up to the third invariant of
      // be
      const Number excess =
        (3. * (I * I) - 9. * (I * (skew * share))) * reciprocal;
      mean = flow > 0. ? I : mean;
      isochoric::set_entries<dim>(state.history, [&](const int i, const int j) {
        return entry(i, j);
      });
      return 0.5 * flow * excess * larger(before + norm(), Number{});
    }

    /** Set dev(tau) after the return. */
    template <class State>
    void
    set_stress(State &state) const
    {
      for (unsigned int k = 0; k < strain.size(); ++k)
        state.deviator[k] = shear_modulus * strain[k];
    }

  private:
    using Deviator = limber::Deviator<dim, Number>;

    /** The entry (i, j) of be. */
    Number
    entry(const int i, const int j) const
    {
      if (i == j)
        return strain[i] + mean;
      return strain[i + j == 1 ? 2 : i + j == 3 ? 3 : 4];
    }

    static Number
    product(const Deviator &a, const Deviator &b)
    {
      Number result = a[0] * b[0] + a[1] * b[1] + (a[0] + a[1]) * (b[0] + b[1]);
      for (unsigned int k = 2; k < a.size(); ++k)
        result += 2. * (a[k] * b[k]);
      return result;
    }

    const double shear_modulus;
    Deviator     strain; // dev(be)
    Number       mean;   // tr(be) / 3
    Number       length; // |dev(be)|
  };
} // namespace limber

#endif
