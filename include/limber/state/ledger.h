// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_ledger_h
#define limber_state_ledger_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <array>

namespace limber
{
  /**
   * What has happened to energy and momentum since the start, summed step by
   * step on this rank; sum_over_ranks() completes it. Energies in J,
   * impulses in kg m/s.
   */
  template <int dim>
  struct Ledger
  {
    // Kinetic energy that FLIP would have kept and the transfer did not
    double transfer      = 0;
    double boundary_work = 0; // done on the material by the sides of the box
    double load_work     = 0; // by body force formulas and face loads
    double viscous       = 0; // turned into heat by viscosity and damping
    double history       = 0; // removed with volumetric history or tension
    double plastic       = 0; // work on plastic strain
    double friction      = 0; // turned into heat where bodies slide
    double contact       = 0; // lost in impacts where bodies touch

    // Body force formulas, face loads and damping
    dealii::Tensor<1, dim> load_impulse;
    dealii::Tensor<1, dim> gravity_impulse;
    // From each side of the box on the material, in deal.II's order.
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse;

    double                 lost_mass   = 0; // kg
    double                 lost_energy = 0; // kinetic, strain, gravity
    dealii::Tensor<1, dim> lost_momentum;
    unsigned long          lost_points = 0;

    Ledger
    sum_over_ranks(MPI_Comm communicator) const
    {
      static_assert(sizeof(Ledger) % sizeof(double) == 0);
      constexpr int n = (sizeof(Ledger) - sizeof(lost_points)) / sizeof(double);
      Ledger        result;
      MPI_Allreduce(
        &transfer, &result.transfer, n, MPI_DOUBLE, MPI_SUM, communicator);
      result.lost_points =
        dealii::Utilities::MPI::sum(lost_points, communicator);
      return result;
    }
  };
} // namespace limber

#endif
