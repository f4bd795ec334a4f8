// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <limber/output/observables.h>
#include <limber/output/outermost.h>
#include <limber/state/stretch.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    constexpr unsigned int not_followed = static_cast<unsigned int>(-1);
    constexpr unsigned int not_one_body = static_cast<unsigned int>(-1);



    template <int dim>
    bool
    is_within(const PointView<dim>  &points,
              const std::size_t      p,
              const Observable<dim> &observable)
    {
      dealii::Point<dim> place;
      for (int d = 0; d < dim; ++d)
        place[d] = points.position[d][p];
      return observable.is_within(place);
    }



    /** Distance of the outermost points from the end of a cell at the start, as
     * a share of its edge. */
    template <int dim>
    double
    depth_of_points(const Body<dim> &body, const unsigned int axis)
    {
      const unsigned int n = body.points_per_cell_edge[axis];
      return body.placement == Placement::gauss ?
               dealii::QGauss<1>(n).point(0)[0] :
               0.5 / n;
    }



    /**
     * Where points end in the direction of an extreme, on this rank: the
     * coordinate of the centre times the sign and half an edge, stretched as
     * the material is.
     */
    template <int dim>
    class EndsOfPoints
    {
    public:
      EndsOfPoints(const MaterialBody<dim>    &body,
                   const GridDescription<dim> &grid,
                   const Observable<dim>      &observable)
        : body(body)
        , observable(observable)
        , points(body.points.view())
        , half(grid.edge(observable.axis) *
               depth_of_points(body.description, observable.axis))
      {
        direction[observable.axis] = 1;
      }

      /** The largest one; minus infinity if there is none. */
      double
      largest() const
      {
        // further behind the foremost one none is looked at: stretching takes
        // longer to find than all the rest
        constexpr double largest_stretch = 10;
        double           result = -std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < points.size; ++p)
          if (centre(p) + largest_stretch * half_edge(p) > result &&
              is_within(points, p, observable))
            result = std::max(result, end(p));
        return result;
      }

      /** Append all of them, with their masses. */
      void
      append_to(PlacesOfMass &places) const
      {
        for (std::size_t p = 0; p < points.size; ++p)
          if (is_within(points, p, observable))
            places.emplace_back(end(p), points.mass[p]);
      }

    private:
      double
      centre(const std::size_t p) const
      {
        const double x = points.position[observable.axis][p];
        return observable.positive ? x : -x;
      }

      double
      half_edge(const std::size_t p) const
      {
        if (const double *const edge = points.edge[observable.axis])
          return 0.5 * edge[p];
        return body.points.has_size_classes() ?
                 half / (1u << body.points.size_class(p)) :
                 half;
      }

      double
      end(const std::size_t p) const
      {
        return centre(p) +
               half_edge(p) * stretch_along(body, points, p, direction);
      }

      const MaterialBody<dim> &body;
      const Observable<dim>   &observable;
      const PointView<dim>     points;
      const double             half; // edge at the start, m
      dealii::Tensor<1, dim>   direction;
    };



    /** On this rank. */
    template <int dim>
    double
    largest_variable(const MaterialBody<dim> &body, const unsigned int k)
    {
      const double *const values  = body.variable(k);
      double              largest = -std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < body.points.size(); ++p)
        largest = std::max(largest, values[p]);
      return largest;
    }



    /** Of a point; empty if it has been lost. */
    template <int dim>
    Seen<dim>
    see(const PointSample<dim>   &point,
        const dealii::Point<dim> &start,
        const Observable<dim>    &observable)
    {
      Seen<dim> seen;
      seen.known        = !point.lost;
      seen.position     = point.position;
      seen.displacement = point.position - start;
      seen.velocity     = point.velocity;
      seen.stress       = point.stress;
      seen.pressure     = point.pressure;
      seen.volume_ratio = point.volume_ratio;
      seen.variable     = point.variables[observable.variable];
      return seen;
    }



    template <int dim>
    Seen<dim>
    see(const BodyTotals<dim> &body)
    {
      Seen<dim> seen;
      seen.mass             = body.mass;
      seen.momentum         = body.momentum;
      seen.mass_moment      = body.mass_moment;
      seen.kinetic_energy   = body.kinetic_energy;
      seen.strain_energy    = body.strain_energy;
      seen.potential_energy = body.gravitational_energy;
      return seen;
    }
  } // namespace



  template <int dim>
  Observables<dim>::Observables(const State<dim> &start)
    : problem(start.problem)
  {
    const unsigned int n = problem.observables.size();
    memory.columns.resize(n);
    memory.tracked_of.assign(n, not_followed);
    for (unsigned int i = 0; i < n; ++i)
      if (looks_at_place(problem.observables[i]))
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
        const ObservedPart part = problem.observables[i].kind->looks_at;
        if (part == ObservedPart::material)
          with_stress[memory.tracked_of[i]] = true;
        has_extremes |=
          part == ObservedPart::extent || part == ObservedPart::largest;
        has_regions |= is_region(part);
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
  unsigned int
  Observables<dim>::body_index(const std::string &name) const
  {
    for (unsigned int b = 0; b < problem.bodies.size(); ++b)
      if (problem.bodies[b].name == name)
        return b;
    // An empty name means all bodies or, for a point, the only one.
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
  Observables<dim>::follow_forces(const double time, const Totals<dim> &totals)
  {
    if (memory.has_row && time > memory.time)
      {
        const double length = time - memory.time;
        for (unsigned int s = 0; s < 2 * dim; ++s)
          memory.side_force[s] =
            -(totals.side_impulse[s] - memory.side_impulse[s]) / length;
        for (unsigned int o = 0; o < totals.obstacles.size(); ++o)
          {
            const ObstacleAction<dim> &now    = totals.obstacles[o],
                                      &before = memory.obstacle_impulse[o];
            ObstacleAction<dim> &force        = memory.obstacle_force[o];
            force.impulse = -(now.impulse - before.impulse) / length;
            force.moment  = -(now.moment - before.moment) / length;
          }
      }
    memory.obstacle_force.resize(totals.obstacles.size());
    memory.obstacle_impulse = totals.obstacles;
    memory.has_row          = true;
    memory.time             = time;
    memory.side_impulse     = totals.side_impulse;
  }



  template <int dim>
  Seen<dim>
  Observables<dim>::look(const unsigned int                   number,
                         const Totals<dim>                   &totals,
                         const std::vector<PointSample<dim>> &samples,
                         const std::vector<double>           &extents,
                         const std::vector<RegionSums<dim>>  &regions) const
  {
    const Observable<dim> &observable = problem.observables[number];
    Seen<dim>              seen;
    switch (observable.kind->looks_at)
      {
        case ObservedPart::place:
        case ObservedPart::material:
          {
            const unsigned int t = memory.tracked_of[number];
            return see(samples[t], points.points()[t].reference, observable);
          }
        case ObservedPart::region:
        case ObservedPart::region_material:
          return regions[number].seen();
        case ObservedPart::body:
          return see(totals_of(observable, totals));
        case ObservedPart::extent:
          seen.extent = extents[number];
          return seen;
        case ObservedPart::largest:
          seen.variable = extents[number];
          return seen;
        case ObservedPart::side:
          seen.force = memory.side_force[observable.side];
          return seen;
        case ObservedPart::obstacle:
          seen.force  = memory.obstacle_force[observable.obstacle].impulse;
          seen.moment = memory.obstacle_force[observable.obstacle].moment;
          return seen;
        case ObservedPart::column:
          break;
      }
    return seen;
  }



  // By observable: the largest coordinate in its direction, or that with a
  // share of the mass beyond, or the largest value of its variable, over all
  // ranks.
  template <int dim>
  std::vector<double>
  Observables<dim>::extents(const State<dim> &state) const
  {
    std::vector<double> largest(problem.observables.size(),
                                -std::numeric_limits<double>::infinity());
    for (unsigned int i = 0; i < largest.size(); ++i)
      {
        const Observable<dim> &observable = problem.observables[i];
        const ObservedPart     part       = observable.kind->looks_at;
        if (part != ObservedPart::extent && part != ObservedPart::largest)
          continue;
        PlacesOfMass places;
        for (unsigned int b = 0; b < state.bodies.size(); ++b)
          if (observable.body.empty() || b == body_index(observable.body))
            {
              const MaterialBody<dim> &body = *state.bodies[b];
              if (part == ObservedPart::largest)
                largest[i] =
                  std::max(largest[i],
                           largest_variable(body, observable.variable));
              else if (const EndsOfPoints<dim> ends(body,
                                                    problem.grid,
                                                    observable);
                       observable.share_beyond > 0)
                ends.append_to(places);
              else
                largest[i] = std::max(largest[i], ends.largest());
            }
        if (observable.share_beyond > 0)
          largest[i] = outermost(std::move(places),
                                 observable.share_beyond,
                                 state.grid.communicator);
      }
    MPI_Allreduce(MPI_IN_PLACE,
                  largest.data(),
                  largest.size(),
                  MPI_DOUBLE,
                  MPI_MAX,
                  state.grid.communicator);
    for (double &extent : largest)
      if (!std::isfinite(extent))
        extent = not_known;
    return largest;
  }



  // By observable; points count whole, by their centres.
  template <int dim>
  std::vector<RegionSums<dim>>
  Observables<dim>::regions(const State<dim> &state) const
  {
    std::vector<RegionSums<dim>> sums(problem.observables.size());
    for (unsigned int b = 0; b < state.bodies.size(); ++b)
      {
        const MaterialBody<dim> &body   = *state.bodies[b];
        const PointView<dim>     points = body.points.view();
        PointStress<dim>         stress(state);
        bool                     has_stress = false;
        for (unsigned int i = 0; i < sums.size(); ++i)
          {
            const Observable<dim> &observable = problem.observables[i];
            const ObservedPart     part       = observable.kind->looks_at;
            if (!is_region(part) ||
                !(observable.body.empty() || b == body_index(observable.body)))
              continue;
            const bool with_stress = part == ObservedPart::region_material;
            if (with_stress && !has_stress)
              {
                stress.compute(body);
                has_stress = true;
              }
            for (std::size_t p = 0; p < points.size; ++p)
              if (is_within(points, p, observable))
                {
                  dealii::Tensor<1, dim> velocity;
                  for (int d = 0; d < dim; ++d)
                    velocity[d] = points.velocity[d][p];
                  if (!with_stress)
                    sums[i].add(points.mass[p], velocity);
                  else
                    sums[i].add(points.mass[p],
                                velocity,
                                points.mass[p] * stress.volume_ratio(p) /
                                  body.description.density(),
                                stress.pressure(p),
                                stress.deviator(p) -
                                  stress.pressure(p) *
                                    dealii::unit_symmetric_tensor<3>());
                }
          }
      }
    for (unsigned int i = 0; i < sums.size(); ++i)
      if (is_region(problem.observables[i].kind->looks_at))
        sums[i].sum_over_ranks(state.grid.communicator);
    return sums;
  }



  template <int dim>
  std::vector<double>
  Observables<dim>::evaluate(const State<dim> &state, const Totals<dim> &totals)
  {
    follow_forces(state.time, totals);
    const auto samples = points.sample(state, with_stress);
    const auto largest = has_extremes ? extents(state) : std::vector<double>();
    const auto within =
      has_regions ? regions(state) : std::vector<RegionSums<dim>>();
    return observed_row(problem.observables,
                        state.time,
                        memory.columns,
                        [&](const unsigned int i) {
                          return look(i, totals, samples, largest, within);
                        });
  }



  template class Observables<2>;
  template class Observables<3>;
} // namespace limber
