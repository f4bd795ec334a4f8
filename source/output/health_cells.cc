// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/output/health_figures.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  namespace
  {
    // Numerical fracture opens gaps of one cell, then two; wider ones are taken
    // for space between parts of the body, which a scene may have as well.
    constexpr unsigned int widest_gap = 2;



    template <int dim>
    std::uint64_t
    place_of(const std::array<unsigned int, dim> &at,
             const std::array<unsigned int, dim> &n)
    {
      std::uint64_t place = 0;
      for (int d = dim - 1; d >= 0; --d)
        place = place * n[d] + at[d];
      return place;
    }



    template <int dim>
    std::array<unsigned int, dim>
    indices_of(std::uint64_t place, const std::array<unsigned int, dim> &n)
    {
      std::array<unsigned int, dim> at;
      for (int d = 0; d < dim; ++d, place /= n[d - 1])
        at[d] = place % n[d];
      return at;
    }



    /** Sorts by place; entries of equal place become one with their sum. */
    void
    merge_equal(std::vector<CellCount> &cells)
    {
      std::sort(cells.begin(), cells.end(), [](const auto &a, const auto &b) {
        return a.place < b.place;
      });
      std::size_t kept = 0;
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (kept > 0 && cells[kept - 1].place == cells[i].place)
          {
            cells[kept - 1].points += cells[i].points;
            cells[kept - 1].volume += cells[i].volume;
          }
        else
          cells[kept++] = cells[i];
      cells.resize(kept);
    }



    /** Counts points per cell of the coarsest level; finer cells are part of
     * one. */
    template <int dim>
    CellCounts
    count_own(const State<dim> &state, const MaterialBody<dim> &body)
    {
      const GridDescription<dim> &grid    = state.problem.grid;
      const PointView<dim>        points  = body.points.view();
      const double                density = body.description.density();
      std::vector<double>         ratio(points.size);
      body.stress->volume_ratio(points, ratio.data());
      CellCounts counts;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          if (points.cell[p] == invalid_cell)
            continue;
          const auto &cell = state.grid.geometry[points.cell[p]];
          std::array<unsigned int, dim> at;
          for (int d = 0; d < dim; ++d)
            at[d] = (cell.origin[d] - grid.lower[d]) / grid.edge(d) + 1e-6;
          const std::uint64_t place  = place_of<dim>(at, grid.cells);
          const double        volume = points.mass[p] * ratio[p] / density;
          auto               &cells  = counts.cells;
          if (!cells.empty() && cells.back().place == place)
            {
              ++cells.back().points;
              cells.back().volume += volume;
            }
          else
            cells.push_back({place, 1, volume});
        }
      merge_equal(counts.cells);
      return counts;
    }



    /** Width of the gap that begins next to @p at, if the body continues behind
     * it. */
    template <int dim>
    unsigned int
    width_of_gap(const CellCounts                    &own,
                 const std::array<unsigned int, dim> &n,
                 std::array<unsigned int, dim>        at,
                 const unsigned int                   d)
    {
      for (unsigned int width = 0; width <= widest_gap; ++width)
        {
          if (++at[d] >= n[d])
            return 0;
          if (own.in(place_of<dim>(at, n)).points > 0)
            return width;
        }
      return 0;
    }



    /** Whether all face neighbours of a cell belong to the body; @p sides of
     * the grid may stand for those. */
    template <int dim>
    bool
    is_inner(const CellCounts                    &own,
             const std::array<unsigned int, dim> &n,
             const std::array<unsigned int, dim> &at,
             const bool                           sides = false)
    {
      for (unsigned int d = 0; d < dim; ++d)
        for (const int step : {-1, 1})
          {
            auto other = at;
            other[d] += step; // below zero: beyond the last, too
            if (other[d] >= n[d] ? !sides :
                                   own.in(place_of<dim>(other, n)).points == 0)
              return false;
          }
      return true;
    }
  } // namespace



  CellCount
  CellCounts::in(const std::uint64_t place) const
  {
    const auto found =
      std::lower_bound(cells.begin(),
                       cells.end(),
                       place,
                       [](const CellCount &cell, const std::uint64_t sought) {
                         return cell.place < sought;
                       });
    return found != cells.end() && found->place == place ? *found :
                                                           CellCount{place, 0};
  }



  template <int dim>
  void
  look_at_counts(const std::vector<CellCounts>       &counts,
                 const std::array<unsigned int, dim> &n,
                 const std::size_t                    b,
                 BodyFigures                         &body)
  {
    const CellCounts          &own = counts[b];
    std::vector<std::uint64_t> gaps;
    body.cells       = own.cells.size();
    body.inner_cells = body.single_cells = 0;
    for (const auto &[place, points, volume] : own.cells)
      {
        const auto at    = indices_of<dim>(place, n);
        const bool inner = is_inner<dim>(own, n, at);
        body.inner_cells += inner;
        body.single_cells += inner && points == 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            auto empty = at;
            for (unsigned int w = width_of_gap<dim>(own, n, at, d); w > 0; --w)
              {
                ++empty[d];
                gaps.push_back(place_of<dim>(empty, n));
              }
          }
      }
    std::sort(gaps.begin(), gaps.end());
    gaps.erase(std::unique(gaps.begin(), gaps.end()), gaps.end());
    // Cells that hold another body are no gaps.
    body.gaps =
      std::count_if(gaps.begin(), gaps.end(), [&](const std::uint64_t place) {
        return std::all_of(counts.begin(),
                           counts.end(),
                           [&](const CellCounts &all) {
                             return all.in(place).points == 0;
                           });
      });
  }



  template <int dim>
  double
  filling(const std::vector<CellCounts>            &counts,
          const std::array<unsigned int, dim>      &n,
          const double                              cell_volume,
          const std::function<bool(std::uint64_t)> &is_open,
          const std::size_t                         b)
  {
    constexpr unsigned int least_cells = 16; // fewer are not significant
    const CellCounts      &own         = counts[b];
    unsigned long          cells       = 0;
    double                 volume      = 0;
    for (const CellCount &cell : own.cells)
      if (is_inner<dim>(own, n, indices_of<dim>(cell.place, n), true) &&
          is_open(cell.place))
        {
          ++cells;
          for (const CellCounts &all : counts)
            volume += all.in(cell.place).volume;
        }
    return cells < least_cells ? 1 : volume / (cells * cell_volume);
  }



  template <int dim>
  void
  look_at_cells(const State<dim> &state, std::vector<BodyFigures> &bodies)
  {
    std::vector<CellCounts> counts;
    for (const auto &body : state.bodies)
      {
        const auto parts = gather_records(count_own(state, *body).cells,
                                          state.grid.communicator,
                                          /*only_first=*/true);
        counts.emplace_back();
        auto &all = counts.back().cells;
        for (const auto &part : parts)
          all.insert(all.end(), part.begin(), part.end());
        merge_equal(all);
      }
    for (std::size_t b = 0; b < bodies.size(); ++b)
      look_at_counts<dim>(counts, state.problem.grid.cells, b, bodies[b]);

    // Of liquids: clumping, whether points are denser than their volumes
    const GridDescription<dim>     &grid        = state.problem.grid;
    double                          cell_volume = 1;
    std::vector<ObstaclePlace<dim>> obstacles;
    for (const auto &obstacle : state.problem.obstacles)
      obstacles.emplace_back(obstacle, state.time);
    for (unsigned int d = 0; d < dim; ++d)
      cell_volume *= grid.edge(d);
    const auto is_open = [&](const std::uint64_t place) {
      const auto         at = indices_of<dim>(place, grid.cells);
      dealii::Point<dim> middle;
      double             square = 0;
      for (unsigned int d = 0; d < dim; ++d)
        {
          middle[d] = grid.lower[d] + (at[d] + 0.5) * grid.edge(d);
          square += grid.edge(d) * grid.edge(d) / 4;
        }
      return std::all_of(obstacles.begin(),
                         obstacles.end(),
                         [&](const ObstaclePlace<dim> &obstacle) {
                           return obstacle.distance(middle).value >=
                                  std::sqrt(square);
                         });
    };
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].is_liquid)
        bodies[b].filling =
          filling<dim>(counts, grid.cells, cell_volume, is_open, b);
  }



  template void
  look_at_counts<2>(const std::vector<CellCounts> &,
                    const std::array<unsigned int, 2> &,
                    std::size_t,
                    BodyFigures &);
  template void
  look_at_counts<3>(const std::vector<CellCounts> &,
                    const std::array<unsigned int, 3> &,
                    std::size_t,
                    BodyFigures &);
  template double
  filling<2>(const std::vector<CellCounts> &,
             const std::array<unsigned int, 2> &,
             double,
             const std::function<bool(std::uint64_t)> &,
             std::size_t);
  template double
  filling<3>(const std::vector<CellCounts> &,
             const std::array<unsigned int, 3> &,
             double,
             const std::function<bool(std::uint64_t)> &,
             std::size_t);
  template void
  look_at_cells(const State<2> &, std::vector<BodyFigures> &);
  template void
  look_at_cells(const State<3> &, std::vector<BodyFigures> &);
} // namespace limber
