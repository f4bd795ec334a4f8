// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_commands_h
#define limber_study_commands_h

namespace limber
{
  /** Whether the first word of the command line is `study` or one of its kin.
   */
  bool
  is_study_command(const int argc, const char *const *argv);

  /**
   * Do what the first word says and return the exit code. To be called before
   * MPI is initialised: the runs of a study are processes with an MPI of their
   * own. Throws Failure.
   */
  int
  run_study_command(const int argc, const char *const *argv);
} // namespace limber

#endif
