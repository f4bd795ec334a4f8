// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_signals_h
#define limber_simulation_signals_h

namespace limber
{
  /** From now on interrupt and termination only leave a note. */
  void
  catch_signals();

  /** The number of the signal that has arrived, or 0. */
  int
  caught_signal();
} // namespace limber

#endif
