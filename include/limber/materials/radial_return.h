// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_radial_return_h
#define limber_materials_radial_return_h

#include <limber/materials/isochoric_strain.h>

namespace limber
{
  /**
   * From a trial strain back to a given length of the deviator, in its own
   * direction: no eigenvalues are needed. The trial be is in the history of the
   * state, the stress of before in its deviator. With s = G dev(be) and I =
   * tr(be) / 3, plastic flow of the length d shortens s by 2 G I d (Simo,
   * CMAME 99 (1992) 61); I follows from det(be) = 1 afterwards, where Simo
   * keeps it.
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

    /** 2 G I, by which |s| falls with the length of the plastic strain. */
    Number
    stiffness() const
    {
      return 2. * shear_modulus * mean;
    }

    /**
     * Let the lanes flow by @p flow, the length of a plastic strain, zero or
     * positive. Returns the work on it: what the elastic energy falls by along
     * the return at the present strain, taken with the mean of the stress in
     * its direction before and after, which is what the motion of the nodes
     * gives to second order in the step.
     */
    template <class State>
    Number
    flow(const Number &flow, State &state)
    {
      // what has no length keeps it, and its cubes and squares stay numbers
      const Number inverse = 1. / larger(length, broadcast<Number>(1e-100));
      const Number before  = product(state.deviator, strain) * inverse;
      const Number share   = larger(1. - 2. * mean * flow * inverse, Number{});
      const Number skew =
        isochoric::determinant_of<dim>(strain) * (inverse * inverse);
      length *= share;
      for (Number &component : strain)
        component *= share;

      // det(strain + I 1) = I^3 - I |strain|^2 / 2 + det(strain) = 1. Its
      // largest root, where alone be is positive definite, is a convex function
      // of the share, so that the chord from no flow to no strain is not below
      // it; from there Newton's method comes down to it. The reciprocal of the
      // slope follows by a step of Newton's method of its own, as divisions
      // wait for each other; it is never too large.
      const Number half       = 0.5 * length * length;
      const Number rest       = isochoric::determinant_of<dim>(strain) - 1.;
      Number       I          = 1. + share * (mean - 1.);
      Number       slope      = 3. * (I * I) - half;
      Number       reciprocal = 1. / slope;
      Number       step       = broadcast<Number>(1e300);
      // three are enough where elastic strain is small
      for (int sweep = 0;
           sweep < 3 || rarely(sweep < 100 && !all(step <= 1e-11 * I));
           ++sweep)
        {
          step = (I * (I * I - half) + rest) * reciprocal;
          I -= step;
          slope = 3. * (I * I) - half;
          reciprocal *= 2. - slope * reciprocal;
        }
      // d(3 G I / 2) = G |strain| d|strain| / 2 I but for the skew of be
      const Number excess =
        (3. * (I * I) - 9. * (I * (skew * share))) * reciprocal;
      mean = flow > 0. ? I : mean;
      isochoric::set_entries<dim>(state.history, [&](const int i, const int j) {
        return entry(i, j);
      });
      return 0.5 * flow * excess * larger(before + norm(), Number{});
    }

    /** dev(tau) of what has been reached. */
    template <class State>
    void
    set_stress(State &state) const
    {
      for (unsigned int k = 0; k < strain.size(); ++k)
        state.deviator[k] = shear_modulus * strain[k];
    }

  private:
    using Deviator = limber::Deviator<dim, Number>;

    /** be, where it is stored. */
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
