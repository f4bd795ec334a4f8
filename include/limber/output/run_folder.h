// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_run_folder_h
#define limber_output_run_folder_h

#include <deal.II/base/mpi.h>

#include <limber/output/own_folder.h>
#include <limber/problem/read_problem.h>

#include <string>

namespace limber
{
  /** The texts in a run folder that document the run. */
  struct RunTexts
  {
    std::string original; // the scene as given, with its comments
    bool        original_is_json = false;
    std::string parameters_prm; // all entries as used
    std::string parameters_json;
  };



  /** The output folder of a run or of a reference. */
  const FolderKind &
  run_folder_kind();

  /**
   * Create the folder of a run, with those above it, and lock it while the
   * result lives. What is refused, and what @p replace removes, says
   * claim_folder(). Throws InputError, FileError. Collective: the first rank
   * works and holds the lock, and all ranks throw what it throws.
   */
  FolderLock
  prepare_run_folder(const std::string &folder,
                     const bool         replace,
                     MPI_Comm           communicator);

  /** Lock the folder of a run that is to go on; collective likewise. */
  FolderLock
  reopen_run_folder(const std::string &folder, MPI_Comm communicator);

  /**
   * Lock the folder of a run that is compared. Throws InputError if a process
   * is at work there, or if what stands under the names of the two results,
   * comparison and comparison.json, is not that of a former comparison. For
   * one rank.
   */
  FolderLock
  lock_for_comparison(const std::string &folder);

  /** The texts of a scene. */
  RunTexts
  run_texts(const SceneFile &scene);

  /** Write the texts into the folder; collective likewise. */
  void
  write_run_texts(const std::string &folder,
                  const RunTexts    &texts,
                  MPI_Comm           communicator);
} // namespace limber

#endif
