// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/simulation/signals.h>
#include <limber/study/run_result.h>
#include <limber/study/study_folder.h>
#include <limber/study/study_runs.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace limber
{
  namespace
  {
    /** The first line of NAME.done. */
    std::string
    first_line(const ChildEnd &end)
    {
      std::ostringstream text;
      text << "ended " << end.exit_code << ' ' << end.killed << ' '
           << end.timed_out << ' ' << end.seconds << '\n';
      return text.str();
    }



    /** How a former run ended, if it depended on the same things. */
    std::optional<ChildEnd>
    former_end(const std::string &path, const std::string &dependencies)
    {
      std::ifstream file(path);
      std::string   line, word;
      if (!std::getline(file, line))
        return std::nullopt;
      std::istringstream words(line);
      ChildEnd           end;
      if (!(words >> word >> end.exit_code >> end.killed >> end.timed_out >>
            end.seconds))
        return std::nullopt;
      std::ostringstream rest;
      rest << file.rdbuf();
      return rest.str() == dependencies ? std::optional<ChildEnd>(end) :
                                          std::nullopt;
    }



    std::string
    duration(const double seconds)
    {
      std::ostringstream text;
      if (seconds < 100)
        text << int(seconds + 0.5) << " s";
      else
        text << int(seconds / 60 + 0.5) << " min";
      return text.str();
    }
  } // namespace



  StudyRuns::StudyRuns(const StudyFile &study,
                       const StudyCall &call,
                       Console         &console)
    : study(study)
    , call(call)
    , console(console)
    , all(expand(study))
    , standard(standard_of(study))
  {
    console.say(study.title + ": " + std::to_string(all.size()) +
                " variants of " + study.scene);
    if (call.validate)
      {
        for (const Variant &variant : all)
          console.say("  " + variant.name);
        console.say("The study is valid.");
        return;
      }
    prepare_folder();
    catch_signals();
  }



  void
  StudyRuns::prepare_folder()
  {
    const FolderKind &kind         = study_folder_kind();
    const bool        made         = is_made(study.directory, kind);
    const FolderUse   use          = call.resume   ? FolderUse::resume :
                                     study.replace ? FolderUse::replace :
                                                     FolderUse::fresh;
    const auto        check_places = [&]() {
      for (const Variant &variant : all)
        refuse_taken_run(variant.folder);
      if (standard)
        refuse_taken_run(standard->folder);
    };
    if (!made)
      check_places();
    lock = claim_folder(study.directory, kind, use);
    if (use == FolderUse::fresh)
      check_places();
    if (!lock.warning().empty())
      console.warn(lock.warning());
    const std::string runs = study.directory + "/runs";
    std::error_code   error;
    std::filesystem::create_directory(runs, error);
    if (error)
      throw cannot_write(runs, error.message());
  }



  std::string
  StudyRuns::dependencies(const Variant                  &variant,
                          const std::vector<std::string> &settings) const
  {
    const auto built =
      std::filesystem::last_write_time(this_program()).time_since_epoch();
    return "program " + run_info().revision + " " +
           std::to_string(built.count()) + "\nscene " + study.scene +
           (variant.runner == Runner::reference ? " by reference" : "") +
           "\ntime limit " + to_text(study.time_limit) + "\n" +
           join(settings, "\n") + "\n" + variant.parameters;
  }



  std::optional<ChildEnd>
  StudyRuns::run(const Variant                  &variant,
                 const std::vector<std::string> &settings,
                 const std::string              &subfolder)
  {
    const std::string folder =
      variant.folder + (subfolder.empty() ? "" : "." + subfolder);
    const std::string done    = folder + ".done";
    const std::string depends = dependencies(variant, settings);
    if (call.resume)
      if (const auto former = former_end(done, depends))
        return former;

    // Remove results of a former run, which could be taken for those of this
    // one.
    remove_run_of_study(folder);
    std::vector<std::string> command = {this_program()};
    if (variant.runner == Runner::reference)
      command.push_back("reference");
    command.push_back(study.scene);
    // Runs of a study are not extended, unless it says so itself.
    command.insert(command.end(), {"--set", "Checkpoint/At the end=false"});
    for (const auto *const list : {&variant.settings, &settings})
      for (const std::string &setting : *list)
        command.insert(command.end(), {"--set", setting});
    command.insert(command.end(), {"--output-directory", folder});

    const ChildEnd end = run_child(command, folder + ".log", study.time_limit);
    present += end.seconds;
    const bool stopped =
      caught_signal() != 0 || (!end.timed_out && end.exit_code == 128 + SIGINT);
    if (stopped)
      return std::nullopt;
    write_whole_file(done, first_line(end) + depends);
    return end;
  }



  bool
  StudyRuns::prepare_comparison()
  {
    if (!standard)
      return true;
    console.say("computing what the variants are compared with");
    const auto end = run(*standard);
    present        = 0;
    if (!end)
      return false;
    const std::string outcome = outcome_of(*end, standard->folder);
    if (outcome != "finished")
      throw InputError("What the variants of " + study.path +
                       " are to be compared with has not been computed: " +
                       outcome + ". What it said is in " + standard->folder +
                       ".log. Change 'Comparison/Settings'.");
    return true;
  }



  bool
  StudyRuns::compare(const Variant &variant)
  {
    namespace fs               = std::filesystem;
    const std::string former   = variant.folder + "/comparison.json";
    const auto        is_newer = [&](const std::string &than) {
      return fs::last_write_time(former) >= fs::last_write_time(than);
    };
    if (call.resume && fs::exists(former) &&
        is_newer(variant.folder + ".done") &&
        (!standard || is_newer(standard->folder + ".done")))
      return true;

    const std::string log = variant.folder + ".comparison.log";
    const ChildEnd    end = run_child({this_program(),
                                       "compare",
                                       variant.folder,
                                    standard ? standard->folder : "exact"},
                                   log,
                                   study.time_limit);
    if (caught_signal() != 0)
      return false;
    if (end.exit_code != 0)
      throw InputError("The variant " + in_quotes(variant.name) + " of " +
                       study.path +
                       " cannot be compared. What was said is in " + log +
                       ". Usually the scene does not write its points: "
                       "'Output/Point arrays = true' and 'Output/Time "
                       "interval' belong to 'Settings'.");
    return true;
  }



  // As long as other methods took for the same choices, else the mean.
  double
  StudyRuns::seconds_left() const
  {
    double       mean = 0, left = 0;
    unsigned int n = 0;
    for (const double s : seconds)
      if (s > 0)
        {
          mean += s;
          ++n;
        }
    mean /= n > 0 ? n : 1;
    for (std::size_t next = seconds.size(); next < all.size(); ++next)
      {
        double       sum  = 0;
        unsigned int like = 0;
        for (std::size_t i = 0; i < seconds.size(); ++i)
          if (seconds[i] > 0 && all[i].choices == all[next].choices)
            {
              sum += seconds[i];
              ++like;
            }
        left += like > 0 ? sum / like : mean;
      }
    return left;
  }



  void
  StudyRuns::progress(const Variant &variant, const std::string &text)
  {
    seconds.push_back(present);
    std::ostringstream line;
    line << "[" << std::setw(int(std::to_string(all.size()).size()))
         << seconds.size() << "/" << all.size() << "] " << variant.name << ": "
         << text << (present > 0 ? "" : " (kept)");
    if (seconds.size() < all.size())
      line << "; left some " << duration(seconds_left());
    console.say(line.str());
    present = 0;
  }



  int
  StudyRuns::interrupted()
  {
    const int signal = caught_signal() != 0 ? caught_signal() : SIGINT;
    console.say("Interrupted after " + std::to_string(seconds.size()) + " of " +
                std::to_string(all.size()) +
                " variants; go on with the same command and --resume.");
    return int(ExitCode::stopped_by_signal) + signal;
  }
} // namespace limber
