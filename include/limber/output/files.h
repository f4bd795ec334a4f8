// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_files_h
#define limber_output_files_h

#include <deal.II/base/mpi.h>

#include <limber/base/text_file.h>

#include <functional>
#include <optional>
#include <string>

namespace limber
{
  /**
   * Make @p path hold @p text and nothing else. It is written under another
   * name and then renamed, so that a reader never sees half of it, and a
   * symbolic link is replaced rather than followed. Throws FileError.
   */
  void
  write_whole_file(const std::string &path, const std::string &text);

  /**
   * The failure of any rank, thrown on all of them: of several, that of the
   * lowest rank. Nothing happens where no rank has failed. Collective.
   */
  void
  throw_together(const std::optional<Failure> &own, MPI_Comm communicator);

  /** Run @p task on the first rank; what it throws, all ranks throw. */
  void
  on_first_rank(MPI_Comm communicator, const std::function<void()> &task);
} // namespace limber

#endif
