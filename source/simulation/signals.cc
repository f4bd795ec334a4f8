// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/simulation/signals.h>

#include <csignal>

namespace limber
{
  namespace
  {
    volatile std::sig_atomic_t caught = 0;
  }



  void
  catch_signals()
  {
    const auto note = [](const int number) { caught = number; };
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
  }



  int
  caught_signal()
  {
    return caught;
  }
} // namespace limber
