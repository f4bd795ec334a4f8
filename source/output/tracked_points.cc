// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/tracked_points.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  namespace
  {
    /** What the owner of a tracked point sends to the others, as doubles. */
    template <int dim>
    struct Telegram
    {
      static constexpr unsigned int found    = 0;
      static constexpr unsigned int position = 1;
      static constexpr unsigned int velocity = 1 + dim;
      static constexpr unsigned int volume   = 1 + 2 * dim;
      static constexpr unsigned int pressure = 2 + 2 * dim;
      static constexpr unsigned int deviator = 3 + 2 * dim;
      static constexpr unsigned int variable = 9 + 2 * dim;
      static constexpr unsigned int stride   = variable + max_variables;
    };



    /**
     * A point that may be followed: distance to the wanted place, place, id.
     * Distances are rounded to a billionth of a cell, so that of points at
     * equal distance the first by coordinates wins on any number of ranks.
     */
    template <int dim>
    using Candidate = std::array<double, 2 + dim>;



    template <int dim>
    Candidate<dim>
    nearest_here(const PointView<dim>      &points,
                 const MaterialPoints<dim> &owner,
                 const dealii::Point<dim>  &place,
                 const double               resolution)
    {
      Candidate<dim> best;
      best.fill(std::numeric_limits<double>::infinity());
      std::size_t nearest = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          Candidate<dim> candidate{};
          double         square = 0;
          for (int d = 0; d < dim; ++d)
            {
              const double x   = points.position[d][p];
              candidate[1 + d] = x;
              square += (x - place[d]) * (x - place[d]);
            }
          candidate[0] = std::floor(std::sqrt(square) / resolution + 0.5);
          if (candidate < best)
            {
              best    = candidate;
              nearest = p;
            }
        }
      if (points.size > 0)
        best[1 + dim] = owner.id(nearest);
      return best;
    }
  } // namespace



  template <int dim>
  TrackedPoints<dim>::TrackedPoints(
    const std::vector<TrackedPoint<dim>> &points)
    : tracked(points)
    , index(points.size(), nowhere)
  {}



  template <int dim>
  unsigned int
  TrackedPoints<dim>::follow_nearest(const State<dim>         &state,
                                     const unsigned int        body,
                                     const dealii::Point<dim> &place)
  {
    const MaterialPoints<dim> &owner = state.bodies[body]->points;
    const Candidate<dim>       own =
      nearest_here(owner.view(), owner, place, 1e-9 * state.grid.smallest_edge);
    std::vector<Candidate<dim>> all(
      dealii::Utilities::MPI::n_mpi_processes(state.grid.communicator));
    MPI_Allgather(own.data(),
                  own.size(),
                  MPI_DOUBLE,
                  all.data(),
                  own.size(),
                  MPI_DOUBLE,
                  state.grid.communicator);
    const Candidate<dim> best = *std::min_element(all.begin(), all.end());

    TrackedPoint<dim> point;
    point.body = body;
    point.lost = std::isinf(best[0]); // the body has no points at all
    if (!point.lost)
      {
        point.id = static_cast<std::uint64_t>(best[1 + dim]);
        for (int d = 0; d < dim; ++d)
          point.reference[d] = best[1 + d];
        for (unsigned int t = 0; t < tracked.size(); ++t)
          if (tracked[t].body == body && tracked[t].id == point.id &&
              !tracked[t].lost)
            return t;
      }
    tracked.push_back(point);
    index.push_back(nowhere);
    return tracked.size() - 1;
  }



  template <int dim>
  void
  TrackedPoints<dim>::search(const State<dim> &state, const unsigned int t)
  {
    const MaterialPoints<dim> &owner = state.bodies[tracked[t].body]->points;
    index[t]                         = nowhere;
    for (std::size_t p = 0; p < owner.size(); ++p)
      if (owner.id(p) == tracked[t].id)
        {
          index[t] = p;
          return;
        }
  }



  template <int dim>
  void
  TrackedPoints<dim>::revalidate(const State<dim> &state, const unsigned int t)
  {
    const MaterialPoints<dim> &owner = state.bodies[tracked[t].body]->points;
    if (index[t] != nowhere &&
        !(index[t] < owner.size() && owner.id(index[t]) == tracked[t].id))
      search(state, t);
  }



  template <int dim>
  std::vector<double>
  TrackedPoints<dim>::collect(const State<dim>        &state,
                              const Stresses          &stresses,
                              const std::vector<bool> &with_stress) const
  {
    using T = Telegram<dim>;
    std::vector<double> records(tracked.size() * T::stride);
    for (unsigned int t = 0; t < tracked.size(); ++t)
      {
        if (index[t] == nowhere)
          continue;
        const MaterialBody<dim> &body   = *state.bodies[tracked[t].body];
        const PointView<dim>     points = body.points.view();
        double *const            record = records.data() + t * T::stride;
        record[T::found]                = 1;
        for (int d = 0; d < dim; ++d)
          {
            record[T::position + d] = points.position[d][index[t]];
            record[T::velocity + d] = points.velocity[d][index[t]];
          }
        if (!with_stress[t])
          continue;
        const PointStress<dim> &stress = stresses.at(tracked[t].body);
        record[T::volume]              = stress.volume_ratio(index[t]);
        record[T::pressure]            = stress.pressure(index[t]);
        const auto s                   = stress.deviator(index[t]);
        std::copy(s.begin_raw(), s.end_raw(), record + T::deviator);
        const unsigned int n =
          body.stress->n_history() - body.stress->first_variable();
        for (unsigned int k = 0; k < n; ++k)
          record[T::variable + k] = body.variable(k)[index[t]];
      }
    MPI_Allreduce(MPI_IN_PLACE,
                  records.data(),
                  records.size(),
                  MPI_DOUBLE,
                  MPI_SUM,
                  state.grid.communicator);
    return records;
  }



  template <int dim>
  std::vector<PointSample<dim>>
  TrackedPoints<dim>::sample(const State<dim>        &state,
                             const std::vector<bool> &with_stress)
  {
    using T = Telegram<dim>;
    std::vector<PointSample<dim>> samples(tracked.size());
    if (tracked.empty())
      return samples;

    for (unsigned int t = 0; t < tracked.size(); ++t)
      revalidate(state, t);
    Stresses stresses;
    for (unsigned int t = 0; t < tracked.size(); ++t)
      if (with_stress[t] && stresses.count(tracked[t].body) == 0)
        stresses.try_emplace(tracked[t].body, state)
          .first->second.compute(*state.bodies[tracked[t].body]);
    std::vector<double> records = collect(state, stresses, with_stress);

    // A point whose owner has not reported it has changed its rank, or is lost.
    bool looked_again = false;
    for (unsigned int t = 0; t < tracked.size(); ++t)
      if (!tracked[t].lost && records[t * T::stride + T::found] == 0)
        {
          search(state, t);
          looked_again = true;
        }
    if (looked_again)
      records = collect(state, stresses, with_stress);

    for (unsigned int t = 0; t < tracked.size(); ++t)
      {
        const double *const record = records.data() + t * T::stride;
        tracked[t].lost            = record[T::found] == 0;
        samples[t].lost            = tracked[t].lost;
        for (int d = 0; d < dim; ++d)
          {
            samples[t].position[d] = record[T::position + d];
            samples[t].velocity[d] = record[T::velocity + d];
          }
        samples[t].volume_ratio = record[T::volume];
        samples[t].pressure     = record[T::pressure];
        dealii::SymmetricTensor<2, 3> s;
        std::copy_n(record + T::deviator, 6, s.begin_raw());
        samples[t].stress =
          s - samples[t].pressure * dealii::unit_symmetric_tensor<3>();
        std::copy_n(record + T::variable,
                    max_variables,
                    samples[t].variables.begin());
      }
    return samples;
  }



  template class TrackedPoints<2>;
  template class TrackedPoints<3>;
} // namespace limber
