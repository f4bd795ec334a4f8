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

    // How far beyond a closed side points may be to be put back, and where to,
    // in cells. Those that are farther are lost, as the motion is unstable.
    // Less than the last is round-off and not reported.
    constexpr double put_back_limit = 0.01, put_back_place = 1e-6,
                     round_off = 1e-9;

    // The same for a body that feels a side at its surface: the material of a
    // point may be thinner than its penetration for some steps. Less than the
    // last is not reported.
    constexpr double limit_at_surface = 0.5, usual_at_surface = 0.01;



    /** Whether material cannot pass a side, which is at rest. */
    template <int dim>
    bool
    holds_material(const Side<dim> &side)
    {
      return side.held != HeldComponents::none && side.velocity.empty();
    }



    /** New place of a point that is hardly beyond closed sides. */
    template <int dim>
    struct PlaceInside
    {
      std::array<double, dim> x;
      // How far beyond them it was, in cells; 0: not to be reported
      double beyond = 0;
    };

    template <int dim>
    PlaceInside<dim>
    place_inside(const Problem<dim>   &problem,
                 const Body<dim>      &body,
                 const PointView<dim> &points,
                 const std::size_t     p)
    {
      const GridDescription<dim> &box = problem.grid;
      PlaceInside<dim>            result;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const unsigned int d    = side / 2;
          const bool         low  = side % 2 == 0;
          const double       edge = box.edge(d);
          double            &x    = result.x[d];
          if (low)
            x = points.position[d][p];
          const double beyond =
            (low ? box.lower[d] - x : x - box.upper[d]) / edge;
          const Side<dim> &wall = problem.sides[side];
          const bool       at_surface =
            wall.meets_surfaces && problem.meets_sides(body.nodal_field);
          if (!holds_material(wall) || beyond < 0 || (low && beyond == 0) ||
              beyond >= (at_surface ? limit_at_surface : put_back_limit))
            continue;
          x = low ? box.lower[d] + put_back_place * edge :
                    box.upper[d] - put_back_place * edge;
          if (beyond > (at_surface ? usual_at_surface : round_off))
            result.beyond = std::max(result.beyond, beyond);
        }
      return result;
    }



    /** Register a point in its new cell: occupied cells and cell sums. */
    template <int dim>
    void
    enter_cell(const GridView<dim>  &grid,
               MaterialBody<dim>    &body,
               const PointView<dim> &points,
               const std::size_t     p)
    {
      const std::uint32_t cell = points.cell[p];
      if (cell >= grid.n_owned_cells)
        *grid.is_in_ghosts = true;
      if (!grid.occupied[cell])
        {
          grid.occupied[cell] = 1;
          grid.entered->push_back(cell);
        }
      if (!body.cell_sums)
        return;
      PointView<dim> alone = points;
      alone.size           = 1;
      alone.mass += p;
      alone.volumetric += p;
      alone.cell += p;
      for (int d = 0; d < dim; ++d)
        alone.place[d] += p;
      gather_cell_sums<dim>(alone, grid, body.cell_sums->view());
    }



    /**
     * A side that holds the normal velocity lets nothing pass. But a node next
     * to it that has hardly any mass may be so fast that a point there, which
     * takes a tiny part of its velocity, is a tiny part of a cell beyond the
     * side. Such points are put back.
     */
    template <int dim>
    void
    put_back(const RunParts<dim> &parts)
    {
      const GridView<dim> grid = parts.nodes.view();
      for (const auto &body : parts.bodies)
        {
          const PointView<dim> points = body->points.view();
          for (std::size_t p = 0; p < points.size; ++p)
            if (points.cell[p] == invalid_cell)
              {
                const PlaceInside<dim> inside =
                  place_inside(parts.problem, body->description, points, p);
                const std::uint32_t cell = grid.bins.cell_at(inside.x);
                if (cell == invalid_cell)
                  continue;
                for (int d = 0; d < dim; ++d)
                  points.position[d][p] = inside.x[d];
                points.cell[p] = cell;
                enter_cell(grid, *body, points, p);
                if (inside.beyond > 0)
                  {
                    parts.ledger.put_back += 1;
                    parts.ledger.put_back_way += inside.beyond;
                  }
              }
        }
    }
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



  // Fine cells without points do not limit the step. Most often the first cell
  // looked at is a finest one.
  template <int dim>
  double
  Relocation<dim>::find_largest_inverse_edge() const
  {
    const double largest = 1 / parts.grid.smallest_edge;
    double       result  = 0;
    for (const auto &body : parts.bodies)
      {
        const PointView<dim> points = body->points.view();
        for (std::size_t p = 0; p < points.size; ++p)
          if (points.cell[p] != invalid_cell &&
              (p == 0 || points.cell[p] != points.cell[p - 1]))
            for (const double inverse :
                 parts.grid.geometry[points.cell[p]].inverse_edge)
              {
                result = std::max(result, inverse);
                if (result > (1 - 1e-10) * largest)
                  return largest;
              }
      }
    return result;
  }



  // The only reduction over ranks that every step needs.
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
                           &farthest_again,
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
  Relocation<dim>::end_step(StepExtremes &extremes, const double moved_again)
  {
    farthest_again = moved_again;
    if (n_batches > n_batches_sorted)
      excess_batches += n_batches - n_batches_sorted;
    reduce(extremes);
    extremes.displacement += farthest_again;
    if (any_lost > 0)
      {
        put_back(parts);
        any_entered_shared = parts.nodes.has_entered_shared() ? 1 : 0;
        any_entered_ghosts = parts.nodes.has_entered_ghosts() ? 1 : 0;
        if (parallel)
          for (double *const any : {&any_entered_shared, &any_entered_ghosts})
            *any = dealii::Utilities::MPI::max(*any, parts.grid.communicator);
        remove_lost_points();
      }
    parts.nodes.add_entered();
    if (any_entered_shared > 0)
      parts.nodes.agree_on_sums();
    complete_sums(parts.bodies,
                  &MaterialBody<dim>::cell_sums,
                  parts.nodes.cell_plan());
    if (farthest_again > 0)
      gather_cells();
    travelled += extremes.displacement;
  }



  // With kernels wider than a cell: a rank knows all shape functions of its own
  // cells, but in ghost cells only linear ones.
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



  // Cell sums of points that have come to their cells other than by moving.
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
    adopt_places();
  }



  template <int dim>
  void
  Relocation<dim>::adopt_places()
  {
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
