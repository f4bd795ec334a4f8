// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/observables.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    constexpr double       not_known = std::numeric_limits<double>::quiet_NaN();
    constexpr unsigned int not_followed = static_cast<unsigned int>(-1);
    constexpr unsigned int not_one_body = static_cast<unsigned int>(-1);



    bool
    follows_point(const ObservableKind kind)
    {
      switch (kind)
        {
          case ObservableKind::displacement:
          case ObservableKind::velocity:
          case ObservableKind::position:
          case ObservableKind::stress:
          case ObservableKind::pressure:
          case ObservableKind::volume_ratio:
            return true;
          default:
            return false;
        }
    }



    template <int dim>
    bool
    is_within(const PointView<dim>  &points,
              const std::size_t      p,
              const Observable<dim> &observable)
    {
      if (observable.within)
        for (int d = 0; d < dim; ++d)
          if (points.position[d][p] < observable.within->first[d] ||
              points.position[d][p] > observable.within->second[d])
            return false;
      return true;
    }



    /** The largest coordinate times the sign on this rank, half a spacing in.
     */
    template <int dim>
    double
    extreme_of_body(const MaterialBody<dim>    &body,
                    const GridDescription<dim> &grid,
                    const Observable<dim>      &observable)
    {
      const unsigned int   axis    = observable.axis;
      const double         sign    = observable.positive ? 1 : -1;
      const PointView<dim> points  = body.points.view();
      double               largest = -std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < points.size; ++p)
        if (sign * points.position[axis][p] > largest &&
            is_within(points, p, observable))
          largest = sign * points.position[axis][p];
      const double spacing = (grid.upper[axis] - grid.lower[axis]) /
                             grid.cells[axis] /
                             body.description.points_per_cell_edge[axis];
      return largest + 0.5 * spacing;
    }
  } // namespace



  std::string
  unit_of(const ObservableKind kind)
  {
    switch (kind)
      {
        case ObservableKind::displacement:
        case ObservableKind::position:
        case ObservableKind::extreme_coordinate:
        case ObservableKind::centre_of_mass:
          return "m";
        case ObservableKind::velocity:
          return "m/s";
        case ObservableKind::stress:
        case ObservableKind::pressure:
          return "Pa";
        case ObservableKind::kinetic_energy:
        case ObservableKind::strain_energy:
        case ObservableKind::total_energy:
          return "J";
        case ObservableKind::momentum:
          return "kg m/s";
        case ObservableKind::volume_ratio:
          return "";
        case ObservableKind::frequency:
          return "Hz";
        case ObservableKind::reaction_force:
          return "N";
      }
    return "";
  }



  template <int dim>
  Observables<dim>::Observables(const State<dim> &start)
    : problem(start.problem)
  {
    const unsigned int n = problem.observables.size();
    memory.crossings.resize(n);
    memory.tracked_of.assign(n, not_followed);
    for (unsigned int i = 0; i < n; ++i)
      if (follows_point(problem.observables[i].kind))
        memory.tracked_of[i] =
          points.follow_nearest(start,
                                body_index(problem.observables[i].body),
                                problem.observables[i].location);
    decide_what_to_sample();
  }



  template <int dim>
  void
  Observables<dim>::restore(const ObservablesState<dim> &former)
  {
    memory = former;
    points = TrackedPoints<dim>(former.tracked);
    decide_what_to_sample();
  }



  template <int dim>
  void
  Observables<dim>::decide_what_to_sample()
  {
    with_stress.assign(points.points().size(), false);
    for (unsigned int i = 0; i < problem.observables.size(); ++i)
      {
        const ObservableKind kind = problem.observables[i].kind;
        if (kind == ObservableKind::stress ||
            kind == ObservableKind::pressure ||
            kind == ObservableKind::volume_ratio)
          with_stress[memory.tracked_of[i]] = true;
        has_extremes |= kind == ObservableKind::extreme_coordinate;
      }
  }



  template <int dim>
  ObservablesState<dim>
  Observables<dim>::state() const
  {
    ObservablesState<dim> result = memory;
    result.tracked               = points.points();
    return result;
  }



  template <int dim>
  std::vector<std::string>
  Observables<dim>::names() const
  {
    std::vector<std::string> result;
    for (const Observable<dim> &observable : problem.observables)
      result.push_back(observable.name);
    return result;
  }



  template <int dim>
  std::vector<std::string>
  Observables<dim>::units() const
  {
    std::vector<std::string> result;
    for (const Observable<dim> &observable : problem.observables)
      result.push_back(unit_of(observable.kind));
    return result;
  }



  template <int dim>
  unsigned int
  Observables<dim>::body_index(const std::string &name) const
  {
    for (unsigned int b = 0; b < problem.bodies.size(); ++b)
      if (problem.bodies[b].name == name)
        return b;
    // Without a name all bodies are meant; of a point, the only one.
    return name.empty() && problem.bodies.size() == 1 ? 0 : not_one_body;
  }



  template <int dim>
  BodyTotals<dim>
  Observables<dim>::totals_of(const Observable<dim> &observable,
                              const Totals<dim>     &totals) const
  {
    const unsigned int body = body_index(observable.body);
    return body == not_one_body ? totals.all : totals.bodies[body];
  }



  template <int dim>
  void
  Observables<dim>::update_side_forces(const double       time,
                                       const Totals<dim> &totals)
  {
    if (memory.has_row && time > memory.time)
      for (unsigned int s = 0; s < 2 * dim; ++s)
        memory.side_force[s] =
          -(totals.side_impulse[s] - memory.side_impulse[s]) /
          (time - memory.time);
    memory.has_row      = true;
    memory.time         = time;
    memory.side_impulse = totals.side_impulse;
  }



  template <int dim>
  double
  Observables<dim>::value(const Observable<dim>               &observable,
                          const unsigned int                   number,
                          const Totals<dim>                   &totals,
                          const std::vector<PointSample<dim>> &samples) const
  {
    const unsigned int     axis = observable.axis;
    const BodyTotals<dim>  body = totals_of(observable, totals);
    const PointSample<dim> none;
    const unsigned int     t     = memory.tracked_of[number];
    const auto            &point = t == not_followed ? none : samples[t];
    if (t != not_followed && point.lost)
      return not_known;

    switch (observable.kind)
      {
        case ObservableKind::displacement:
          return point.position[axis] - points.points()[t].reference[axis];
        case ObservableKind::velocity:
          return point.velocity[axis];
        case ObservableKind::position:
          return point.position[axis];
        case ObservableKind::stress:
          return point.stress[axis][observable.second_axis];
        case ObservableKind::pressure:
          return point.pressure;
        case ObservableKind::volume_ratio:
          return point.volume_ratio;
        case ObservableKind::kinetic_energy:
          return body.kinetic_energy;
        case ObservableKind::strain_energy:
          return body.strain_energy;
        case ObservableKind::total_energy:
          return body.total_energy();
        case ObservableKind::momentum:
          return body.momentum[axis];
        case ObservableKind::centre_of_mass:
          return body.mass > 0 ? body.mass_moment[axis] / body.mass : not_known;
        case ObservableKind::reaction_force:
          return memory.side_force[observable.side][axis];
        case ObservableKind::extreme_coordinate:
        case ObservableKind::frequency:
          break; // filled in later
      }
    return not_known;
  }



  template <int dim>
  void
  Observables<dim>::fill_extremes(const State<dim>    &state,
                                  std::vector<double> &values) const
  {
    std::vector<double> largest(values.size(),
                                -std::numeric_limits<double>::infinity());
    for (unsigned int i = 0; i < values.size(); ++i)
      {
        const Observable<dim> &observable = problem.observables[i];
        if (observable.kind == ObservableKind::extreme_coordinate)
          for (unsigned int b = 0; b < state.bodies.size(); ++b)
            if (observable.body.empty() || b == body_index(observable.body))
              largest[i] = std::max(largest[i],
                                    extreme_of_body(*state.bodies[b],
                                                    problem.grid,
                                                    observable));
      }
    MPI_Allreduce(MPI_IN_PLACE,
                  largest.data(),
                  largest.size(),
                  MPI_DOUBLE,
                  MPI_MAX,
                  state.grid.communicator);
    for (unsigned int i = 0; i < values.size(); ++i)
      if (std::isfinite(largest[i]))
        values[i] = problem.observables[i].positive ? largest[i] : -largest[i];
  }



  template <int dim>
  std::vector<double>
  Observables<dim>::evaluate(const State<dim> &state, const Totals<dim> &totals)
  {
    update_side_forces(state.time, totals);
    const auto          samples = points.sample(state, with_stress);
    std::vector<double> values(problem.observables.size());
    for (unsigned int i = 0; i < values.size(); ++i)
      {
        const Observable<dim> &observable = problem.observables[i];
        const double           sign       = observable.positive ? 1 : -1;
        values[i] = sign * value(observable, i, totals, samples);
      }
    if (has_extremes)
      fill_extremes(state, values);

    const std::vector<std::string> all_names = names();
    for (unsigned int i = 0; i < values.size(); ++i)
      {
        const Observable<dim> &observable = problem.observables[i];
        if (observable.kind != ObservableKind::frequency)
          continue;
        const unsigned int of =
          std::find(all_names.begin(), all_names.end(), observable.observable) -
          all_names.begin();
        memory.crossings[i].add(state.time, values[of]);
        values[i] = memory.crossings[i].frequency();
      }
    return values;
  }



  template class Observables<2>;
  template class Observables<3>;
} // namespace limber
