// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_fastest_mode_h
#define limber_fem_fastest_mode_h

#include <limber/fem/solid_model.h>

namespace limber
{
  /**
   * The fastest motion of a body, by the power method on M^-1 K: lumped masses,
   * and K from differences of forces. Keeps what it found, so that a few
   * iterations are enough where the body has moved since. Collective.
   */
  template <int dim>
  class FastestMode
  {
  public:
    /** Begins as rough as can be. */
    explicit FastestMode(const SolidModel<dim> &model);

    /**
     * Circular frequency around @p displacement, 1/s, from below. Zero where
     * the body resists no motion; where an element is turned inside out, what
     * the iterations before that found.
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
