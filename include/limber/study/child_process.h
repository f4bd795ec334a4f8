// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_child_process_h
#define limber_study_child_process_h

#include <string>
#include <vector>

namespace limber
{
  /** How a program ended that was started by run_child(). */
  struct ChildEnd
  {
    int    exit_code = 0;     // 128 + n where signal n has ended it
    bool   killed    = false; // by a signal that it did not catch
    bool   timed_out = false; // by us, at the time limit
    double seconds   = 0;     // wall time
  };

  /**
   * Run a program to its end, its standard output and error in the file @p
   * log. After @p time_limit seconds it is terminated, ten seconds later
   * killed. To be called before MPI is initialised: the child brings its own.
   * Throws FileError where it cannot be started.
   */
  ChildEnd
  run_child(const std::vector<std::string> &command,
            const std::string              &log,
            const double                    time_limit);

  /** Path of the program that is running. */
  std::string
  this_program();
} // namespace limber

#endif
