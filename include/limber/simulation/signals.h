// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_signals_h
#define limber_simulation_signals_h

namespace limber
{
  /**
   * From now on SIGINT, SIGTERM, SIGUSR1 and, unless it is ignored, SIGHUP
   * only leave a note.
   */
  void
  catch_signals();

  /**
   * First of all, since MPI_InitFinalize sets signals back: find out whether
   * SIGHUP is ignored. And a file beyond the size that is allowed (`ulimit
   * -f`) shall not end the program by SIGXFSZ: writing it fails, which has a
   * message.
   */
  void
  prepare_signals();

  /** The number of the signal that has arrived, or 0. */
  int
  caught_signal();
} // namespace limber

#endif
