// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_inf_sup_h
#define limber_study_inf_sup_h

#include <string>
#include <vector>

/**
 * @file The numerical inf-sup test of Chapelle and Bathe (1993) for the spaces
 * of the locking treatments: Q1 velocity with one pressure per cell (DGQ0) or
 * with nodal pressure (Q1), on the unit square with n x n cells and no velocity
 * on its boundary.
 */
namespace limber
{
  enum class PressureSpace
  {
    cell, // DGQ0
    node  // Q1
  };

  /** A mesh and its quadrature points. */
  struct InfSupCase
  {
    unsigned int  cells    = 8; // per edge
    PressureSpace pressure = PressureSpace::cell;
    /**
     * Points per cell edge that integrate, evenly placed; 0: Gauss points,
     * exactly.
     */
    unsigned int points = 0;
    /** Probability that a point of the outermost cells is there. */
    double       fill = 1;
    unsigned int seed = 1;
  };

  /** Inf-sup constant beta, and the number of pressure modes without energy. */
  struct InfSup
  {
    double       beta       = 0; // 0 where all modes are zero
    unsigned int zero_modes = 0; // the constant pressure included
  };

  /**
   * beta^2 = smallest nonzero eigenvalue of B S^-1 B^T q = beta^2 M q, with
   * the divergence B, the H1 seminorm S of the velocities and the L2 norm M of
   * the pressures, all summed over the points. Dense, by LAPACK: n = 20 takes
   * a second. Nodes and cells without points do not take part. Throws
   * ComputationError where the points leave a matrix singular.
   */
  InfSup
  inf_sup(const InfSupCase &asked);
} // namespace limber

#endif
