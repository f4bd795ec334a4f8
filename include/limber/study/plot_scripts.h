// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_plot_scripts_h
#define limber_study_plot_scripts_h

#include <string>

/** @file Where the scripts are that draw, what runs them, and their commands.
 */
namespace limber
{
  /**
   * Path of a script of contrib/plot: of the installed ones if this program is
   * installed with them, else of those it was built with. The file may be
   * missing.
   */
  std::string
  plot_script(const std::string &name);

  /**
   * The Python that runs them: LIMBER_PYTHON, else that of the system, which
   * has the system's matplotlib, else the first one in the path.
   */
  std::string
  plot_python();

  /** Whether the first word of the command line is `plot` or `animate`. */
  bool
  is_plot_command(const int argc, const char *const *argv);

  /**
   * End this process and begin that of the script, so that its exit code is
   * ours. Throws FileError where script or Python cannot be started.
   */
  int
  run_plot_command(const int argc, const char *const *argv);
} // namespace limber

#endif
