// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_reference_observables_h
#define limber_simulation_reference_observables_h

#include <limber/fem/reference_solver.h>
#include <limber/fem/solid_totals.h>
#include <limber/output/observed_row.h>
#include <limber/output/statistics.h>

#include <string>
#include <vector>

namespace limber
{
  /**
   * Sums over the body and its energy balance, as Totals. A body at rest whose
   * loads begin to grow has no energy yet to compare a drift with: after the
   * first step of central differences the balance is all kinetic energy, dt f.v
   * / 4 with the external forces f, and no work. So where these have the power
   * f.v, a drift of 0.3 dt |f.v| is not resolved. It is a share of 1.2 / n of
   * the energy after n steps of a load that grows evenly; of an unstable motion
   * it grows with the amplitude only.
   */
  template <int dim>
  struct ReferenceTotals
  {
    double                 mass = 0;                 // kg
    dealii::Tensor<1, dim> momentum;                 // kg m/s
    dealii::Tensor<1, dim> mass_moment;              // kg m
    double                 kinetic_energy       = 0; // J
    double                 gravitational_energy = 0; // -m g.x, J
    StrainTotals           strain;
    double                 energy_drift  = 0; // gain over the scale of energy
    double                 unresolved    = 0; // drift that may come and go
    double                 largest_speed = 0; // m/s
  };



  /**
   * Rows of statistics of a reference: those of a run, as far as they make
   * sense, and the observables of the scene. An observable of a material point
   * is evaluated at the very place that the scene names or, outside the body,
   * at the nearest node. Every member function is collective.
   */
  template <int dim>
  class ReferenceObservables
  {
  public:
    ReferenceObservables(const SolidModel<dim>      &model,
                         const ReferenceSolver<dim> &solver);

    std::vector<Column>
    columns() const;

    /** Energies and drift count on from row to row. */
    ReferenceTotals<dim>
    totals();

    /** The observables; frequencies count on one call per row. */
    std::vector<double>
    observe(const ReferenceTotals<dim> &totals);

    std::vector<double>
    row(const ReferenceTotals<dim> &totals,
        const std::vector<double>  &observed) const;

  private:
    bool
    flows() const;
    dealii::Point<dim>
    place_in_body(const dealii::Point<dim> &place) const;
    Seen<dim>
    look(unsigned int number, const ReferenceTotals<dim> &totals) const;
    double
    extreme(const Observable<dim> &observable) const;
    Seen<dim>
    look_within(const Observable<dim> &observable) const;

    const SolidModel<dim>      &model;
    const ReferenceSolver<dim> &solver;
    const Problem<dim>         &problem;
    // Per observable
    std::vector<dealii::Point<dim>> places;
    std::vector<ColumnOverTime>     columns_over_time;
    bool                            has_start       = false;
    double                          energy_at_start = 0, gravity_at_start = 0;
    double                          energy_scale = 0; // J
  };
} // namespace limber

#endif
