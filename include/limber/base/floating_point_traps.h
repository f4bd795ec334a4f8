// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_floating_point_traps_h
#define limber_base_floating_point_traps_h

#include <cfenv>

namespace limber
{
  /**
   * While it exists, divisions by zero and the like do not trap, which they do
   * in debug builds: where formulas of a scene are evaluated, whether they are
   * finite is a question. It takes as long as a formula or two, so hold it
   * around many.
   */
  class HeldFloatingPointTraps
  {
  public:
    HeldFloatingPointTraps()
    {
      std::feholdexcept(&environment);
    }

    ~HeldFloatingPointTraps()
    {
      std::fesetenv(&environment);
    }

    HeldFloatingPointTraps(const HeldFloatingPointTraps &) = delete;

    HeldFloatingPointTraps &
    operator=(const HeldFloatingPointTraps &) = delete;

  private:
    std::fenv_t environment;
  };
} // namespace limber

#endif
