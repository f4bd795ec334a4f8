// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_fastest_mode_h
#define limber_fem_fastest_mode_h

#include <limber/fem/solid_model.h>

namespace limber
{
  /**
   * Highest natural frequency of a body, which limits explicit steps: power
   * iteration on M^-1 K with lumped masses and K from differences of forces.
   * Keeps its vector, so that a few iterations suffice after the body has
   * deformed further. Collective.
   */
  template <int dim>
  class FastestMode
  {
  public:
    /** Starts from a highly oscillating vector. */
    explicit FastestMode(const SolidModel<dim> &model);

    /**
     * Circular frequency about @p displacement, 1/s, a lower bound (Rayleigh
     * quotient). Zero where the body has no stiffness; where an element is
     * inverted, the result of the iterations before that.
     */
    double
    circular_frequency(const NodalVector &displacement,
                       const unsigned int n_iterations);

  private:
    const SolidModel<dim> &model;
    NodalVector            mode; // of any length
  };
} // namespace limber

#endif
