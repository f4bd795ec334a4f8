// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/occupancy.h>
#include <limber/base/records_of_ranks.h>

#include <algorithm>

namespace limber
{
  namespace
  {
    /** Merge entries of the same cell, adding their points. */
    template <class Entries>
    void
    merge_equal(Entries &entries)
    {
      std::sort(entries.begin(), entries.end());
      std::size_t kept = 0;
      for (std::size_t i = 0; i < entries.size(); ++i)
        if (kept > 0 && entries[kept - 1].place == entries[i].place)
          entries[kept - 1].points += entries[i].points;
        else
          entries[kept++] = entries[i];
      entries.resize(kept);
    }
  } // namespace



  template <int dim>
  Occupancy<dim>::Occupancy(const BackgroundGrid<dim>      &grid,
                            const Bodies                   &bodies,
                            const std::vector<std::string> &names)
    : numbering(grid.no_divided_cells())
    , all(grid.description.levels + 1)
    , cells(all.size())
  {
    std::vector<std::uint64_t> points(grid.n_cells());
    for (const auto &body : bodies)
      {
        if (!names.empty() &&
            std::find(names.begin(), names.end(), body->description.name) ==
              names.end())
          continue;
        const PointView<dim> view = body->points.view();
        for (std::size_t p = 0; p < view.size; ++p)
          if (view.cell[p] != invalid_cell)
            ++points[view.cell[p]];
      }
    // Serialised as level, index and points.
    std::vector<std::uint64_t> own;
    for (const auto &cell : grid.triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        if (const std::uint64_t n = points[grid.cell_number(cell)]; n > 0)
          {
            const unsigned int level = grid.level_of(cell);
            own.insert(own.end(),
                       {level,
                        numbering.number(level, grid.place_of(cell)),
                        n});
          }
    for (const auto &part : gather_records(own, grid.communicator))
      for (std::size_t i = 0; i + 2 < part.size(); i += 3)
        cells[part[i]].push_back({part[i + 1], part[i + 2]});

    for (unsigned int level = cells.size(); level-- > 0;)
      {
        merge_equal(cells[level]);
        all[level].insert(all[level].end(),
                          cells[level].begin(),
                          cells[level].end());
        merge_equal(all[level]);
        if (level > 0)
          for (const Entry &entry : all[level])
            {
              Place parent = numbering.place(level, entry.place);
              for (auto &step : parent)
                step /= 2;
              all[level - 1].push_back(
                {numbering.number(level - 1, parent), entry.points});
            }
      }
  }



  template <int dim>
  const typename Occupancy<dim>::Entry *
  Occupancy<dim>::find(const std::vector<Entry> &entries,
                       const std::uint64_t       place) const
  {
    const auto found =
      std::lower_bound(entries.begin(), entries.end(), Entry{place, 0});
    return found != entries.end() && found->place == place ? &*found : nullptr;
  }



  template <int dim>
  std::uint64_t
  Occupancy<dim>::points_in(const unsigned int level, const Place &place) const
  {
    const Entry *const entry = find(all[level], numbering.number(level, place));
    return entry != nullptr ? entry->points : 0;
  }



  template <int dim>
  bool
  Occupancy<dim>::is_filled(const unsigned int level, const Place &place) const
  {
    if (points_in(level, place) > 0)
      return true;
    Place parent = place;
    for (unsigned int coarser = level; coarser-- > 0;)
      {
        for (auto &step : parent)
          step /= 2;
        if (find(cells[coarser], numbering.number(coarser, parent)) != nullptr)
          return true;
      }
    return false;
  }



  template <int dim>
  bool
  Occupancy<dim>::any_near(const unsigned int level,
                           const Place       &place,
                           const int          distance,
                           const bool         filled) const
  {
    const int    width = 2 * distance + 1;
    unsigned int n     = 1;
    for (int d = 0; d < dim; ++d)
      n *= width;
    for (unsigned int k = 0; k < n; ++k)
      {
        Place        other = place;
        unsigned int rest  = k;
        for (int d = 0; d < dim; ++d, rest /= width)
          other[d] += rest % width - distance; // unsigned underflow: not inside
        if (numbering.is_inside(level, other) &&
            is_filled(level, other) == filled)
          return true;
      }
    return false;
  }



  template <int dim>
  bool
  Occupancy<dim>::is_near_empty(const unsigned int level,
                                const Place       &place,
                                const int          distance) const
  {
    return any_near(level, place, distance, false);
  }



  template <int dim>
  bool
  Occupancy<dim>::is_near_filled(const unsigned int level,
                                 const Place       &place,
                                 const int          distance) const
  {
    return any_near(level, place, distance, true);
  }



  template class Occupancy<2>;
  template class Occupancy<3>;
} // namespace limber
