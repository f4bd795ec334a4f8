// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_folder_lock_h
#define limber_output_folder_lock_h

#include <string>

namespace limber
{
  /** The file by which a folder is known as ours, and which is locked. */
  constexpr const char *folder_mark = ".limber";

  /** What has made a folder: "run" or "study"; empty: nothing of ours. */
  std::string
  maker_of(const std::string &folder);



  /**
   * The right to write into a folder, which one process has at a time: a lock
   * (flock) on the file .limber in it. The system takes the lock back when the
   * process ends, however it ends; the file stays and tells what made the
   * folder. Children do not inherit the lock. Nothing here communicates.
   */
  class FolderLock
  {
  public:
    /** Holds nothing. */
    FolderLock() = default;

    /**
     * Lock @p folder, which is created with those above it. Throws InputError
     * with host and process of the holder if there is one, FileError where the
     * file cannot be made.
     */
    explicit FolderLock(const std::string &folder);

    FolderLock(FolderLock &&other);
    FolderLock &
    operator=(FolderLock &&other);
    ~FolderLock();

    /** Write down that @p maker, "run" or "study", has the folder now. */
    void
    sign(const std::string &maker) const;

    /**
     * What to warn of where the file system has no locks: then nothing keeps
     * a second process away. Else empty.
     */
    const std::string &
    warning() const
    {
      return without_locks;
    }

  private:
    void
    take(const std::string &folder);

    std::string path;
    int         file = -1;
    std::string without_locks;
  };
} // namespace limber

#endif
