// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_open_mpi_h
#define limber_base_open_mpi_h

/**
 * @file What Open MPI has to know before it starts, through the environment.
 * Who has set it there is obeyed. Other MPIs do not look at it.
 */
namespace limber
{
  void
  tune_open_mpi();

  /**
   * For a program that is one process alone, whatever job its parent is in: it
   * starts ten times faster without a daemon, and without a folder for a
   * session, which all such processes share: the first to end removes it, and
   * one that starts at this moment cannot.
   */
  void
  isolate_from_jobs();
} // namespace limber

#endif
