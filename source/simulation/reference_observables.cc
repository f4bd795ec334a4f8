// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/solid_samples.h>
#include <limber/simulation/reference_observables.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

    bool
    is_at_a_place(const ObservableKind kind)
    {
      return kind == ObservableKind::displacement ||
             kind == ObservableKind::velocity ||
             kind == ObservableKind::position ||
             kind == ObservableKind::stress ||
             kind == ObservableKind::pressure ||
             kind == ObservableKind::volume_ratio;
    }



    /**
     * J: laws take the difference of numbers of the size of one, so energies
     * are known to some last bits of the stiffness.
     */
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
    , crossings(problem.observables.size())
  {
    for (const Observable<dim> &observable : problem.observables)
      places.push_back(is_at_a_place(observable.kind) ?
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
    const auto all =
      dealii::Utilities::MPI::all_gather(model.communicator, nearest);
    nearest = *std::min_element(all.begin(), all.end());
    dealii::Point<dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = nearest[d + 1];
    return result;
  }



  template <int dim>
  std::vector<std::string>
  ReferenceObservables<dim>::names() const
  {
    std::vector<std::string> result;
    for (const Observable<dim> &observable : problem.observables)
      result.push_back(observable.name);
    return result;
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
    result.push_back({"energy drift", ""});
    result.push_back({"largest velocity", "m/s"});
    result.push_back({"smallest volume ratio", ""});
    result.push_back({"largest volume ratio", ""});
    for (const Observable<dim> &observable : problem.observables)
      result.push_back({observable.name, unit_of(observable.kind)});
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
                           result.gravitational_energy - motion.boundary_work -
                           motion.load_work;
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
                 std::abs(result.gravitational_energy - gravity_at_start) +
                 std::abs(motion.boundary_work) + std::abs(motion.load_work));
    // Gravity that grows with the load steps has no potential.
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
    const unsigned int axis    = observable.axis;
    const double       sign    = observable.positive ? 1 : -1;
    const auto        &u       = solver.motion().displacement;
    double             largest = -std::numeric_limits<double>::infinity();
    model.for_each_owned_node([&](dealii::Point<dim> place, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        place[d] += u[dofs[d]];
      bool counts = true;
      if (observable.within)
        for (unsigned int d = 0; d < dim; ++d)
          counts &= place[d] >= observable.within->first[d] &&
                    place[d] <= observable.within->second[d];
      if (counts)
        largest = std::max(largest, sign * place[axis]);
    });
    largest = dealii::Utilities::MPI::max(largest, model.communicator);
    return std::isfinite(largest) ? sign * largest : not_known;
  }



  template <int dim>
  std::vector<double>
  ReferenceObservables<dim>::observe(const ReferenceTotals<dim> &totals)
  {
    const SolidMotion<dim> &motion = solver.motion();
    std::vector<double>     values;
    for (unsigned int i = 0; i < problem.observables.size(); ++i)
      {
        const Observable<dim> &observable = problem.observables[i];
        const unsigned int     axis       = observable.axis;
        const double           sign       = observable.positive ? 1 : -1;
        PlaceSample<dim>       here;
        if (is_at_a_place(observable.kind))
          here =
            sample_at(model, places[i], motion.displacement, motion.velocity);

        double value = not_known;
        switch (observable.kind)
          {
            case ObservableKind::displacement:
              value = sign * here.displacement[axis];
              break;
            case ObservableKind::velocity:
              value = sign * here.velocity[axis];
              break;
            case ObservableKind::position:
              value = sign * (places[i][axis] + here.displacement[axis]);
              break;
            case ObservableKind::stress:
              value = sign * here.material.stress[axis][observable.second_axis];
              break;
            case ObservableKind::pressure:
              value = sign * here.material.pressure;
              break;
            case ObservableKind::volume_ratio:
              value = sign * here.material.volume_ratio;
              break;
            case ObservableKind::extreme_coordinate:
              value = extreme(observable);
              break;
            case ObservableKind::kinetic_energy:
              value = totals.kinetic_energy;
              break;
            case ObservableKind::strain_energy:
              value = totals.strain.strain_energy;
              break;
            case ObservableKind::total_energy:
              value = totals.kinetic_energy + totals.strain.strain_energy +
                      totals.gravitational_energy;
              break;
            case ObservableKind::momentum:
              value = sign * totals.momentum[axis];
              break;
            case ObservableKind::centre_of_mass:
              value = sign * totals.mass_moment[axis] / totals.mass;
              break;
            case ObservableKind::reaction_force:
              value = -sign * motion.side_force[observable.side][axis];
              break;
            case ObservableKind::frequency:
              break; // of the columns, below
          }
        values.push_back(value);
      }

    const auto all = names();
    for (unsigned int i = 0; i < values.size(); ++i)
      if (problem.observables[i].kind == ObservableKind::frequency)
        {
          const auto of = std::find(all.begin(),
                                    all.end(),
                                    problem.observables[i].observable);
          crossings[i].add(motion.time, values[of - all.begin()]);
          values[i] = crossings[i].frequency();
        }
    return values;
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
                   motion.load_work,
                   totals.energy_drift,
                   totals.largest_speed,
                   totals.strain.smallest_volume,
                   totals.strain.largest_volume});
    result.insert(result.end(), observed.begin(), observed.end());
    return result;
  }



  template class ReferenceObservables<2>;
  template class ReferenceObservables<3>;
} // namespace limber
