// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/base/text_file.h>
#include <limber/output/folder_lock.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace limber
{
  namespace
  {
    /** "limber run on host 'kant', process 4711": the words behind the key. */
    std::string
    word_behind(const std::string &key, const std::string &text)
    {
      const auto place = text.find(key);
      if (place == std::string::npos)
        return "";
      const auto begin = place + key.size();
      return text.substr(begin, text.find_first_of(" \n", begin) - begin);
    }



    std::string
    text_of(const std::string &path)
    {
      std::ostringstream text;
      if (std::filesystem::is_regular_file(
            std::filesystem::symlink_status(path)))
        text << std::ifstream(path).rdbuf();
      return text.str();
    }



    std::string
    host_name()
    {
      char name[256] = "";
      gethostname(name, sizeof(name) - 1);
      return name;
    }



    [[noreturn]] void
    refuse_second(const std::string &folder, const std::string &mark)
    {
      // The process that has just locked it may not have signed yet.
      constexpr useconds_t moment = 50000;
      if (text_of(mark).empty())
        usleep(moment);
      const std::string text    = text_of(mark);
      const std::string process = word_behind("process ", text);
      throw InputError("The folder " + in_quotes(folder) +
                       " is in use by process " +
                       (process.empty() ? "'unknown'" : process) + " on host " +
                       in_quotes(word_behind("host ", text)) +
                       ". Usually the same scene or study is running there, in "
                       "another terminal or job. Wait until it ends, stop it, "
                       "or choose another folder with --output-directory.");
    }



    /** Whether a path still leads to the file that was opened there. */
    bool
    is_same(const int file, const std::string &path)
    {
      struct stat own, there;
      return fstat(file, &own) == 0 && lstat(path.c_str(), &there) == 0 &&
             own.st_dev == there.st_dev && own.st_ino == there.st_ino;
    }



    int
    open_mark(const std::string &path)
    {
      const int file =
        open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
      if (file < 0 && errno == ELOOP)
        throw InputError("The file " + in_quotes(path) +
                         " is a symbolic link. Limber keeps it to tell whose "
                         "the folder is and follows no links. Remove it, or "
                         "choose another folder with --output-directory.");
      if (file < 0)
        throw cannot_write(path, std::strerror(errno));
      return file;
    }
  } // namespace



  std::string
  maker_of(const std::string &folder)
  {
    return word_behind("limber ", text_of(folder + "/" + folder_mark));
  }



  FolderLock::FolderLock(const std::string &folder)
    : path(folder + "/" + folder_mark)
  {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
      throw cannot_write(folder, error.message());
    // Who held it before may have removed the file with its folder; not all
    // file systems number their files so that this can be told.
    constexpr unsigned int attempts = 10;
    for (unsigned int i = 0; i < attempts; ++i)
      {
        take(folder);
        if (is_same(file, path))
          break;
      }
  }



  void
  FolderLock::take(const std::string &folder)
  {
    if (file >= 0)
      close(file);
    file = open_mark(path);
    int failed;
    do
      failed = flock(file, LOCK_EX | LOCK_NB);
    while (failed != 0 && errno == EINTR);
    if (failed == 0)
      return;
    const int reason = errno;
    if (reason == EWOULDBLOCK)
      {
        close(std::exchange(file, -1));
        refuse_second(folder, path);
      }
    without_locks = "The folder " + in_quotes(folder) +
                    " cannot be locked: " + std::strerror(reason) +
                    ". Its file system has no locks, so nothing would stop a "
                    "second run from spoiling this one. See that none is "
                    "started there.";
  }



  FolderLock::FolderLock(FolderLock &&other)
    : path(std::move(other.path))
    , file(std::exchange(other.file, -1))
    , without_locks(std::move(other.without_locks))
  {}



  FolderLock &
  FolderLock::operator=(FolderLock &&other)
  {
    std::swap(path, other.path);
    std::swap(file, other.file);
    std::swap(without_locks, other.without_locks);
    return *this;
  }



  FolderLock::~FolderLock()
  {
    if (file >= 0)
      close(file);
  }



  void
  FolderLock::sign(const std::string &maker) const
  {
    const std::string text = "limber " + maker + "\nhost " + host_name() +
                             "\nprocess " + std::to_string(getpid()) + "\n";
    // One call, so that nobody reads half of it.
    if (ftruncate(file, 0) != 0 ||
        pwrite(file, text.data(), text.size(), 0) != ssize_t(text.size()))
      throw cannot_write(path, std::strerror(errno));
  }
} // namespace limber
