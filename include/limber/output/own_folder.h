// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_own_folder_h
#define limber_output_own_folder_h

#include <limber/output/folder_lock.h>

#include <filesystem>
#include <string>
#include <vector>

namespace limber
{
  /** File names that a run or a study writes. */
  struct OwnPaths
  {
    // Files, and then the folders that hold them, inner ones first
    std::vector<std::filesystem::path> files, folders;
    // Those of the folders that have a lock of their own
    std::vector<std::string> locked;

    /** Look for a file, under this name or that of its unfinished part. */
    void
    add_file(const std::filesystem::path &path);

    void
    add_folder(const std::filesystem::path &path);

    void
    append(const OwnPaths &others);
  };



  /** A kind of folder: of a run or of a study. */
  struct FolderKind
  {
    const char *maker;      // "run" or "study"
    const char *entry;      // that names the folder
    const char *replace_by; // how the user allows to replace it
    const char *go_on_by;   // how else it may be used again; empty: not

    OwnPaths (*own_paths)(const std::string &folder);
    // Made by a version that left no mark
    bool (*looks_made)(const std::string &folder);
  };

  /** What happens to results that a folder already has. */
  enum class FolderUse
  {
    fresh,   // none of the names may be taken
    replace, // existing results are removed
    resume   // existing results are continued
  };

  /** Whether a folder was made by one of this kind. */
  bool
  is_made(const std::string &folder, const FolderKind &kind);

  /**
   * Lock a folder and make it ready, with those above it. Throws InputError,
   * and leaves everything as it is, where
   *
   * - another process has the folder;
   * - fresh: a name that would be written is taken;
   * - replace: nothing of this kind made the folder, and it is not empty;
   * - resume: nothing of this kind made the folder, and a name is taken;
   * - under such a name there is what is never written, a symbolic link for
   *   instance (replace removes the link alone, if it stands for a file).
   *
   * Throws FileError where the system does not permit it. For one rank.
   */
  FolderLock
  claim_folder(const std::string &folder,
               const FolderKind  &kind,
               const FolderUse    use);

  /**
   * Why claim_folder() would refuse the folder as it is now, but for other
   * processes and what the system does not permit; empty if it would not.
   */
  std::string
  objection_to(const std::string &folder,
               const FolderKind  &kind,
               const FolderUse    use);

  /**
   * Remove what one of this kind wrote there, its mark, and the folder if
   * nothing else is in it. Nothing happens to a folder that it did not make.
   * Throws InputError if a process is at work there, FileError.
   */
  void
  remove_own(const std::string &folder, const FolderKind &kind);
} // namespace limber

#endif
