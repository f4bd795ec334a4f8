// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_timing_h
#define limber_base_timing_h

#include <ctime>

namespace limber
{
  /** CPU time of this process, s. */
  inline double
  cpu_time()
  {
    std::timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
  }



  /** Wall time since an arbitrary start, s. */
  inline double
  wall_time()
  {
    std::timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
  }



  /**
   * Wall time per verb of the step on this rank. Nothing communicates here;
   * lap() costs some 25 ns, so it is called per verb and never per point.
   */
  class Stopwatch
  {
  public:
    /** Start counting anew; what passed since the last lap is left out. */
    void
    start()
    {
      last = wall_time();
    }

    /** Book the time since the last call to a verb. */
    void
    lap(double &verb)
    {
      const double now = wall_time();
      verb += now - last;
      last = now;
    }

  private:
    double last = 0;
  };
} // namespace limber

#endif
