// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_natural_modes_h
#define limber_fem_natural_modes_h

#include <limber/fem/solid_model.h>

#include <vector>

namespace limber
{
  /** Natural frequencies, and how many motions need no strain. */
  struct NaturalFrequencies
  {
    unsigned int        n_rigid_motions = 0;
    std::vector<double> frequencies; // of the others, Hz, ascending
  };



  /**
   * The lowest natural frequencies of a body at rest, held as the sides of the
   * box hold it: K x = w^2 M x by Lanczos' method on (K + s M)^-1 M (ARPACK),
   * with consistent masses. Throws InputError where the mesh has fewer modes,
   * ComputationError where the iteration does not converge. Collective.
   */
  template <int dim>
  NaturalFrequencies
  natural_frequencies(const SolidModel<dim> &model, const unsigned int count);
} // namespace limber

#endif
