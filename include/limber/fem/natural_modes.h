// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_natural_modes_h
#define limber_fem_natural_modes_h

#include <limber/fem/solid_model.h>

#include <vector>

namespace limber
{
  /** Natural frequencies, and the number of rigid (zero-energy) motions. */
  struct NaturalFrequencies
  {
    unsigned int        n_rigid_motions = 0;
    std::vector<double> frequencies; // of the others, Hz, ascending
  };



  /**
   * The lowest natural frequencies of a body at rest, held by the sides of the
   * box: K x = w^2 M x by the Lanczos method with shift and invert, (K + s
   * M)^-1 M (ARPACK), and consistent masses. Throws InputError where the mesh
   * has fewer modes, ComputationError where the iteration does not converge.
   * Collective.
   */
  template <int dim>
  NaturalFrequencies
  natural_frequencies(const SolidModel<dim> &model, const unsigned int count);
} // namespace limber

#endif
