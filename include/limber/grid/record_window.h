// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_grid_record_window_h
#define limber_grid_record_window_h

#include <limber/base/pack.h>
#include <limber/grid/grid_view.h>

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
    using Lanes = Pack<int(width)>;

    static constexpr unsigned int
    lane_of(const unsigned int slot)
    {
      return slot - start;
    }
  };
} // namespace limber

#endif
