// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_state_ledger_h
#define limber_state_ledger_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace limber
{
  /**
   * Impulse and moment (or force and moment) between an obstacle and the
   * material.
   */
  template <int dim>
  struct ObstacleAction
  {
    dealii::Tensor<1, dim> impulse; // kg m/s, or a force, N
    // About the centre of the obstacle; in 2d only the last component
    dealii::Tensor<1, 3> moment; // kg m^2/s, or N m
  };



  /** Energy that points lose in contact, J. */
  struct ContactLoss
  {
    double across = 0; // normal: loss of the impact; total loss if they stick
    double along  = 0; // tangential: heat of friction
  };



  /**
   * The balance of energy and momentum since the start, summed step by step on
   * this rank; sum_over_ranks() completes it. Energies in J, impulses in kg
   * m/s.
   */
  template <int dim>
  struct Ledger
  {
    // Kinetic energy lost by the transfer, compared with FLIP
    double transfer      = 0;
    double boundary_work = 0; // done on the material by sides and obstacles
    double load_work     = 0; // by body force formulas and face loads
    double viscous       = 0; // turned into heat by viscosity and damping
    double by_steps      = 0; // part of viscous: loss of implicit steps
    double history       = 0; // removed with volumetric history or tension
    double plastic       = 0; // work on plastic strain
    double friction      = 0; // dissipated by frictional sliding between bodies
    double contact       = 0; // lost in contact, also in impact on a side
    double adaptation    = 0; // removed by joining and splitting points

    // Of implicit steps, J s: integrals over time of the kinetic energy of the
    // nodes, and of that of the change of their velocities within a step
    double kinetic_action = 0, action_of_changes = 0;

    // Body force formulas, face loads and damping
    dealii::Tensor<1, dim> load_impulse;
    dealii::Tensor<1, dim> gravity_impulse;
    // From each side of the box on the material, in deal.II's order.
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse;

    // How often points beyond a closed side by more than round-off were put
    // back, and the sum of their distances, in cells
    double put_back = 0, put_back_way = 0;
    // How often points of liquids were put out of obstacles
    double put_out = 0;

    double                 lost_mass   = 0; // kg
    double                 lost_energy = 0; // kinetic, strain, gravity
    dealii::Tensor<1, dim> lost_momentum;
    unsigned long          lost_points = 0;

    // By obstacle of the scene: its action on the material
    std::vector<ObstacleAction<dim>> obstacles;

    void
    add(const ContactLoss &loss)
    {
      contact += loss.across;
      friction += loss.along;
    }

    /**
     * Numerical dissipation of semi-implicit steps, J: sudden starts and stops,
     * and short waves.
     */
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
