// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/base/text_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace limber
{
  namespace
  {
    int
    flags_of(const TextFile::Mode mode)
    {
      const int common = O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC;
      switch (mode)
        {
          case TextFile::Mode::fresh:
            return common | O_EXCL;
          case TextFile::Mode::append:
            return common | O_APPEND;
          default:
            return common | O_TRUNC;
        }
    }



    FileError
    was_removed(const std::string &path)
    {
      return FileError("The file " + in_quotes(path) +
                       " was removed while it was being written, and what "
                       "follows would be lost. Usually its folder was deleted "
                       "or replaced. Run again, with another "
                       "'Output/Directory' if it is to last.");
    }



    struct stat
    status_of(const int file, const std::string &path)
    {
      struct stat status;
      if (fstat(file, &status) != 0)
        throw cannot_write(path, std::strerror(errno));
      return status;
    }
  } // namespace



  FileError
  cannot_write(const std::string &path, const std::string &reason)
  {
    return FileError("The file " + in_quotes(path) +
                     " could not be written: " + reason +
                     ". Usually the disk or the quota is full, or writing is "
                     "not permitted there. Make room, or set "
                     "'Output/Directory' to another folder.");
  }



  TextFile::TextFile(const std::string &path, const Mode mode)
    : path(path)
    , file(open(path.c_str(), flags_of(mode), 0666))
  {
    if (file < 0)
      throw cannot_write(path,
                         errno == ELOOP ? "it is a symbolic link" :
                                          std::strerror(errno));
  }



  TextFile::~TextFile()
  {
    if (file >= 0)
      ::close(file);
  }



  void
  TextFile::write(const std::string &text)
  {
    const struct stat before = status_of(file, path);
    if (before.st_nlink == 0)
      throw was_removed(path);
    for (std::size_t done = 0; done < text.size();)
      {
        const ssize_t n = ::write(file, text.data() + done, text.size() - done);
        if (n < 0 && errno == EINTR)
          continue;
        if (n <= 0)
          {
            const int reason = n < 0 ? errno : ENOSPC;
            // Take out an incomplete row, which would be read as a whole one.
            // If this fails as well, the first failure is the one to report.
            const bool cut =
              S_ISREG(before.st_mode) && ftruncate(file, before.st_size) == 0;
            static_cast<void>(cut);
            throw cannot_write(path, std::strerror(reason));
          }
        done += n;
      }
  }



  std::uintmax_t
  TextFile::length() const
  {
    return status_of(file, path).st_size;
  }



  void
  TextFile::shorten(const std::uintmax_t length)
  {
    if (ftruncate(file, length) != 0)
      throw cannot_write(path, std::strerror(errno));
  }



  void
  TextFile::close()
  {
    if (file < 0)
      return;
    const bool removed = status_of(file, path).st_nlink == 0;
    const int  own     = file;
    file               = -1;
    if (::close(own) != 0)
      throw cannot_write(path, std::strerror(errno));
    if (removed)
      throw was_removed(path);
  }
} // namespace limber
