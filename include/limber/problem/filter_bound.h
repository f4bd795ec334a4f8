// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_filter_bound_h
#define limber_problem_filter_bound_h

#include <limber/problem/problem.h>

#include <string>

namespace limber
{
  /**
   * Stability limit of the Courant number C with a transfer that filters the
   * velocity, less a tenth; infinite with any other transfer. Semi-implicit
   * steps have that of shear waves, as measured; explicit ones the following.
   *
   * With the lumped mass M, the consistent mass M_full and the stiffness K, a
   * step of FMPM(k) updates the velocity w that strains and the displacement u
   * by
   *
   *   w' = Q w - dt F M^-1 K u,  u' = u + dt w',
   *   Q = 1 - (1 - A)^k,  F = A^-1 Q,  A = M^-1 M_full,
   *
   * which is stable if dt^2 times the largest eigenvalue of F (1 + Q)^-1 M^-1 K
   * is below 2. XPIC(k) has 1 for F. Nodes at the surface with next to no mass
   * (small cut) have an A near 0, so an F near k, and the stiffness G^2 / N of
   * one point. It is bounded except for linear functions, for which this is the
   * limit of full cells: cut ones have none (doc/theory/kernels.md).
   */
  template <int dim>
  double
  courant_number_of_filter(const Problem<dim> &problem);

  /**
   * What has to change along with a transfer that filters the velocity, as
   * others refuse it: " and 'Transfer order = 4'", or nothing.
   */
  std::string
  entries_of_filter(const Method &method);

  /** Lowers the Courant number of the scene to that limit, and says so. */
  template <int dim>
  void
  obey_filter(Problem<dim> &problem);
} // namespace limber

#endif
