// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_time_generalised_alpha_h
#define limber_time_generalised_alpha_h

namespace limber
{
  /**
   * A step of the generalised-alpha method (J. Chung, G. M. Hulbert, J. Appl.
   * Mech. 60, 1993, doi 10.1115/1.2900803) for the displacement u in it, with
   * the forces F0 and F1 of its ends (doc/theory/implicit_steps.md):
   *
   *   M ((1 - am) a1 + am a0) = (1 - af) F1 + af F0
   *   u  = dt v0 + dt^2 ((1/2 - beta) a0 + beta a1)
   *   v1 = v0 + dt ((1 - gamma) a0 + gamma a1)
   *
   * All four parameters follow from the spectral radius r at infinite
   * frequency, the factor by which a step multiplies much faster vibrations:
   *
   *   am = (2 r - 1)/(r + 1), af = r/(r + 1),
   *   beta = 1/(r + 1)^2, gamma = 1/2 + (1 - r)/(1 + r).
   *
   * With r = 1 it is Newmark's trapezoidal rule, a0 has no effect, and all of
   * the following is that rule to the last bit.
   */
  class GeneralisedAlpha
  {
  public:
    /** @p radius: r, from 0 to 1. */
    explicit GeneralisedAlpha(const double radius)
      : r(radius)
      , s(1 + radius)
    {}

    /** Whether a0 has an effect: r < 1. */
    bool
    needs_acceleration() const
    {
      return r < 1;
    }

    /** Factor of F0 relative to that of F1: af/(1 - af) = r. */
    double
    share_of_beginning() const
    {
      return r;
    }

    /** Coefficient c in F1 + r F0 = c m/dt^2 (u - ahead()). */
    double
    inertia() const
    {
      return (2 - r) * (s * s);
    }

    /** The u of a node without forces, m. */
    double
    ahead(const double v0, const double a0, const double dt) const
    {
      return dt * v0 + dt * dt * (0.5 - 1 / (s * (2 - r))) * a0;
    }

    /** v1, m/s. */
    double
    velocity(const double u,
             const double v0,
             const double a0,
             const double dt) const
    {
      const double ratio = s * (3 - r) / 2; // gamma/beta
      return ratio * u / dt + (1 - ratio) * v0 + dt * (1 - ratio / 2) * a0;
    }

    /** a1, m/s^2. */
    double
    acceleration(const double u,
                 const double v0,
                 const double a0,
                 const double dt) const
    {
      return s * s * (u / dt - v0) / dt - (s * s / 2 - 1) * a0;
    }

  private:
    const double r, s;
  };
} // namespace limber

#endif
