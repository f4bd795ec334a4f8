// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/fem/solid_samples.h>
#include <limber/output/outermost.h>
#include <limber/output/region_sums.h>
#include <limber/simulation/reference_observables.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    /** Round-off of the energy, J: laws take differences of numbers of order
     * one, so it is some last bits of the stiffness. */
    template <int dim>
    double
    energy_of_round_off(const SolidModel<dim> &model)
    {
      const double speed = model.element->pressure_wave_speed;
      return 16 * std::numeric_limits<double>::epsilon() * total_mass(model) *
             speed * speed;
    }
  } // namespace



  template <int dim>
  ReferenceObservables<dim>::ReferenceObservables(
    const SolidModel<dim>      &model,
    const ReferenceSolver<dim> &solver)
    : model(model)
    , solver(solver)
    , problem(model.problem)
    , columns_over_time(problem.observables.size())
  {
    for (const Observable<dim> &observable : problem.observables)
      places.push_back(looks_at_place(observable) ?
                         place_in_body(observable.location) :
                         dealii::Point<dim>());
  }



  template <int dim>
  dealii::Point<dim>
  ReferenceObservables<dim>::place_in_body(
    const dealii::Point<dim> &place) const
  {
    const auto &u = solver.motion().displacement;
    if (sample_at(model, place, u, u).inside)
      return place;
    // distance, then coordinates: the same node on any number of ranks
    std::array<double, dim + 1> nearest;
    nearest.fill(std::numeric_limits<double>::infinity());
    model.for_each_owned_node(
      [&](const dealii::Point<dim> &node, const auto &) {
        std::array<double, dim + 1> candidate;
        candidate[0] = node.distance(place);
        for (unsigned int d = 0; d < dim; ++d)
          candidate[d + 1] = node[d];
        nearest = std::min(nearest, candidate);
      });
    std::vector<std::array<double, dim + 1>> all = {nearest};
    unite(all, model.communicator);
    nearest = *std::min_element(all.begin(), all.end());
    dealii::Point<dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = nearest[d + 1];
    return result;
  }



  template <int dim>
  bool
  ReferenceObservables<dim>::flows() const
  {
    return model.element->n_memory() > 0;
  }



  template <int dim>
  std::vector<Column>
  ReferenceObservables<dim>::columns() const
  {
    std::vector<Column> result = {{"step", ""},
                                  {"time", "s"},
                                  {"step size", "s"},
                                  {"elements", ""},
                                  {"nodes", ""},
                                  {"mass", "kg"}};
    for (int d = 0; d < dim; ++d)
      result.push_back({std::string("momentum ") + "xyz"[d], "kg m/s"});
    for (const char *const name : {"kinetic energy",
                                   "strain energy",
                                   "gravitational energy",
                                   "boundary work",
                                   "load work"})
      result.push_back({name, "J"});
    if (flows())
      result.push_back({"plastic work", "J"});
    result.push_back({"energy drift", ""});
    result.push_back({"largest velocity", "m/s"});
    result.push_back({"smallest volume ratio", ""});
    result.push_back({"largest volume ratio", ""});
    for (const Observable<dim> &observable : problem.observables)
      result.push_back({observable.name, observable.unit});
    return result;
  }



  template <int dim>
  ReferenceTotals<dim>
  ReferenceObservables<dim>::totals()
  {
    const SolidMotion<dim> &motion = solver.motion();
    ReferenceTotals<dim>    result;
    result.mass                 = total_mass(model);
    result.momentum             = momentum(model, motion.velocity);
    result.mass_moment          = mass_moment(model, motion.displacement);
    result.kinetic_energy       = kinetic_energy(model, motion.velocity);
    result.gravitational_energy = -(problem.loads.gravity * result.mass_moment);
    result.strain               = strain_totals(model, motion.displacement);
    result.largest_speed        = largest_speed(model, motion.velocity);

    const double balance = result.kinetic_energy + result.strain.strain_energy +
                           result.gravitational_energy + motion.plastic_work -
                           motion.boundary_work - motion.load_work;
    if (!has_start)
      {
        has_start        = true;
        energy_at_start  = balance;
        gravity_at_start = result.gravitational_energy;
        energy_scale     = energy_of_round_off(model);
      }
    energy_scale =
      std::max(energy_scale,
               result.kinetic_energy + result.strain.strain_energy +
                 motion.plastic_work +
                 std::abs(result.gravitational_energy - gravity_at_start) +
                 std::abs(motion.boundary_work) + std::abs(motion.load_work));
    // Gravity that grows with the load steps has no potential, so no drift.
    result.energy_drift =
      problem.reference.method == ReferenceMethod::quasi_static ?
        not_known :
        (balance - energy_at_start) / energy_scale;
    constexpr double share_of_a_step = 0.3; // a quarter, and a margin
    result.unresolved                = share_of_a_step * motion.step_size *
                        std::abs(motion.outer_power) / energy_scale;
    return result;
  }



  template <int dim>
  double
  ReferenceObservables<dim>::extreme(const Observable<dim> &observable) const
  {
    const unsigned int axis = observable.axis;
    const double       sign = observable.positive ? 1 : -1;
    const auto        &u    = solver.motion().displacement;
    if (observable.share_beyond > 0)
      {
        PlacesOfMass places;
        for (const QuadratureSample<dim> &part :
             quadrature_samples(model, u, solver.motion().velocity))
          if (const auto place = part.start + part.here.displacement;
              observable.is_within(place))
            places.emplace_back(sign * place[axis],
                                model.element->density * part.volume);
        return outermost(std::move(places),
                         observable.share_beyond,
                         model.communicator);
      }
    double largest = -std::numeric_limits<double>::infinity();
    model.for_each_owned_node([&](dealii::Point<dim> place, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        place[d] += u[dofs[d]];
      if (observable.is_within(place))
        largest = std::max(largest, sign * place[axis]);
    });
    largest = dealii::Utilities::MPI::max(largest, model.communicator);
    return std::isfinite(largest) ? largest : not_known;
  }



  template <int dim>
  Seen<dim>
  ReferenceObservables<dim>::look_within(
    const Observable<dim> &observable) const
  {
    RegionSums<dim>         sums;
    const SolidMotion<dim> &motion = solver.motion();
    for (const QuadratureSample<dim> &part :
         quadrature_samples(model, motion.displacement, motion.velocity))
      if (observable.is_within(part.start + part.here.displacement))
        sums.add(model.element->density * part.volume,
                 part.here.velocity,
                 part.here.material.volume_ratio * part.volume,
                 part.here.material.pressure,
                 part.here.material.stress);
    sums.sum_over_ranks(model.communicator);
    return sums.seen();
  }



  template <int dim>
  Seen<dim>
  ReferenceObservables<dim>::look(const unsigned int          number,
                                  const ReferenceTotals<dim> &totals) const
  {
    const Observable<dim>  &observable = problem.observables[number];
    const SolidMotion<dim> &motion     = solver.motion();
    Seen<dim>               seen;
    switch (observable.kind->looks_at)
      {
        case ObservedPart::place:
        case ObservedPart::material:
          {
            const PlaceSample<dim> here = sample_at(model,
                                                    places[number],
                                                    motion.displacement,
                                                    motion.velocity);
            seen.displacement           = here.displacement;
            seen.position               = places[number] + here.displacement;
            seen.velocity               = here.velocity;
            seen.stress                 = here.material.stress;
            seen.pressure               = here.material.pressure;
            seen.volume_ratio           = here.material.volume_ratio;
            if (flows())
              seen.variable = here.material.variables[observable.variable];
            return seen;
          }
        case ObservedPart::region:
        case ObservedPart::region_material:
          return look_within(observable);
        case ObservedPart::body:
          seen.mass             = totals.mass;
          seen.momentum         = totals.momentum;
          seen.mass_moment      = totals.mass_moment;
          seen.kinetic_energy   = totals.kinetic_energy;
          seen.strain_energy    = totals.strain.strain_energy;
          seen.potential_energy = totals.gravitational_energy;
          return seen;
        case ObservedPart::largest:
          seen.variable = totals.strain.largest_variable[observable.variable];
          return seen;
        case ObservedPart::extent:
          seen.extent = extreme(observable);
          return seen;
        case ObservedPart::side:
          seen.force = -motion.side_force[observable.side];
          return seen;
        case ObservedPart::obstacle: // not in references, whose scenes have no
                                     // obstacles
        case ObservedPart::column:
          break;
      }
    return seen;
  }



  template <int dim>
  std::vector<double>
  ReferenceObservables<dim>::observe(const ReferenceTotals<dim> &totals)
  {
    return observed_row(problem.observables,
                        solver.motion().time,
                        columns_over_time,
                        [&](const unsigned int i) { return look(i, totals); });
  }



  template <int dim>
  std::vector<double>
  ReferenceObservables<dim>::row(const ReferenceTotals<dim> &totals,
                                 const std::vector<double>  &observed) const
  {
    const SolidMotion<dim> &motion = solver.motion();
    std::vector<double>     result = {double(motion.step),
                                      motion.time,
                                      motion.step_size,
                                      double(model.mesh->n_global_active_cells()),
                                      double(model.dof_handler.n_dofs() / dim),
                                      totals.mass};
    for (int d = 0; d < dim; ++d)
      result.push_back(totals.momentum[d]);
    result.insert(result.end(),
                  {totals.kinetic_energy,
                   totals.strain.strain_energy,
                   totals.gravitational_energy,
                   motion.boundary_work,
                   motion.load_work});
    if (flows())
      result.push_back(motion.plastic_work);
    result.insert(result.end(),
                  {totals.energy_drift,
                   totals.largest_speed,
                   totals.strain.smallest_volume,
                   totals.strain.largest_volume});
    result.insert(result.end(), observed.begin(), observed.end());
    return result;
  }



  template class ReferenceObservables<2>;
  template class ReferenceObservables<3>;
} // namespace limber
