// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_frequency_h
#define limber_output_frequency_h

#include <algorithm>
#include <cmath>
#include <limits>

namespace limber
{
  /**
   * Frequency of a quantity that oscillates about zero, from its zero
   * crossings, interpolated linearly between rows: the mean over all half
   * periods so far. Noise may cause several crossings in a row: these count
   * once, half way between the first and the last, and not at all if the sign
   * does not change in the end. Plain data, for checkpoints.
   */
  struct ZeroCrossings
  {
    /** Share of the largest value of a half period above which the next one has
     * begun. */
    static constexpr double share_of_swing = 0.2;

    double       last_time   = 0; // of the last row, s
    double       last_value  = 0;
    int          side        = 0; // sign of the last that was not zero
    int          swing_sign  = 0; // of the half swing, which may have noise
    double       swing       = 0; // the largest of its values
    unsigned int count       = 0;
    double       first       = 0; // time of the first crossing, s
    double       last        = 0; // and of the last
    double       before      = 0; // of the one before it
    double       entered     = 0; // when it went over first, of several times
    bool         is_crossing = false; // and has settled on neither side yet

    /** A further row; values that are not a number are passed over. */
    void
    add(const double time, const double value)
    {
      if (!(value == value))
        return;
      const int new_side = (value > 0) - (value < 0);
      if (side * new_side < 0)
        cross(new_side,
              last_time +
                last_value / (last_value - value) * (time - last_time));
      if (new_side != 0)
        side = new_side;
      if (swing_sign == 0)
        swing_sign = side;

      const double size = std::abs(value);
      if (size > share_of_swing * swing)
        {
          if (side != swing_sign)
            swing = 0;
          swing_sign  = side;
          is_crossing = false;
        }
      if (side == swing_sign)
        swing = std::max(swing, size);
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

  private:
    void
    cross(const int new_side, const double time)
    {
      if (new_side == swing_sign)
        {
          --count;
          last = before;
          return;
        }
      if (!is_crossing)
        {
          entered     = time;
          is_crossing = true;
        }
      before = last;
      last   = 0.5 * (entered + time);
      if (count++ == 0)
        first = last;
    }
  };
} // namespace limber

#endif
