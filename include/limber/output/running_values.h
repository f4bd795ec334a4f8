// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_running_values_h
#define limber_output_running_values_h

#include <algorithm>

namespace limber
{
  /**
   * Mean over time and extremes of a quantity so far, linear between rows.
   * Plain data, for checkpoints.
   */
  struct RunningValues
  {
    bool   any        = false; // whether there was a value
    double first_time = 0;     // of the rows that count, s
    double last_time  = 0;
    double last_value = 0;
    double integral   = 0; // over time
    double smallest   = 0;
    double largest    = 0;

    /** A further row; values that are not a number are passed over. */
    void
    add(const double time, const double value)
    {
      if (!(value == value))
        return;
      if (any)
        integral += 0.5 * (last_value + value) * (time - last_time);
      else
        first_time = time;
      smallest   = any ? std::min(smallest, value) : value;
      largest    = any ? std::max(largest, value) : value;
      any        = true;
      last_time  = time;
      last_value = value;
    }

    /** Of one value alone, that value; not to be asked before the first. */
    double
    mean() const
    {
      return last_time > first_time ? integral / (last_time - first_time) :
                                      last_value;
    }
  };
} // namespace limber

#endif
