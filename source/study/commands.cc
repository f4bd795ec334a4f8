// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/simulation/command_line.h>
#include <limber/study/commands.h>
#include <limber/study/study_commands.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <sstream>

namespace limber
{
  namespace
  {
    /** What is typed behind the word: our own options and the common ones. */
    struct StudyWords
    {
      CommandLine common; // its scene is the file of the study
      bool        is_short = false;
      StudyCall   call;
    };



    const std::vector<std::string> own_options = {"--short", "--for-error"};



    double
    error_level(const std::string &word)
    {
      const auto number = to_number(word);
      if (!number || *number <= 0)
        throw InputError("The error level " + in_quotes(word) +
                         " of '--for-error' on the command line is no number "
                         "greater than 0. Write '--for-error 0.01', for "
                         "instance.");
      return *number;
    }



    /** As typed, without what says where the results are, or where from. */
    std::string
    command_of(const int argc, const char *const *argv)
    {
      std::string command = "limber";
      for (int i = 1; i < argc; ++i)
        {
          const std::string word = argv[i];
          if (word == "--output-directory")
            ++i;
          else if (word != "--resume" && word != "Replace=true" &&
                   word.compare(0, 19, "--output-directory=") != 0 &&
                   !(word == "--set" && i + 1 < argc &&
                     argv[i + 1] == std::string("Replace=true")))
            command += " " + (word.find_first_of(" |;'") == std::string::npos ?
                                word :
                                "\"" + word + "\"");
        }
      return command;
    }



    StudyWords
    parse(const int argc, const char *const *argv)
    {
      StudyWords                result;
      std::vector<const char *> rest = {argv[0]};
      result.call.command            = command_of(argc, argv);
      for (int i = 2; i < argc; ++i)
        {
          const std::string word = argv[i];
          if (word == "--short")
            result.is_short = true;
          else if (word.compare(0, 12, "--for-error=") == 0)
            result.call.error_levels.push_back(error_level(word.substr(12)));
          else if (word == "--for-error")
            {
              if (i + 1 == argc)
                throw InputError("The option '--for-error' at the end of the "
                                 "command line lacks its value. Write "
                                 "'--for-error 0.01', for instance.");
              result.call.error_levels.push_back(error_level(argv[++i]));
            }
          else
            {
              // The common options do not know ours, so hints come from here.
              const auto meant = word.compare(0, 2, "--") == 0 ?
                                   nearest(word, own_options) :
                                   std::nullopt;
              if (meant)
                throw InputError("The option " + in_quotes(word) +
                                 " on the command line is not known. Usually "
                                 "it is misspelt. Did you mean " +
                                 in_quotes(*meant) + "?");
              rest.push_back(argv[i]);
            }
        }
      result.common        = parse_command_line(rest.size(), rest.data());
      result.call.resume   = result.common.resume;
      result.call.validate = result.common.validate;
      return result;
    }



    const std::string study_options =
      R"(
  --short                    the short lists of the study
  --resume                   keep the runs that are done and have not changed
  --validate                 check and list all variants, run nothing
  --print-parameters prm|json|markdown
                             print all entries, those of the study if one is
                             given
  --set "Section/Name=value" change an entry of the study; may be repeated
  --output-directory path    folder of the results, same as Directory

Results: study.csv, study.md, study.json; study.svg and study.png where Python
with matplotlib is there; the run folders in runs. Exit codes: 0 done, also
where variants have failed; 1 wrong input, 3 file error, 128 + n stopped by
signal n.
)";

    const std::string study_usage = R"(limber study [options] study.prm

Runs all variants of a scene one after another and compares what they measure
with what they cost. Each run is a process of its own.

  --for-error number         name the cheapest variant with this error; may be
                             repeated)" +
                                    study_options;

    const std::string stability_usage = R"(limber stability [options] study.prm

Seeks by bisection the largest stable value of an entry, the Courant number for
instance, for every variant of a scene. Each run is a process of its own.
)" + study_options;



    /** Studies name their folder 'Directory', scenes 'Output/Directory'. */
    std::vector<std::string>
    study_overrides(const CommandLine &line)
    {
      const std::string        of_scenes = "Output/";
      std::vector<std::string> overrides;
      for (const std::string &setting : line.overrides)
        overrides.push_back(setting.rfind(of_scenes + "Directory=", 0) == 0 ?
                              setting.substr(of_scenes.size()) :
                              setting);
      return overrides;
    }



    void
    refuse_several_ranks()
    {
      const char *const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
      if (ranks != nullptr && std::string(ranks) != "1")
        throw InputError("A study was started on " + std::string(ranks) +
                         " ranks. It starts the processes of its runs itself. "
                         "Call it without mpirun.");
    }



    using Study = int (*)(const StudyFile &, const StudyCall &, Console &);



    int
    call_study(const Study        run,
               const std::string &usage,
               const int          argc,
               const char *const *argv)
    {
      const StudyWords words = parse(argc, argv);
      Console          console(true, std::cout);
      if (words.common.help)
        console.show(usage);
      else if (words.common.print_parameters)
        {
          std::ostringstream text;
          const PrintStyle   style = *words.common.print_parameters;
          if (words.common.scene.empty())
            print_study_parameters(text, style);
          else
            {
              Parameters parameters;
              read_entries(words.common.scene,
                           study_overrides(words.common),
                           parameters);
              parameters.print(text, style);
            }
          console.show(text.str());
        }
      else if (words.common.scene.empty())
        {
          console.show(usage);
          return int(ExitCode::wrong_input);
        }
      else
        {
          refuse_several_ranks();
          console.say(banner(run_info()));
          return run(read_study(words.common.scene,
                                study_overrides(words.common),
                                words.is_short),
                     words.call,
                     console);
        }
      return int(ExitCode::success);
    }



    int
    study(const int argc, const char *const *argv)
    {
      return call_study(run_study, study_usage, argc, argv);
    }



    int
    stability(const int argc, const char *const *argv)
    {
      return call_study(run_stability, stability_usage, argc, argv);
    }



    using Command = int (*)(const int, const char *const *);

    const std::map<std::string, Command> commands = {
      {"study", study},
      {"stability", stability},
      {"inf-sup", inf_sup_command},
      {"advise", advise_command}};
  } // namespace



  bool
  is_study_command(const int argc, const char *const *argv)
  {
    return argc > 1 && commands.count(argv[1]) > 0;
  }



  int
  run_study_command(const int argc, const char *const *argv)
  {
    return commands.at(argv[1])(argc, argv);
  }
} // namespace limber
