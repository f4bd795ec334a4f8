// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_record_window_h
#define limber_grid_record_window_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

#include <array>

namespace limber
{
  /**
   * The pack through which @p n_slots slots of nodal records from @p first on
   * are read or written at once. Lanes beyond the wanted slots hold others, but
   * never reach beyond the record.
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
    static_assert(first + n_slots <= start + width);
    using Lanes =
      std::conditional_t<width <= widest_pack, Pack<int(width)>, SplitPack>;

    static constexpr unsigned int
    lane_of(const unsigned int slot)
    {
      return slot - start;
    }
  };



  namespace internal
  {
    /** A record from its lower lanes and its upper ones. */
    template <class Record, class Half>
    __attribute__((always_inline)) inline Record
    record_of(const Half &lower, const Half &upper)
    {
      if constexpr (std::is_same_v<Record, SplitPack>)
        return {lower, upper};
      else
        return joined(lower, upper);
    }

    /** And back: those from lane @p first on that fill a narrow pack. */
    template <class Half, class Record>
    __attribute__((always_inline)) inline Half
    half_of(const Record &record, const int first)
    {
      if constexpr (std::is_same_v<Record, SplitPack>)
        return first == 0 ? record.lower : record.upper;
      else
        return some_lanes<Half>(record, first);
    }
  } // namespace internal



  /**
   * From values of the points of a pack, by slot of a record, to one record
   * for each point.
   */
  template <class Record, class Number>
  __attribute__((always_inline)) inline std::array<Record, pack_width<Number>>
  records_of(const std::array<Number, pack_width<Record>> &slots)
  {
    constexpr int n_points = pack_width<Number>, n = pack_width<Record>;
    std::array<Record, n_points> result;
    if constexpr (n == n_points)
      {
        result = slots;
        transpose<n>(result);
      }
    else if constexpr (n == 2 * n_points)
      {
        std::array<Number, n_points> lower, upper;
        for (int i = 0; i < n_points; ++i)
          {
            lower[i] = slots[i];
            upper[i] = slots[i + n_points];
          }
        transpose<n_points>(lower);
        transpose<n_points>(upper);
        for (int p = 0; p < n_points; ++p)
          result[p] = internal::record_of<Record>(lower[p], upper[p]);
      }
    else
      {
        static_assert(2 * n == n_points);
        std::array<Number, n_points> padded{};
        for (int i = 0; i < n; ++i)
          padded[i] = slots[i];
        transpose<n_points>(padded);
        for (int p = 0; p < n_points; ++p)
          result[p] = some_lanes<Record>(padded[p], 0);
      }
    return result;
  }



  /** And back: the values of some slots of one record for each point. */
  template <class Number, class Record>
  __attribute__((always_inline)) inline std::array<Number, pack_width<Record>>
  slots_of(const std::array<Record, pack_width<Number>> &records)
  {
    constexpr int         n_points = pack_width<Number>, n = pack_width<Record>;
    std::array<Number, n> result;
    if constexpr (n == n_points)
      {
        result = records;
        transpose<n>(result);
      }
    else if constexpr (n == 2 * n_points)
      for (int half = 0; half < 2; ++half)
        {
          std::array<Number, n_points> block;
          for (int p = 0; p < n_points; ++p)
            block[p] = internal::half_of<Number>(records[p], half * n_points);
          transpose<n_points>(block);
          for (int i = 0; i < n_points; ++i)
            result[half * n_points + i] = block[i];
        }
    else
      {
        static_assert(2 * n == n_points);
        std::array<Number, n_points> padded;
        for (int p = 0; p < n_points; ++p)
          padded[p] = doubled(records[p]);
        transpose<n_points>(padded);
        for (int i = 0; i < n; ++i)
          result[i] = padded[i];
      }
    return result;
  }
} // namespace limber

#endif
