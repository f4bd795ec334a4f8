// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>
#include <cmath>

/**
 * @file What happens to points between the sweeps of two steps: cells and
 * sums that follow them, order in memory, changes of rank, losses.
 */
namespace limber
{
  namespace
  {
    // Points must not go beyond the ghost layer before ranks exchange them:
    // the longest way between two exchanges, in cells.
    constexpr double travel_limit = 0.9;
  } // namespace



  // The one reduction over ranks that every step needs.
  template <int dim>
  void
  ExplicitIntegrator<dim>::reduce_extremes()
  {
    any_lost           = nodes.points_have_left() ? 1 : 0;
    any_entered_shared = nodes.has_entered_shared() ? 1 : 0;
    any_entered_ghosts = nodes.has_entered_ghosts() ? 1 : 0;
    most_points        = 0;
    for (const auto &body : bodies)
      most_points += body->points.size();
    most_excess_batches = excess_batches;
    if (parallel)
      {
        double *const extremes[] = {&speed_squared,
                                    &wave_squared,
                                    &displacement,
                                    &largest_mass,
                                    &any_lost,
                                    &any_entered_shared,
                                    &any_entered_ghosts,
                                    &most_points,
                                    &most_excess_batches};
        constexpr int n          = std::size(extremes);
        double        values[n];
        for (int k = 0; k < n; ++k)
          values[k] = *extremes[k];
        MPI_Allreduce(
          MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_MAX, grid.communicator);
        for (int k = 0; k < n; ++k)
          *extremes[k] = values[k];
      }
    wave_speed  = std::sqrt(wave_squared);
    point_speed = std::sqrt(speed_squared);
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::relocate()
  {
    if (n_batches > n_batches_sorted)
      excess_batches += n_batches - n_batches_sorted;
    reduce_extremes();
    if (any_lost > 0)
      remove_lost_points();
    nodes.add_entered();
    if (any_entered_shared > 0)
      nodes.agree_on_sums();
    complete_cells(&MaterialBody<dim>::cell_sums);

    travelled += displacement;
    lap(Verb::relocate);
  }



  // A rank knows all functions of its own cells, but of those around only
  // linear ones.
  template <int dim>
  bool
  ExplicitIntegrator<dim>::bring_points_home()
  {
    if (!parallel || !grid.reaches_beyond_cells() || !(any_entered_ghosts > 0))
      return false;
    exchange_points();
    return true;
  }



  // The sums that a sweep has gathered.
  template <int dim>
  void
  ExplicitIntegrator<dim>::complete_cells(
    std::optional<CellFields<dim>> MaterialBody<dim>::*const sums)
  {
    for (auto &body : bodies)
      if ((*body).*sums)
        ((*body).*sums)->start_completion(nodes.cell_plan());
    for (auto &body : bodies)
      if (auto &own = (*body).*sums)
        own->finish_completion();
  }



  // For points that have come to their cells other than by moving.
  template <int dim>
  void
  ExplicitIntegrator<dim>::gather_cells()
  {
    for (auto &body : bodies)
      if (body->cell_sums)
        gather_cell_sums<dim>(body->points.view(),
                              nodes.view(),
                              body->cell_sums->view());
    complete_cells(&MaterialBody<dim>::cell_sums);
  }



  template <int dim>
  bool
  ExplicitIntegrator<dim>::reorganise()
  {
    stopwatch.start();
    bool exchanged = bring_points_home();
    // The next step may be somewhat longer than the last one.
    if (parallel && travelled + 1.5 * displacement > travel_limit)
      {
        exchange_points();
        exchanged = true;
      }
    // A sort costs about as much as the detours of n / 4 surplus batches. All
    // ranks sort in the same step, or each would wait while the others do.
    else if (most_excess_batches > most_points / 4)
      sort_points(/*agree=*/false);
    lap(Verb::relocate);
    return exchanged;
  }



  // A point without a cell has left the box, or this rank's part of it.
  template <int dim>
  void
  ExplicitIntegrator<dim>::remove_lost_points()
  {
    for (auto &body : bodies)
      {
        const auto strain_energy = [&]() {
          return body->stress->summarize(body->points.view()).strain_energy;
        };
        const double before = strain_energy();
        for (const LostPoint<dim> &point : body->points.remove_lost())
          {
            ++ledger.lost_points;
            ledger.lost_mass += point.mass;
            ledger.lost_momentum += point.momentum;
            ledger.lost_energy +=
              0.5 * point.momentum.norm_square() / point.mass;
            for (int d = 0; d < dim; ++d)
              ledger.lost_energy -=
                point.mass * problem.loads.gravity[d] * point.position[d];
            lost.emplace_back(body->description.name, point);
          }
        ledger.lost_energy += before - strain_energy();
      }
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::exchange_points()
  {
    for (auto &body : bodies)
      body->points.hand_over();
    loads.exchange_pieces();
    travelled          = 0;
    any_entered_ghosts = 0;
    sort_points(/*agree=*/true);
    gather_cells();
  }



  template <int dim>
  void
  ExplicitIntegrator<dim>::sort_points(const bool agree)
  {
    std::vector<std::uint32_t> cells;
    n_batches_sorted = 0;
    for (auto &body : bodies)
      {
        const auto        of_body = body->points.sort_by_cell();
        const std::size_t before  = cells.size();
        cells.insert(cells.end(), of_body.begin(), of_body.end());
        n_batches_sorted += of_body.size();
        std::inplace_merge(cells.begin(), cells.begin() + before, cells.end());
        if (const auto points = body->points.view(); points.has_domains())
          {
            const auto corners = cells_of_corners(points, nodes.view());
            const auto middle  = cells.size();
            cells.insert(cells.end(), corners.begin(), corners.end());
            std::inplace_merge(cells.begin(),
                               cells.begin() + middle,
                               cells.end());
          }
      }
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    nodes.set_occupied(std::move(cells), agree);
    excess_batches = 0;
  }



  template <int dim>
  double
  ExplicitIntegrator<dim>::imbalance() const
  {
    double own = 0;
    for (const auto &body : bodies)
      own += body->points.size();
    const auto all =
      dealii::Utilities::MPI::min_max_avg(own, grid.communicator);
    return all.avg > 0 ? all.max / all.avg : 1;
  }



  template void
  ExplicitIntegrator<2>::reduce_extremes();
  template void
  ExplicitIntegrator<2>::relocate();
  template void
  ExplicitIntegrator<2>::complete_cells(
    std::optional<CellFields<2>> MaterialBody<2>::*);
  template void
  ExplicitIntegrator<2>::gather_cells();
  template bool
  ExplicitIntegrator<2>::bring_points_home();
  template bool
  ExplicitIntegrator<2>::reorganise();
  template void
  ExplicitIntegrator<2>::remove_lost_points();
  template void
  ExplicitIntegrator<2>::exchange_points();
  template void
  ExplicitIntegrator<2>::sort_points(bool);
  template double
  ExplicitIntegrator<2>::imbalance() const;
  template void
  ExplicitIntegrator<3>::reduce_extremes();
  template void
  ExplicitIntegrator<3>::relocate();
  template void
  ExplicitIntegrator<3>::complete_cells(
    std::optional<CellFields<3>> MaterialBody<3>::*);
  template void
  ExplicitIntegrator<3>::gather_cells();
  template bool
  ExplicitIntegrator<3>::bring_points_home();
  template bool
  ExplicitIntegrator<3>::reorganise();
  template void
  ExplicitIntegrator<3>::remove_lost_points();
  template void
  ExplicitIntegrator<3>::exchange_points();
  template void
  ExplicitIntegrator<3>::sort_points(bool);
  template double
  ExplicitIntegrator<3>::imbalance() const;
} // namespace limber
