// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_run_info_h
#define limber_base_run_info_h

#include <string>

namespace limber
{
  /** What has to be known to repeat a run, apart from the scene. */
  struct RunInfo
  {
    std::string  version, revision;
    bool         debug = false;
    std::string  deal_ii, trilinos, p4est; // versions
    unsigned int ranks = 1;
  };

  /** About this program, in this process. */
  RunInfo
  run_info();

  /** The first lines of every run and what --version prints. */
  std::string
  banner(const RunInfo &info);
} // namespace limber

#endif
