// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_record_window_h
#define limber_grid_record_window_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

#include <array>

namespace limber
{
  /**
   * The pack with which @p n_slots slots of nodal records from @p first on are
   * loaded and stored at once. Lanes beyond these hold other slots, but never
   * exceed the record.
   */
  template <int dim, unsigned int first, unsigned int n_slots>
  struct RecordWindow
  {
    static constexpr unsigned int width = n_slots <= 2 ? 2 :
                                          n_slots <= 4 ? 4 :
                                                         8;
    static constexpr unsigned int start =
      first + width <= NodeLayout<dim>::stride ?
        first :
        NodeLayout<dim>::stride - width;
    static constexpr unsigned int n_used = first + n_slots - start;
    static_assert(n_used <= width);
    using Lanes =
      std::conditional_t<width <= widest_pack, Pack<int(width)>, SplitPack>;

    static constexpr unsigned int
    lane_of(const unsigned int slot)
    {
      return slot - start;
    }
  };



  /**
   * Transposition: from slots, each a pack of points, to one record per point.
   */
  template <class Record, class Number>
  __attribute__((always_inline)) inline std::array<Record, pack_width<Number>>
  records_of(const std::array<Number, pack_width<Record>> &slots)
  {
    constexpr int n_points = pack_width<Number>, n = pack_width<Record>;
    std::array<Record, n_points> result;
    std::array<Pack<4>, 4>       block;
    // Blocks of four points and (except for the shortest records) four slots
    for (int first = 0; first < n_points; first += 4)
      for (int slot = 0; slot < n; slot += 4)
        {
          for (int i = 0; i < 4; ++i)
            block[i] =
              slot + i < n ? four_lanes(slots[slot + i], first) : Pack<4>{};
          transpose<4>(block);
          for (int p = 0; p < 4; ++p)
            if constexpr (n == 2)
              result[first + p] = some_lanes<Record>(block[p], 0);
            else if constexpr (n == 4)
              result[first + p] = block[p];
            else if (slot == 0)
              result[first + p].lower = block[p];
            else
              result[first + p].upper = block[p];
        }
    return result;
  }



  /**
   * Add the sum over the points of a pack, by slots of a window, to a record,
   * from the first slot of the window on. Slots beyond @p n_used may be
   * skipped.
   */
  template <std::size_t n_used, class Number, std::size_t width>
  __attribute__((always_inline)) inline void
  add_sums(const std::array<Number, width> &given, double *const slots)
  {
    constexpr std::size_t n_points = pack_width<Number>;
    if constexpr (2 * width == n_points)
      {
        const auto sums = sums_over_lanes(given);
        store(load<Pack<int(width)>>(slots) + sums, slots);
      }
    else
#pragma GCC unroll 2
      for (std::size_t first = 0; first < n_used; first += n_points)
        if (n_used - first == 1)
          slots[first] += sum(given[first]);
        else
          {
            std::array<Number, n_points> some;
#pragma GCC unroll 8
            for (std::size_t i = 0; i < n_points; ++i)
              some[i] = given[first + i];
            store(load<Number>(slots + first) + sums_over_lanes(some),
                  slots + first);
          }
  }
} // namespace limber

#endif
