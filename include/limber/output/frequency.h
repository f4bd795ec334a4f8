// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_frequency_h
#define limber_output_frequency_h

#include <limits>

namespace limber
{
  /**
   * The frequency of a quantity that swings about zero, from the times at
   * which it changes its sign, interpolated linearly between rows: the mean
   * over all half periods so far. Plain, for checkpoints.
   */
  struct ZeroCrossings
  {
    double       last_time  = 0; // of the last row, s
    double       last_value = 0;
    int          sign       = 0; // the last that was not zero
    unsigned int count      = 0;
    double       first      = 0; // time of the first crossing, s
    double       last       = 0; // and of the last

    /** A further row; values that are not a number are passed over. */
    void
    add(const double time, const double value)
    {
      if (!(value == value))
        return;
      const int new_sign = (value > 0) - (value < 0);
      if (sign * new_sign < 0)
        {
          const double share = last_value / (last_value - value);
          last               = last_time + share * (time - last_time);
          if (count++ == 0)
            first = last;
        }
      if (new_sign != 0)
        sign = new_sign;
      last_time  = time;
      last_value = value;
    }

    /** Hz; not a number before the second crossing. */
    double
    frequency() const
    {
      return count < 2 ? std::numeric_limits<double>::quiet_NaN() :
                         0.5 * (count - 1) / (last - first);
    }
  };
} // namespace limber

#endif
