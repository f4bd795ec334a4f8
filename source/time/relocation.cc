// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/relocation.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/grid_to_points.h>

#include <algorithm>
#include <iterator>

namespace limber
{
  namespace
  {
    // Points must not go beyond the ghost layer before ranks exchange them:
    // the longest way between two exchanges, in cells.
    constexpr double travel_limit = 0.9;
  } // namespace



  template <int dim>
  Relocation<dim>::Relocation(const RunParts<dim> &parts,
                              ExternalLoads<dim>  &loads)
    : parts(parts)
    , loads(loads)
    , parallel(
        dealii::Utilities::MPI::n_mpi_processes(parts.grid.communicator) > 1)
    , largest_inverse_edge(1 / parts.grid.smallest_edge)
  {}



  template <int dim>
  void
  Relocation<dim>::reinit()
  {
    travelled = 0;
    sort_points(/*agree=*/true);
    gather_cells();
    if (parts.grid.has_levels())
      largest_inverse_edge =
        dealii::Utilities::MPI::max(find_largest_inverse_edge(),
                                    parts.grid.communicator);
  }



  // Fine cells without points do not limit the step.
  template <int dim>
  double
  Relocation<dim>::find_largest_inverse_edge() const
  {
    double result = 0;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          if (points.cell[p] != invalid_cell &&
              (p == 0 || points.cell[p] != points.cell[p - 1]))
            for (const double inverse :
                 parts.grid.geometry[points.cell[p]].inverse_edge)
              result = std::max(result, inverse);
      }
    return result;
  }



  // The one reduction over ranks that every step needs.
  template <int dim>
  void
  Relocation<dim>::reduce(StepExtremes &extremes)
  {
    any_lost           = parts.nodes.points_have_left() ? 1 : 0;
    any_entered_shared = parts.nodes.has_entered_shared() ? 1 : 0;
    any_entered_ghosts = parts.nodes.has_entered_ghosts() ? 1 : 0;
    most_points        = 0;
    for (const auto &body : parts.bodies)
      most_points += body->points.size();
    most_excess_batches = excess_batches;
    if (parts.grid.has_levels())
      largest_inverse_edge = find_largest_inverse_edge();
    if (!parallel)
      return;
    double *const all[] = {&extremes.speed_squared,
                           &extremes.wave_squared,
                           &extremes.displacement,
                           &extremes.largest_mass,
                           &any_lost,
                           &any_entered_shared,
                           &any_entered_ghosts,
                           &most_points,
                           &most_excess_batches,
                           &largest_inverse_edge};
    constexpr int n     = std::size(all);
    double        values[n];
    for (int k = 0; k < n; ++k)
      values[k] = *all[k];
    MPI_Allreduce(
      MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_MAX, parts.grid.communicator);
    for (int k = 0; k < n; ++k)
      *all[k] = values[k];
  }



  template <int dim>
  void
  Relocation<dim>::begin_step()
  {
    n_batches = 0;
    lost.clear();
  }



  template <int dim>
  void
  Relocation<dim>::end_step(StepExtremes &extremes)
  {
    if (n_batches > n_batches_sorted)
      excess_batches += n_batches - n_batches_sorted;
    reduce(extremes);
    if (any_lost > 0)
      remove_lost_points();
    parts.nodes.add_entered();
    if (any_entered_shared > 0)
      parts.nodes.agree_on_sums();
    complete_sums(parts.bodies,
                  &MaterialBody<dim>::cell_sums,
                  parts.nodes.cell_plan());
    travelled += extremes.displacement;
  }



  // A rank knows all functions of its own cells, but of those around only
  // linear ones.
  template <int dim>
  bool
  Relocation<dim>::bring_points_home()
  {
    if (!parallel || !parts.grid.reaches_beyond_cells() ||
        !(any_entered_ghosts > 0))
      return false;
    exchange_points();
    return true;
  }



  // For points that have come to their cells other than by moving.
  template <int dim>
  void
  Relocation<dim>::gather_cells()
  {
    for (auto &body : parts.bodies)
      if (body->cell_sums)
        gather_cell_sums<dim>(body->points.view(),
                              parts.nodes.view(),
                              body->cell_sums->view());
    complete_sums(parts.bodies,
                  &MaterialBody<dim>::cell_sums,
                  parts.nodes.cell_plan());
  }



  template <int dim>
  bool
  Relocation<dim>::reorganise(const double displacement)
  {
    bool exchanged = bring_points_home();
    // The next step may be somewhat longer than the last one, and one that
    // begins in a cell of twice the size counts half.
    const double allowance = parts.grid.has_levels() ? 2.5 : 1.5;
    if (parallel && travelled + allowance * displacement > travel_limit)
      {
        exchange_points();
        exchanged = true;
      }
    // A sort costs about as much as the detours of n / 4 surplus batches. All
    // ranks sort in the same step, or each would wait while the others do.
    else if (most_excess_batches > most_points / 4)
      sort_points(/*agree=*/false);
    return exchanged;
  }



  // A point without a cell has left the box, or this rank's part of it.
  template <int dim>
  void
  Relocation<dim>::remove_lost_points()
  {
    for (auto &body : parts.bodies)
      {
        const auto strain_energy = [&]() {
          return body->stress->summarize(body->points.view()).strain_energy;
        };
        const double before = strain_energy();
        for (const LostPoint<dim> &point : body->points.remove_lost())
          {
            ++parts.ledger.lost_points;
            parts.ledger.lost_mass += point.mass;
            parts.ledger.lost_momentum += point.momentum;
            parts.ledger.lost_energy +=
              0.5 * point.momentum.norm_square() / point.mass;
            for (int d = 0; d < dim; ++d)
              parts.ledger.lost_energy -=
                point.mass * parts.problem.loads.gravity[d] * point.position[d];
            lost.emplace_back(body->description.name, point);
          }
        parts.ledger.lost_energy += before - strain_energy();
      }
  }



  template <int dim>
  void
  Relocation<dim>::exchange_points()
  {
    for (auto &body : parts.bodies)
      body->points.hand_over();
    loads.exchange_pieces();
    travelled          = 0;
    any_entered_ghosts = 0;
    sort_points(/*agree=*/true);
    gather_cells();
  }



  template <int dim>
  void
  Relocation<dim>::sort_points(const bool agree)
  {
    std::vector<std::uint32_t> cells;
    n_batches_sorted = 0;
    for (auto &body : parts.bodies)
      {
        const auto        of_body = body->points.sort_by_cell();
        const std::size_t before  = cells.size();
        cells.insert(cells.end(), of_body.begin(), of_body.end());
        n_batches_sorted += of_body.size();
        std::inplace_merge(cells.begin(), cells.begin() + before, cells.end());
        if (const auto points = body->points.view(); points.has_domains())
          {
            const auto corners = cells_of_corners(points, parts.nodes.view());
            const auto middle  = cells.size();
            cells.insert(cells.end(), corners.begin(), corners.end());
            std::inplace_merge(cells.begin(),
                               cells.begin() + middle,
                               cells.end());
          }
      }
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    parts.nodes.set_occupied(std::move(cells), agree);
    excess_batches = 0;
  }



  template <int dim>
  double
  Relocation<dim>::imbalance() const
  {
    double own = 0;
    for (const auto &body : parts.bodies)
      own += body->points.size();
    const auto all =
      dealii::Utilities::MPI::min_max_avg(own, parts.grid.communicator);
    return all.avg > 0 ? all.max / all.avg : 1;
  }



  template class Relocation<2>;
  template class Relocation<3>;
} // namespace limber
