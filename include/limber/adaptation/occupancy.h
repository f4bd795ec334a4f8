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
   * Number of points in the cells of all levels, over all ranks: in active
   * cells and their ancestors. Sixteen bytes per occupied cell, on every rank,
   * while criteria are evaluated.
   */
  template <int dim>
  class Occupancy
  {
  public:
    using Place  = typename RefinedCells<dim>::Place;
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    /**
     * Counts the points of all bodies, or of those with these names. Points may
     * be in ghost cells. Collective.
     */
    Occupancy(const BackgroundGrid<dim>      &grid,
              const Bodies                   &bodies,
              const std::vector<std::string> &names = {});

    /**
     * Number of points in the cell of this level at that index, or in its
     * descendants.
     */
    std::uint64_t
    points_in(unsigned int level, const Place &place) const;

    /** Whether it contains points, or is part of a coarser cell with points. */
    bool
    is_filled(unsigned int level, const Place &place) const;

    /**
     * Whether any cell of this size within @p distance cells along each axis is
     * empty. Places outside of the box do not count.
     */
    bool
    is_near_empty(unsigned int level, const Place &place, int distance) const;

    /** Likewise, whether any is filled. */
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
    std::vector<std::vector<Entry>> all, cells; // by level; active cells only
  };
} // namespace limber

#endif
