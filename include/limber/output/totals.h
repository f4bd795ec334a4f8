// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_totals_h
#define limber_output_totals_h

#include <limber/state/material_body.h>

#include <vector>

/**
 * @file Sums over all points, and how well energy and momentum are conserved.
 * In two dimensions all of them are per metre of thickness.
 */
namespace limber
{
  /** Mass, momentum and energies of a body, summed over its points. */
  template <int dim>
  struct BodyTotals
  {
    double                 mass = 0;                 // kg
    dealii::Tensor<1, dim> momentum;                 // kg m/s
    dealii::Tensor<1, dim> mass_moment;              // sum of m x, kg m
    double                 kinetic_energy       = 0; // J
    double                 strain_energy        = 0; // J
    double                 gravitational_energy = 0; // -sum of m g.x, J

    double
    total_energy() const
    {
      return kinetic_energy + strain_energy + gravitational_energy;
    }

    BodyTotals &
    operator+=(const BodyTotals &other);
  };



  /**
   * Totals of a run at one moment: sums over points, and contributions to the
   * balances of energy and momentum since the start.
   */
  template <int dim>
  struct Totals
  {
    std::vector<BodyTotals<dim>> bodies; // in the order of the scene
    BodyTotals<dim>              all;
    dealii::Tensor<1, dim>       centre_of_mass; // m

    double dissipated            = 0; // by viscosity, J
    double lost_by_steps         = 0; // of these, by semi-implicit steps, J
    double kinetic_action        = 0; // J s, and the next: see Ledger
    double action_of_changes     = 0;
    double removed_with_history  = 0; // with volumetric history or tension, J
    double plastic_work          = 0; // on plastic strain, J
    double friction_heat         = 0; // J
    double contact_loss          = 0; // in impacts on bodies and sides, J
    double removed_by_adaptation = 0; // where points were joined or divided, J
    double removed_by_transfer   = 0; // between points and grid, J
    double boundary_work         = 0; // done on the material, J
    double load_work             = 0; // J
    double energy_drift          = 0; // gain over the scale of energy
    double unexplained_energy    = 0; // that gain, J
    double momentum_error        = 0; // over the scale of momentum
    // Impulse of each side of the box on the material so far, kg m/s
    std::array<dealii::Tensor<1, dim>, 2 * dim> side_impulse;
    std::vector<ObstacleAction<dim>>            obstacles; // the same of each

    double        largest_speed   = 0; // m/s
    double        smallest_volume = 1; // of all J
    double        largest_volume  = 1;
    unsigned long points          = 0;
    unsigned long lost_points     = 0;
    double        put_back        = 0; // points, see Ledger
    double        put_back_way    = 0; // of all of them, cells
    double        put_out         = 0; // points, see Ledger
    unsigned long active_nodes    = 0; // nodes with mass
    unsigned long cells           = 0; // of the mesh
  };



  /** What the balance keeps from one row to the next; plain data, for
   * checkpoints. */
  template <int dim>
  struct BalanceState
  {
    // of the state at the start
    double                 kinetic_energy       = 0;
    double                 strain_energy        = 0;
    double                 gravitational_energy = 0;
    dealii::Tensor<1, dim> momentum;
    double                 mass      = 0;
    double                 stiffness = 0; // sum of mass c^2, J
    // largest so far: J, J, kg m/s
    double energy_scale   = 0;
    double inner_scale    = 0;
    double momentum_scale = 0;
  };



  /**
   * Energy and momentum balance of the present state against the initial one.
   * The ledger has the contributions of sides, obstacles, loads, damping
   * transfers, viscosity, plastic flow, friction, adaptation and lost points;
   * the unexplained rest is
   *
   *   drift = (E - E_0) / scale,
   *   E = T + U + V + transfer + viscous + plastic + history + friction
   *       + contact + adaptation + lost - W_sides - W_loads
   *
   * with T kinetic, U strain and V gravitational energy: the error of time
   * integration and cell crossings. Round-off is subtracted, as is the work of
   * gravity in half a step where points move by the velocity at the end of the
   * step, which belongs to its middle (leapfrog). The scale is the largest T +
   * |U| + |V - V_0| + |W_sides| + |W_loads| so far, and at least what lifts the
   * liquids by 1e-4 of a cell.
   *
   * These terms depend on the frame of the observer. The inner scale does not:
   * T' + |U| with T' relative to the motion of the centre of mass, or |G| with
   * the work G of all outer forces beyond that on this motion, which is T' + U
   * and all losses, minus the initial T' + U; and it is at least a hundredth of
   * the kinetic energy of the motion that outer forces have given the centre of
   * mass, as in free fall.
   */
  template <int dim>
  class Balance
  {
  public:
    /** From the state at the start; collective. */
    explicit Balance(const State<dim> &start);

    /** Continue that of a checkpoint. */
    void
    restore(const BalanceState<dim> &former)
    {
      start = former;
    }

    /** Steps between evaluations of the scales, at most: peaks of energy last
     * longer, as waves cross few cells in so many steps. */
    static constexpr unsigned int longest_interval = 10;

    /** All totals of the present state; collective, a pass over the points. */
    Totals<dim>
    evaluate(const State<dim> &state);

    const BalanceState<dim> &
    state() const
    {
      return start;
    }

  private:
    double
    energy_of_round_off(const State<dim> &state) const;
    void
    balance_energy(const Ledger<dim> &ledger,
                   const State<dim>  &state,
                   Totals<dim>       &totals);
    void
    balance_momentum(const Ledger<dim> &ledger,
                     const double       absolute_momentum,
                     Totals<dim>       &totals);

    BalanceState<dim> start;
  };
} // namespace limber

#endif
