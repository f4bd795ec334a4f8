// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/base/text_file.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>
#include <limber/simulation/command_line.h>
#include <limber/study/advice.h>
#include <limber/study/child_process.h>
#include <limber/study/study_commands.h>

#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace limber
{
  namespace
  {
    const std::string advise_usage = R"(limber advise [options] scene.prm

Says what a scene could do without, and the factor in CPU time that each would
save; runs nothing.

  --for-error number         relative error that is asked for, default 0.01
  --set "Section/Name=value" change an entry first; may be repeated
)";



    /** What --validate tells about the size of a run. */
    struct RunSize
    {
      double points = 0, first_step = 0;
    };



    /** Builds a scene in a process of its own, which brings its own MPI. */
    RunSize
    size_of(const std::string &scene, const std::vector<std::string> &settings)
    {
      namespace fs    = std::filesystem;
      std::string log = fs::temp_directory_path() / "limber-advise-XXXXXX";
      const int   own = mkstemp(&log[0]); // a name that nobody else has
      if (own < 0)
        throw cannot_write(log, std::strerror(errno));
      close(own);
      std::vector<std::string> command = {this_program(), scene, "--validate"};
      for (const std::string &setting : settings)
        command.insert(command.end(), {"--set", setting});
      const ChildEnd     end = run_child(command, log, 600);
      std::ostringstream text;
      text << std::ifstream(log).rdbuf();
      fs::remove(log);

      // "... 512 points of 1 body in 720 cells of 0.25 m; first step 0.0027 s"
      RunSize    size;
      const auto points = text.str().find(" points of ");
      const auto step   = text.str().find("first step ");
      if (end.exit_code != 0 || points == std::string::npos ||
          step == std::string::npos)
        throw InputError("The scene " + in_quotes(scene) +
                         " cannot be built. " + text.str());
      const auto line = text.str().rfind('\n', points) + 1;
      size.points     = std::stod(text.str().substr(line, points - line));
      size.first_step = std::stod(text.str().substr(step + 11));
      return size;
    }



    template <int dim>
    void
    tell_advice(const SceneFile                &scene,
                const std::string              &path,
                const std::vector<std::string> &overrides,
                const double                    error)
    {
      const Problem<dim> problem = read_problem<dim>(scene);
      check_size(problem, Task::run, this_machine());
      const RunSize size = size_of(path, overrides);
      const auto advice  = advise<dim>(scene, problem, error, size.first_step);
      for (const Advice &piece : advice)
        {
          double factor = piece.factor;
          if (!piece.settings.empty())
            {
              auto all = overrides;
              all.insert(all.end(),
                         piece.settings.begin(),
                         piece.settings.end());
              const RunSize lean = size_of(path, all);
              factor *=
                size.points / lean.points * lean.first_step / size.first_step;
            }
          std::cout << piece.what << ": " << piece.text;
          if (factor > 1.01)
            std::cout << " Saves a factor of " << brief(factor)
                      << " in CPU time.";
          std::cout << '\n';
        }
      if (advice.empty())
        std::cout << "Nothing to spare was found for an error of "
                  << brief(100 * error) << " %.\n";
    }
  } // namespace



  int
  advise_command(const int argc, const char *const *argv)
  {
    double                    error = 0.01;
    std::vector<const char *> rest  = {argv[0]};
    for (int i = 2; i < argc; ++i)
      if (argv[i] == std::string("--for-error"))
        {
          const auto number =
            i + 1 < argc ? to_number(argv[i + 1]) : std::nullopt;
          if (!number || *number <= 0)
            throw InputError("The option '--for-error' on the command line "
                             "lacks a number greater than 0. Write "
                             "'--for-error 0.01', for instance.");
          error = *number;
          ++i;
        }
      else
        rest.push_back(argv[i]);
    const CommandLine line = parse_command_line(rest.size(), rest.data());
    if (line.help || line.scene.empty())
      {
        std::cout << advise_usage;
        return int(line.help ? ExitCode::success : ExitCode::wrong_input);
      }
    const SceneFile scene(line.scene, line.overrides);
    if (scene.dimension() == 2)
      tell_advice<2>(scene, line.scene, line.overrides, error);
    else
      tell_advice<3>(scene, line.scene, line.overrides, error);
    return int(ExitCode::success);
  }
} // namespace limber
