// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_run_folder_h
#define limber_output_run_folder_h

#include <deal.II/base/mpi.h>

#include <limber/problem/read_problem.h>

#include <string>

namespace limber
{
  /** The texts by which a run folder explains itself. */
  struct RunTexts
  {
    std::string original; // the scene as given, with its comments
    bool        original_is_json = false;
    std::string parameters_prm; // all entries as used
    std::string parameters_json;
  };



  /**
   * Create the folder of a run, with those above it. A folder that holds a
   * run already is refused with an InputError unless @p replace; then what
   * the former run wrote is deleted, and nothing else. Throws FileError where
   * the system does not permit it. Collective: the first rank works, and all
   * ranks throw what it throws.
   */
  void
  prepare_run_folder(const std::string &folder,
                     const bool         replace,
                     MPI_Comm           communicator);

  /** Those of a scene. */
  RunTexts
  run_texts(const SceneFile &scene);

  /** Write the texts into the folder; collective likewise. */
  void
  write_run_texts(const std::string &folder,
                  const RunTexts    &texts,
                  MPI_Comm           communicator);
} // namespace limber

#endif
