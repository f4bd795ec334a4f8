// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/base/text_file.h>
#include <limber/output/own_folder.h>

#include <system_error>

namespace limber
{
  namespace
  {
    namespace fs = std::filesystem;



    fs::file_type
    file_type_of(const fs::path &path)
    {
      std::error_code error;
      return fs::symlink_status(path, error).type();
    }



    bool
    exists_itself(const fs::path &path)
    {
      const auto type = file_type_of(path);
      return type != fs::file_type::not_found && type != fs::file_type::none;
    }



    /** Whether it is empty or missing. */
    bool
    is_free(const std::string &folder)
    {
      if (file_type_of(folder) == fs::file_type::not_found)
        return true;
      for (const auto &entry : fs::directory_iterator(folder))
        if (entry.path().filename() != folder_mark)
          return false;
      return true;
    }



    std::string
    name_in(const fs::path &path, const std::string &folder)
    {
      return in_quotes(path.lexically_relative(folder).string());
    }



    [[noreturn]] void
    refuse_taken(const std::string &folder,
                 const FolderKind  &kind,
                 const fs::path    &path)
    {
      const std::string maker = kind.maker, entry = kind.entry;
      if (is_made(folder, kind))
        throw InputError(
          "The folder " + in_quotes(folder) + " holds a " + maker +
          " already: " + name_in(path, folder) + " is in it ('" + entry +
          "'). Usually the same was done before. Choose "
          "another folder, set " +
          kind.replace_by + " to overwrite it" + kind.go_on_by + ".");
      throw InputError("The folder " + in_quotes(folder) + " holds " +
                       name_in(path, folder) + ", which no " + maker +
                       " wrote and which would be overwritten ('" + entry +
                       "'). Usually it is a folder of your own files. Choose "
                       "another, for instance 'output/first'.");
    }



    [[noreturn]] void
    refuse_foreign(const std::string &folder, const FolderKind &kind)
    {
      throw InputError("The folder " + in_quotes(folder) +
                       " is not replaced: no " + kind.maker +
                       " made it, and it is not empty ('" + kind.entry +
                       "'). Usually it is a folder of your own files. Choose "
                       "another, for instance 'output/first', or leave out " +
                       kind.replace_by + ".");
    }



    [[noreturn]] void
    refuse_type(const std::string &folder,
                const FolderKind  &kind,
                const fs::path    &path)
    {
      const bool link = file_type_of(path) == fs::file_type::symlink;
      throw InputError("In the folder " + in_quotes(folder) + " the name " +
                       name_in(path, folder) + " belongs to " +
                       (link ? "a symbolic link" :
                               "something that a " + std::string(kind.maker) +
                                 " does not write") +
                       " ('" + kind.entry +
                       "'). Usually it was put there by hand; nothing is "
                       "written through it. Remove it, or choose another "
                       "folder, for instance 'output/first'.");
    }



    /** Under the names of files there have to be files, under those of folders
     * folders; links are neither. */
    void
    check_types(const std::string &folder,
                const FolderKind  &kind,
                const OwnPaths    &own,
                const bool         links_to_files)
    {
      for (const fs::path &path : own.files)
        if (const auto type = file_type_of(path);
            type != fs::file_type::regular &&
            !(links_to_files && type == fs::file_type::symlink))
          refuse_type(folder, kind, path);
      for (const fs::path &path : own.folders)
        if (file_type_of(path) != fs::file_type::directory)
          refuse_type(folder, kind, path);
    }



    /** Throws unless the folder may be used so. */
    void
    examine(const std::string &folder,
            const FolderKind  &kind,
            const FolderUse    use)
    {
      if (use == FolderUse::replace && !is_made(folder, kind) &&
          !is_free(folder))
        refuse_foreign(folder, kind);
      const OwnPaths own = kind.own_paths(folder);
      if (!own.files.empty() &&
          (use == FolderUse::fresh ||
           (use == FolderUse::resume && !is_made(folder, kind))))
        refuse_taken(folder, kind, own.files.front());
      check_types(folder, kind, own, use == FolderUse::replace);
    }



    /** Throws if a process is at work in one of the folders. */
    void
    remove_all_of(const OwnPaths &own)
    {
      std::vector<FolderLock> locks;
      for (const std::string &folder : own.locked)
        locks.emplace_back(folder);
      for (const fs::path &path : own.files)
        fs::remove(path);
      for (const fs::path &path : own.folders)
        if (fs::is_empty(path))
          fs::remove(path);
    }



    /** What the system does not permit is a FileError. */
    template <typename Task>
    void
    with_file_errors(const std::string &folder, const Task &task)
    {
      try
        {
          task();
        }
      catch (const fs::filesystem_error &caught)
        {
          throw cannot_write(caught.path1().empty() ? folder :
                                                      caught.path1().string(),
                             caught.code().message());
        }
    }
  } // namespace



  void
  OwnPaths::add_file(const fs::path &path)
  {
    fs::path part = path;
    part += ".part";
    for (const fs::path &name : {part, path})
      if (exists_itself(name))
        files.push_back(name);
  }



  void
  OwnPaths::add_folder(const fs::path &path)
  {
    if (exists_itself(path))
      folders.push_back(path);
  }



  void
  OwnPaths::append(const OwnPaths &others)
  {
    files.insert(files.end(), others.files.begin(), others.files.end());
    folders.insert(folders.end(), others.folders.begin(), others.folders.end());
    locked.insert(locked.end(), others.locked.begin(), others.locked.end());
  }



  bool
  is_made(const std::string &folder, const FolderKind &kind)
  {
    bool made = false;
    with_file_errors(folder, [&]() {
      made = maker_of(folder) == kind.maker || kind.looks_made(folder);
    });
    return made;
  }



  FolderLock
  claim_folder(const std::string &folder,
               const FolderKind  &kind,
               const FolderUse    use)
  {
    FolderLock lock;
    with_file_errors(folder, [&]() {
      // The mark must not get into a folder that is not ours, so this is
      // checked before the lock, and again when nobody else can change it.
      examine(folder, kind, use);
      lock = FolderLock(folder);
      examine(folder, kind, use);
      lock.sign(kind.maker);
      if (use == FolderUse::replace)
        remove_all_of(kind.own_paths(folder));
    });
    return lock;
  }



  std::string
  objection_to(const std::string &folder,
               const FolderKind  &kind,
               const FolderUse    use)
  {
    try
      {
        examine(folder, kind, use);
      }
    catch (const InputError &refusal)
      {
        return refusal.what();
      }
    catch (const fs::filesystem_error &)
      {}
    return "";
  }



  void
  remove_own(const std::string &folder, const FolderKind &kind)
  {
    with_file_errors(folder, [&]() {
      if (file_type_of(folder) != fs::file_type::directory ||
          !is_made(folder, kind))
        return;
      const FolderLock lock(folder);
      const OwnPaths   own = kind.own_paths(folder);
      check_types(folder, kind, own, /*links_to_files=*/true);
      remove_all_of(own);
      fs::remove(fs::path(folder) / folder_mark);
      if (fs::is_empty(folder))
        fs::remove(folder);
    });
  }
} // namespace limber
