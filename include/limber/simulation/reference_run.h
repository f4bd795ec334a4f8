// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_reference_run_h
#define limber_simulation_reference_run_h

#include <limber/base/console.h>
#include <limber/simulation/command_line.h>

namespace limber
{
  /**
   * `limber reference scene.prm`: the scene in finite elements, with a run
   * folder of its own. A folder that holds the finished reference of the same
   * scene is left as it is, and its result is told again. Returns success or
   * check_missed; throws a Failure otherwise. Collective.
   */
  int
  run_reference(const CommandLine &command, Console &console);
} // namespace limber

#endif
