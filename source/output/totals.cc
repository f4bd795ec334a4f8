// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/totals.h>
#include <limber/transfer/point_sums.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    // Of a cell: lower bound of the energy scale, so that a liquid at rest does
    // not count as drifting when it is lifted by so little while points settle.
    constexpr double least_lift = 1e-4;

    // Of the energy of the motion that outer forces have given the centre of
    // mass, as gravity in free fall: the least inner scale. Nothing else may be
    // there to compare with, and the fall has an error of its own.
    constexpr double share_of_flight = 0.01;
  } // namespace



  namespace
  {
    /** Sums of one rank or of all, side by side for one reduction. */
    template <int dim>
    struct RowSums
    {
      // mass, kinetic and strain energy, momentum, sum of m x: per body
      static constexpr unsigned int stride = 3 + 2 * dim;

      explicit RowSums(const unsigned int n_bodies)
        : values(n_bodies * stride + 3)
      {}

      double *
      body(const unsigned int b)
      {
        return values.data() + b * stride;
      }

      double &
      absolute_momentum() // sum of m |v|
      {
        return *(values.end() - 3);
      }

      double &
      active_nodes()
      {
        return *(values.end() - 2);
      }

      double &
      points()
      {
        return *(values.end() - 1);
      }

      std::vector<double> values;
      // squared speed, largest J, minus smallest J
      std::array<double, 3> largest{{0, 0, -1e300}};
    };



    template <int dim>
    RowSums<dim>
    sum_own(const State<dim> &state)
    {
      RowSums<dim> sums(state.bodies.size());
      for (unsigned int b = 0; b < state.bodies.size(); ++b)
        {
          const MaterialBody<dim> &body    = *state.bodies[b];
          const PointView<dim>     points  = body.points.view();
          const MotionSums<dim>    motion  = sum_motion(points);
          double *const            of_body = sums.body(b);
          of_body[0]                       = motion.mass;
          of_body[1]                       = motion.kinetic_energy;
          for (int d = 0; d < dim; ++d)
            {
              of_body[3 + d]       = motion.momentum[d];
              of_body[3 + dim + d] = motion.mass_moment[d];
            }
          sums.absolute_momentum() += motion.absolute_momentum;
          sums.largest[0] = std::max(sums.largest[0], motion.squared_speed);
          sums.points() += points.size;

          const StateSummary summary = body.stress->summarize(points);
          of_body[2]                 = summary.strain_energy;
          sums.largest[1] = std::max(sums.largest[1], summary.largest_volume);
          sums.largest[2] = std::max(sums.largest[2], -summary.smallest_volume);
        }
      for (const std::uint32_t node : state.nodes.active_nodes())
        sums.active_nodes() +=
          state.nodes.owns(node) && state.nodes.mass(node) > 0;
      return sums;
    }



    template <int dim>
    RowSums<dim>
    sum_all(const State<dim> &state)
    {
      RowSums<dim> sums = sum_own(state);
      MPI_Allreduce(MPI_IN_PLACE,
                    sums.values.data(),
                    sums.values.size(),
                    MPI_DOUBLE,
                    MPI_SUM,
                    state.grid.communicator);
      MPI_Allreduce(MPI_IN_PLACE,
                    sums.largest.data(),
                    sums.largest.size(),
                    MPI_DOUBLE,
                    MPI_MAX,
                    state.grid.communicator);
      return sums;
    }



    /** Whether points move by the velocity of the end of a step (leapfrog), and
     * not by that of its middle. */
    bool
    moves_by_new_velocity(const Method &method)
    {
      return method.integration == TimeIntegration::explicit_steps &&
             method.order != StressUpdateOrder::usavg;
    }



    /** Kinetic energy relative to the motion of the centre of mass. */
    template <int dim>
    double
    inner_energy(const double                  kinetic_energy,
                 const dealii::Tensor<1, dim> &momentum,
                 const double                  mass)
    {
      return mass > 0 ?
               std::max(0., kinetic_energy - 0.5 * momentum * momentum / mass) :
               0;
    }



    /** Totals that are sums over points, without the balances. */
    template <int dim>
    Totals<dim>
    totals_from(RowSums<dim> &sums, const State<dim> &state)
    {
      Totals<dim> totals;
      totals.bodies.resize(state.bodies.size());
      for (unsigned int b = 0; b < totals.bodies.size(); ++b)
        {
          BodyTotals<dim>    &body = totals.bodies[b];
          const double *const from = sums.body(b);
          body.mass                = from[0];
          body.kinetic_energy      = from[1];
          body.strain_energy       = from[2];
          for (int d = 0; d < dim; ++d)
            {
              body.momentum[d]    = from[3 + d];
              body.mass_moment[d] = from[3 + dim + d];
            }
          body.gravitational_energy =
            -(state.problem.loads.gravity * body.mass_moment);
          totals.all += body;
        }
      if (totals.all.mass > 0)
        totals.centre_of_mass = totals.all.mass_moment / totals.all.mass;
      totals.largest_speed   = std::sqrt(sums.largest[0]);
      totals.largest_volume  = sums.largest[1];
      totals.smallest_volume = -sums.largest[2];
      totals.points          = static_cast<unsigned long>(sums.points() + 0.5);
      totals.active_nodes =
        static_cast<unsigned long>(sums.active_nodes() + 0.5);
      totals.cells = state.grid.triangulation.n_global_active_cells();
      return totals;
    }
  } // namespace



  template <int dim>
  BodyTotals<dim> &
  BodyTotals<dim>::operator+=(const BodyTotals &other)
  {
    mass += other.mass;
    momentum += other.momentum;
    mass_moment += other.mass_moment;
    kinetic_energy += other.kinetic_energy;
    strain_energy += other.strain_energy;
    gravitational_energy += other.gravitational_energy;
    return *this;
  }



  template <int dim>
  Balance<dim>::Balance(const State<dim> &state)
  {
    RowSums<dim>           sums   = sum_all(state);
    const Totals<dim>      totals = totals_from(sums, state);
    const BodyTotals<dim> &all    = totals.all;
    start.kinetic_energy          = all.kinetic_energy;
    start.strain_energy           = all.strain_energy;
    start.gravitational_energy    = all.gravitational_energy;
    start.momentum                = all.momentum;
    start.mass                    = all.mass;

    for (unsigned int b = 0; b < state.bodies.size(); ++b)
      {
        const MaterialBody<dim> &body = *state.bodies[b];
        const double             wave_speed_squared =
          dealii::Utilities::MPI::max(body.stress->wave_speed_squared(
                                        body.points.view()),
                                      state.grid.communicator);
        start.stiffness += totals.bodies[b].mass * wave_speed_squared;
        if (body.description.is_liquid)
          start.energy_scale += least_lift * state.grid.smallest_edge *
                                totals.bodies[b].mass *
                                state.problem.loads.gravity.norm();
      }
    start.inner_scale = start.energy_scale;
  }



  template <int dim>
  Totals<dim>
  Balance<dim>::evaluate(const State<dim> &state)
  {
    RowSums<dim>      sums = sum_all(state);
    const Ledger<dim> ledger =
      state.ledger.sum_over_ranks(state.grid.communicator);
    Totals<dim> totals           = totals_from(sums, state);
    totals.lost_points           = ledger.lost_points;
    totals.put_back              = ledger.put_back;
    totals.put_back_way          = ledger.put_back_way;
    totals.put_out               = ledger.put_out;
    totals.dissipated            = ledger.viscous;
    totals.lost_by_steps         = ledger.by_steps;
    totals.kinetic_action        = ledger.kinetic_action;
    totals.action_of_changes     = ledger.action_of_changes;
    totals.removed_with_history  = ledger.history;
    totals.plastic_work          = ledger.plastic;
    totals.friction_heat         = ledger.friction;
    totals.contact_loss          = ledger.contact;
    totals.removed_by_adaptation = ledger.adaptation;
    totals.boundary_work         = ledger.boundary_work;
    totals.load_work             = ledger.load_work;
    totals.side_impulse          = ledger.side_impulse;
    totals.obstacles             = ledger.obstacles;
    const double round_off       = energy_of_round_off(state);
    start.energy_scale           = std::max(start.energy_scale, round_off);
    start.inner_scale            = std::max(start.inner_scale, round_off);
    balance_energy(ledger, state, totals);
    balance_momentum(ledger, sums.absolute_momentum(), totals);
    return totals;
  }



  // Energy of strains and velocities of the size of round-off, to which each
  // step adds its own: below it a body at rest does not drift. And Newton's
  // method leaves residual forces of that size, which do work where a side
  // moves the body.
  template <int dim>
  double
  Balance<dim>::energy_of_round_off(const State<dim> &state) const
  {
    constexpr double last_bit = std::numeric_limits<double>::epsilon();
    const double     strain   = (64. + state.step) * last_bit;
    const double     of_forces =
      is_solved_by_newton(state.problem.method.integration) ? 16 * last_bit : 0;
    return start.stiffness * std::max(strain * strain, of_forces);
  }



  template <int dim>
  void
  Balance<dim>::balance_energy(const Ledger<dim> &ledger,
                               const State<dim>  &state,
                               Totals<dim>       &totals)
  {
    const BodyTotals<dim> &all = totals.all;
    totals.removed_by_transfer = ledger.transfer;

    // Subtract the initial values first: potentials can be large numbers.
    const double potential_change =
      all.gravitational_energy - start.gravitational_energy;
    const double losses = ledger.transfer + ledger.viscous + ledger.history +
                          ledger.plastic + ledger.friction + ledger.contact +
                          ledger.adaptation;
    const double strain_change = all.strain_energy - start.strain_energy;
    const double gain          = (all.kinetic_energy - start.kinetic_energy) +
                        strain_change + potential_change + losses +
                        ledger.lost_energy - ledger.boundary_work -
                        ledger.load_work;
    start.energy_scale =
      std::max(start.energy_scale,
               all.kinetic_energy + std::abs(all.strain_energy) +
                 std::abs(potential_change) + std::abs(ledger.boundary_work) +
                 std::abs(ledger.load_work));
    const double inner =
      inner_energy(all.kinetic_energy, all.momentum, all.mass);
    const double given =
      inner - inner_energy(start.kinetic_energy, start.momentum, start.mass) +
      strain_change + losses;
    const dealii::Tensor<1, dim> impulse =
      all.momentum + ledger.lost_momentum - start.momentum;
    start.inner_scale =
      std::max({start.inner_scale,
                inner + std::abs(all.strain_energy),
                std::abs(given),
                start.mass > 0 ?
                  share_of_flight * impulse.norm_square() / (2 * start.mass) :
                  0});
    // Round-off of the energies, added up over the steps: of a body at rest
    // that of the potentials is more than all of its motion, of one in flight
    // that of the flight more than all of its vibration.
    const double round_off = (64. + state.step) *
                             std::numeric_limits<double>::epsilon() *
                             (std::abs(all.gravitational_energy) +
                              std::abs(all.strain_energy) + all.kinetic_energy);
    // In a leapfrog scheme velocities belong to the middle of a step and places
    // to its end, which leaves this part of the potential undetermined: a fall
    // from rest would seem to lose 1 / (2 n + 1) of its energy after n steps.
    const double of_half_a_step =
      moves_by_new_velocity(state.problem.method) ?
        0.5 * state.step_size *
          std::abs(state.problem.loads.gravity * impulse) :
        0;
    const double unknown      = round_off + of_half_a_step;
    const double beyond       = gain > unknown  ? gain - unknown :
                                gain < -unknown ? gain + unknown :
                                                  0;
    totals.unexplained_energy = beyond;
    totals.energy_drift =
      start.energy_scale > 0 ? beyond / start.energy_scale : 0;
  }



  template <int dim>
  void
  Balance<dim>::balance_momentum(const Ledger<dim> &ledger,
                                 const double       absolute_momentum,
                                 Totals<dim>       &totals)
  {
    dealii::Tensor<1, dim> unexplained =
      totals.all.momentum - start.momentum + ledger.lost_momentum -
      ledger.gravity_impulse - ledger.load_impulse;
    // Balanced loads have no resultant to scale with, but they strain the body:
    // use the momentum that its strain energy could give it.
    const double of_strain =
      std::sqrt(2 * totals.all.mass * std::abs(totals.all.strain_energy));
    double     scale   = std::max({absolute_momentum,
                                   of_strain,
                                   ledger.gravity_impulse.norm(),
                                   ledger.load_impulse.norm()});
    const auto explain = [&](const dealii::Tensor<1, dim> &impulse) {
      unexplained -= impulse;
      scale = std::max(scale, impulse.norm());
    };
    for (const auto &impulse : ledger.side_impulse)
      explain(impulse);
    for (const auto &obstacle : ledger.obstacles)
      explain(obstacle.impulse);
    start.momentum_scale = std::max(start.momentum_scale, scale);
    totals.momentum_error =
      start.momentum_scale > 0 ? unexplained.norm() / start.momentum_scale : 0;
  }



  template struct BodyTotals<2>;
  template struct BodyTotals<3>;
  template class Balance<2>;
  template class Balance<3>;
} // namespace limber
