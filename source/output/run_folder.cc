// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/output/pieces.h>
#include <limber/output/run_folder.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace limber
{
  namespace
  {
    using Path = std::filesystem::path;



    bool
    is_real_folder(const Path &path)
    {
      return std::filesystem::is_directory(
        std::filesystem::symlink_status(path));
    }



    void
    add_pieces(const Path &folder, const std::string &series, OwnPaths &own)
    {
      const Path pieces = folder / series;
      own.add_folder(pieces);
      if (is_real_folder(pieces))
        for (const auto &entry : std::filesystem::directory_iterator(pieces))
          if (const std::string file = entry.path().filename().string();
              is_piece(file, series) || is_unfinished_piece(file, series))
            own.files.push_back(entry.path());
    }



    void
    add_checkpoint(const Path &folder, OwnPaths &own)
    {
      const Path checkpoint = folder / "checkpoint";
      own.add_folder(checkpoint);
      if (is_real_folder(checkpoint))
        for (const char *const name :
             {"slot_0.h5", "slot_1.h5", "good_slot.txt"})
          own.add_file(checkpoint / name);
    }



    /** What a run, a reference or a comparison with it has written. */
    OwnPaths
    paths_of_run(const std::string &folder)
    {
      OwnPaths own;
      // What runs are best known by comes first, for messages.
      for (const char *const name : {"statistics",
                                     "summary.json",
                                     "parameters.prm",
                                     "parameters.json",
                                     "original.prm",
                                     "original.json",
                                     "log.txt",
                                     "points.pvd",
                                     "grid.pvd",
                                     "frequencies",
                                     "comparison",
                                     "comparison.json"})
        own.add_file(Path(folder) / name);
      for (const char *const series : {"points", "grid", "nodes"})
        add_pieces(folder, series, own);
      add_checkpoint(folder, own);
      return own;
    }



    /** Every run writes these three first of all. */
    bool
    has_texts_of_run(const std::string &folder)
    {
      const auto is_file = [&](const char *const name) {
        return std::filesystem::is_regular_file(
          std::filesystem::symlink_status(Path(folder) / name));
      };
      return (is_file("original.prm") || is_file("original.json")) &&
             is_file("parameters.prm") && is_file("parameters.json");
    }



    void
    refuse_to_resume(const std::string &folder)
    {
      throw InputError("The folder " + in_quotes(folder) +
                       " has no checkpoint to go on from: it is not that of a "
                       "run ('Output/Directory'). Usually --output-directory "
                       "is another one. Name the folder of the run, or run "
                       "without --resume.");
    }



    /** A table or an object with other results may be written anew. */
    void
    check_former_result(const Path &path, const std::string &begins_with)
    {
      const auto status = std::filesystem::symlink_status(path);
      if (!std::filesystem::exists(status))
        return;
      const bool is_file = std::filesystem::is_regular_file(status);
      if (is_file && std::filesystem::file_size(path) == 0)
        return; // of a comparison that was killed
      std::string begin(begins_with.size(), ' ');
      if (is_file)
        std::ifstream(path).read(&begin[0], begin.size());
      if (begin != begins_with)
        throw InputError("The file " + in_quotes(path.string()) +
                         " would be overwritten, but no comparison wrote it. "
                         "Usually it was put there by hand. Give it another "
                         "name, then compare again.");
    }
  } // namespace



  const FolderKind &
  run_folder_kind()
  {
    static const FolderKind kind = {"run",
                                    "Output/Directory",
                                    "'Output/Replace = true'",
                                    ", or go on with it by --resume",
                                    paths_of_run,
                                    has_texts_of_run};
    return kind;
  }



  FolderLock
  prepare_run_folder(const std::string &folder,
                     const bool         replace,
                     const MPI_Comm     communicator)
  {
    FolderLock lock;
    on_first_rank(communicator, [&]() {
      lock = claim_folder(folder,
                          run_folder_kind(),
                          replace ? FolderUse::replace : FolderUse::fresh);
    });
    return lock;
  }



  FolderLock
  reopen_run_folder(const std::string &folder, const MPI_Comm communicator)
  {
    FolderLock lock;
    on_first_rank(communicator, [&]() {
      if (!is_made(folder, run_folder_kind()))
        refuse_to_resume(folder);
      lock = claim_folder(folder, run_folder_kind(), FolderUse::resume);
    });
    return lock;
  }



  FolderLock
  lock_for_comparison(const std::string &folder)
  {
    FolderLock lock(folder);
    check_former_result(Path(folder) / "comparison", "# 1: time [s]\n");
    check_former_result(Path(folder) / "comparison.json", "{\n  \"run\": ");
    return lock;
  }



  RunTexts
  run_texts(const SceneFile &scene)
  {
    const auto printed = [&](const PrintStyle style) {
      std::ostringstream text;
      print_parameters(text, style, &scene);
      return text.str();
    };
    return {scene.original_text(),
            scene.original_name() == "original.json",
            printed(PrintStyle::prm),
            printed(PrintStyle::json)};
  }



  void
  write_run_texts(const std::string &folder,
                  const RunTexts    &texts,
                  const MPI_Comm     communicator)
  {
    on_first_rank(communicator, [&]() {
      write_whole_file(folder + (texts.original_is_json ? "/original.json" :
                                                          "/original.prm"),
                       texts.original);
      write_whole_file(folder + "/parameters.prm", texts.parameters_prm);
      write_whole_file(folder + "/parameters.json", texts.parameters_json);
    });
  }
} // namespace limber
