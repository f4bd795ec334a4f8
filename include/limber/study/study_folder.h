// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_folder_h
#define limber_study_study_folder_h

#include <limber/output/own_folder.h>

namespace limber
{
  /**
   * The folder of a study: table, texts and chart, the run folders in `runs`
   * with what was noted about each beside it, and what the variants are
   * compared with.
   */
  const FolderKind &
  study_folder_kind();

  /**
   * Throws InputError if there is anything where a variant is to be run, or
   * under the names of what is written beside it.
   */
  void
  refuse_taken_run(const std::string &folder);

  /**
   * Remove a run of a study: what it wrote in @p folder, and what the study
   * wrote beside it. Throws InputError if it is still going on, FileError.
   */
  void
  remove_run_of_study(const std::string &folder);
} // namespace limber

#endif
