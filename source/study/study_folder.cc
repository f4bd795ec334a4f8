// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/base/text_file.h>
#include <limber/output/run_folder.h>
#include <limber/study/study_folder.h>

#include <fstream>
#include <set>

namespace limber
{
  namespace
  {
    namespace fs = std::filesystem;



    /** NAME.done, as a study writes it. */
    bool
    is_note(const fs::path &path)
    {
      std::ifstream file(path);
      std::string   word;
      return fs::is_regular_file(fs::symlink_status(path)) &&
             path.extension() == ".done" && file >> word && word == "ended";
    }



    const char *const endings[] = {".log", ".done", ".comparison.log"};



    /** What a child has said is beside its folder before it begins. */
    bool
    is_run_of_study(const fs::path &folder)
    {
      return fs::is_regular_file(
               fs::symlink_status(fs::path(folder) += ".log")) &&
             is_made(folder.string(), run_folder_kind());
    }



    /** What a run wrote, and what the study wrote beside it. */
    void
    add_run(const fs::path &folder, OwnPaths &own)
    {
      for (const char *const ending : endings)
        own.add_file(fs::path(folder) += ending);
      if (!is_run_of_study(folder))
        return;
      OwnPaths run = run_folder_kind().own_paths(folder.string());
      run.add_file(folder / folder_mark);
      run.add_folder(folder);
      run.locked.push_back(folder.string());
      own.append(run);
    }



    std::set<fs::path>
    runs_in(const fs::path &folder)
    {
      std::set<fs::path> runs;
      if (fs::is_directory(fs::symlink_status(folder)))
        for (const auto &entry : fs::directory_iterator(folder))
          {
            fs::path path = entry.path();
            if (is_run_of_study(path))
              runs.insert(path);
            else if (is_note(path))
              runs.insert(path.replace_extension());
          }
      return runs;
    }



    OwnPaths
    paths_of_study(const std::string &folder)
    {
      OwnPaths own;
      for (const char *const name : {"study.csv",
                                     "study.json",
                                     "study.md",
                                     "study.svg",
                                     "study.png",
                                     "chart.log"})
        own.add_file(fs::path(folder) / name);
      const fs::path runs = fs::path(folder) / "runs";
      for (const fs::path &run : runs_in(runs))
        add_run(run, own);
      own.add_folder(runs);
      add_run(fs::path(folder) / "comparison", own);
      return own;
    }



    bool
    has_notes_of_study(const std::string &folder)
    {
      const fs::path runs = fs::path(folder) / "runs";
      if (fs::is_directory(fs::symlink_status(runs)))
        for (const auto &entry : fs::directory_iterator(runs))
          if (is_note(entry.path()))
            return true;
      return false;
    }
  } // namespace



  const FolderKind &
  study_folder_kind()
  {
    static const FolderKind kind = {"study",
                                    "Directory",
                                    "'Replace = true'",
                                    ", or go on with it by --resume",
                                    paths_of_study,
                                    has_notes_of_study};
    return kind;
  }



  void
  refuse_taken_run(const std::string &folder)
  {
    OwnPaths own;
    for (const char *const ending : endings)
      own.add_file(folder + ending);
    own.add_file(folder);
    if (!own.files.empty())
      throw InputError("The name " + in_quotes(own.files.front().string()) +
                       " is taken, but a variant of the study would be run "
                       "there. Usually it belongs to another work of yours. "
                       "Choose another '--output-directory', for instance "
                       "'studies/first'.");
  }



  void
  remove_run_of_study(const std::string &folder)
  {
    if (is_run_of_study(folder))
      remove_own(folder, run_folder_kind());
    for (const char *const ending : endings)
      {
        std::error_code error;
        fs::remove(folder + ending, error);
        if (error)
          throw cannot_write(folder + ending, error.message());
      }
  }
} // namespace limber
