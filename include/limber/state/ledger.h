// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_ledger_h
#define limber_state_ledger_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace limber
{
  /** What an obstacle has done to the material, or the material to it. */
  template <int dim>
  struct ObstacleAction
  {
    dealii::Tensor<1, dim> impulse; // kg m/s, or a force, N
    // About the centre of the obstacle, in the plane the last of three
    dealii::Tensor<1, 3> moment; // kg m^2/s, or N m
  };



  /** What points lose where they touch something, J. */
  struct ContactLoss
  {
    double across = 0; // the surface: that of the impact; all, where they stick
    double along  = 0; // it: heat of friction
  };



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
    double boundary_work = 0; // done on the material by sides and obstacles
    double load_work     = 0; // by body force formulas and face loads
    double viscous       = 0; // turned into heat by viscosity and damping
    double by_steps      = 0; // of these, what semi-implicit steps lose
    double history       = 0; // removed with volumetric history or tension
    double plastic       = 0; // work on plastic strain
    double friction      = 0; // turned into heat where bodies slide
    double contact       = 0; // lost where they touch, or land on a side
    double adaptation    = 0; // removed where points were joined or divided

    // Body force formulas, face loads and damping
    dealii::Tensor<1, dim> load_impulse;
    dealii::Tensor<1, dim> gravity_impulse;
    // From each side of the box on the material, in deal.II's order.
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse;

    // Points that had gone beyond a closed side further than round-off and
    // were put back, each time; and by how many cells altogether
    double put_back = 0, put_back_way = 0;
    // Points of liquids that were put out of obstacles, each time
    double put_out = 0;

    double                 lost_mass   = 0; // kg
    double                 lost_energy = 0; // kinetic, strain, gravity
    dealii::Tensor<1, dim> lost_momentum;
    unsigned long          lost_points = 0;

    // Of each obstacle of the scene on the material
    std::vector<ObstacleAction<dim>> obstacles;

    void
    add(const ContactLoss &loss)
    {
      contact += loss.across;
      friction += loss.along;
    }

    /** Of what is set in motion or stopped at once, and of short waves, J. */
    void
    lose_by_steps(const double energy)
    {
      viscous += energy;
      by_steps += energy;
    }

    Ledger
    sum_over_ranks(MPI_Comm communicator) const
    {
      static_assert(sizeof(lost_points) == sizeof(double));
      static_assert(sizeof(ObstacleAction<dim>) == (dim + 3) * sizeof(double));
      const int n = reinterpret_cast<const double *>(&lost_points) - &transfer;
      Ledger    result;
      MPI_Allreduce(
        &transfer, &result.transfer, n, MPI_DOUBLE, MPI_SUM, communicator);
      result.lost_points =
        dealii::Utilities::MPI::sum(lost_points, communicator);
      result.obstacles.resize(obstacles.size());
      if (!obstacles.empty())
        MPI_Allreduce(obstacles.data(),
                      result.obstacles.data(),
                      obstacles.size() * (dim + 3),
                      MPI_DOUBLE,
                      MPI_SUM,
                      communicator);
      return result;
    }
  };
} // namespace limber

#endif
