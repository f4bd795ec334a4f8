// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_adaptation_occupancy_h
#define limber_adaptation_occupancy_h

#include <limber/state/material_body.h>

#include <memory>
#include <string>
#include <vector>

namespace limber
{
  /**
   * How many points there are in the cells of all levels, over all ranks: in
   * those that there are and in those that these are parts of. Sixteen bytes
   * for each cell that holds points, on every rank, while criteria look at it.
   */
  template <int dim>
  class Occupancy
  {
  public:
    using Place  = typename RefinedCells<dim>::Place;
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    /**
     * Of all bodies, or of those with these names. Points may be in ghost
     * cells. Collective.
     */
    Occupancy(const BackgroundGrid<dim>      &grid,
              const Bodies                   &bodies,
              const std::vector<std::string> &names = {});

    /** In the cells of this level or finer ones at that place. */
    std::uint64_t
    points_in(unsigned int level, const Place &place) const;

    /** Whether there are any, or the place is part of a cell with some. */
    bool
    is_filled(unsigned int level, const Place &place) const;

    /**
     * Whether a place of this size is empty within @p distance of it along
     * each axis. Beyond the sides of the box nothing is.
     */
    bool
    is_near_empty(unsigned int level, const Place &place, int distance) const;

    /** Likewise, whether one is filled. */
    bool
    is_near_filled(unsigned int level, const Place &place, int distance) const;

  private:
    struct Entry
    {
      std::uint64_t place, points;
      bool
      operator<(const Entry &other) const
      {
        return place < other.place;
      }
    };

    const Entry *
    find(const std::vector<Entry> &entries, std::uint64_t place) const;

    bool
    any_near(unsigned int level,
             const Place &place,
             int          distance,
             bool         filled) const;

    const RefinedCells<dim>         numbering;
    std::vector<std::vector<Entry>> all, cells; // by level; those that are
  };
} // namespace limber

#endif
