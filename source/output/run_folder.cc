// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/output/run_folder.h>

#include <filesystem>
#include <sstream>
#include <system_error>
#include <vector>

namespace limber
{
  namespace
  {
    using Path = std::filesystem::path;



    bool
    is_there(const Path &path)
    {
      std::error_code error;
      return std::filesystem::exists(
        std::filesystem::symlink_status(path, error));
    }



    /** The first of the files by which a run is known, if one is there. */
    std::string
    trace_of_run(const Path &folder)
    {
      for (const char *const name :
           {"statistics", "summary.json", "parameters.prm"})
        if (is_there(folder / name))
          return name;
      return "";
    }



    /** Every run writes one of these first of all. */
    bool
    is_run_folder(const Path &folder)
    {
      return is_there(folder / "original.prm") ||
             is_there(folder / "original.json");
    }



    /** "points_00012.vtu" is a piece of the series "points"; so is ".h5". */
    bool
    is_piece(const std::string &file, const std::string &series)
    {
      const std::string start = series + "_";
      const auto        dot   = file.find('.');
      return file.compare(0, start.size(), start) == 0 &&
             dot != std::string::npos && dot > start.size() &&
             file.find_first_not_of("0123456789", start.size()) == dot &&
             (file.substr(dot) == ".vtu" || file.substr(dot) == ".vtu.part" ||
              file.substr(dot) == ".h5");
    }



    /** Pieces only; the folder itself if nothing else is in it. */
    void
    remove_pieces(const Path &folder, const std::string &series)
    {
      const Path pieces = folder / series;
      if (!std::filesystem::is_directory(
            std::filesystem::symlink_status(pieces)))
        return;
      std::vector<Path> old;
      for (const auto &entry : std::filesystem::directory_iterator(pieces))
        if (is_piece(entry.path().filename().string(), series))
          old.push_back(entry.path());
      for (const Path &piece : old)
        std::filesystem::remove(piece);
      if (std::filesystem::is_empty(pieces))
        std::filesystem::remove(pieces);
    }



    void
    remove_former_run(const Path &folder)
    {
      remove_pieces(folder, "points");
      remove_pieces(folder, "grid");
      remove_pieces(folder, "nodes");
      std::filesystem::remove_all(folder / "checkpoint");
      // The names by which a run is known go last: what is left after an
      // interruption is still a run folder.
      for (const char *const name : {"points.pvd",
                                     "grid.pvd",
                                     "log.txt",
                                     "parameters.json",
                                     "summary.json",
                                     "statistics",
                                     "frequencies",
                                     "comparison",
                                     "comparison.json",
                                     "parameters.prm",
                                     "original.json",
                                     "original.prm"})
        {
          std::filesystem::remove(folder / (std::string(name) + ".part"));
          if (!std::filesystem::is_directory(
                std::filesystem::symlink_status(folder / name)))
            std::filesystem::remove(folder / name);
        }
    }



    void
    refuse(const std::string &folder, const std::string &trace)
    {
      throw InputError("The folder " + in_quotes(folder) +
                       " holds a run: " + in_quotes(trace) +
                       " is in it ('Output/Directory'). Usually the scene has "
                       "been run before. Choose another 'Output/Directory', "
                       "set 'Output/Replace = true' to overwrite it, or go on "
                       "from its checkpoint with --resume.");
    }



    void
    refuse_foreign(const std::string &folder, const std::string &trace)
    {
      throw InputError("The folder " + in_quotes(folder) + " holds " +
                       in_quotes(trace) +
                       ", but no original.prm, and is not replaced "
                       "('Output/Directory'). Usually it is a folder of your "
                       "own files, not of a run. Choose another "
                       "'Output/Directory', for instance 'output'.");
    }



    void
    make_ready(const std::string &folder, const bool replace)
    {
      try
        {
          const std::string trace = trace_of_run(folder);
          if (!trace.empty() && !replace)
            refuse(folder, trace);
          if (!trace.empty() && !is_run_folder(folder))
            refuse_foreign(folder, trace);
          if (is_run_folder(folder) && replace)
            remove_former_run(folder);
          std::filesystem::create_directories(folder);
        }
      catch (const std::filesystem::filesystem_error &caught)
        {
          throw cannot_write(caught.path1().empty() ? folder :
                                                      caught.path1().string(),
                             caught.code().message());
        }
    }
  } // namespace



  void
  prepare_run_folder(const std::string &folder,
                     const bool         replace,
                     const MPI_Comm     communicator)
  {
    on_first_rank(communicator, [&]() { make_ready(folder, replace); });
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
