// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_outermost_h
#define limber_output_outermost_h

#include <mpi.h>

#include <utility>
#include <vector>

namespace limber
{
  /** Coordinates (m) of pieces of material on this rank, and their masses, kg.
   */
  using PlacesOfMass = std::vector<std::pair<double, double>>;

  /**
   * The coordinate beyond which @p share, from 0 to 1, of the mass of all ranks
   * lies, to 1e-12 of the range: with 0 the largest one. NaN where there is no
   * mass. Collective.
   */
  double
  outermost(PlacesOfMass places, double share, MPI_Comm communicator);
} // namespace limber

#endif
