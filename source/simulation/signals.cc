// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/simulation/signals.h>

#include <csignal>

namespace limber
{
  namespace
  {
    volatile std::sig_atomic_t caught = 0;

    // By 'nohup', and so it stays
    bool hang_up_is_ignored = false;
  } // namespace



  void
  catch_signals()
  {
    void (*const note)(int) = [](const int number) { caught = number; };
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
    std::signal(SIGUSR1, note);
    std::signal(SIGHUP, hang_up_is_ignored ? SIG_IGN : note);
  }



  void
  prepare_signals()
  {
    struct sigaction former;
    hang_up_is_ignored =
      sigaction(SIGHUP, nullptr, &former) == 0 && former.sa_handler == SIG_IGN;
    std::signal(SIGXFSZ, SIG_IGN);
  }



  int
  caught_signal()
  {
    return caught;
  }
} // namespace limber
