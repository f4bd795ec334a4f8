// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/base/text_file.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>
#include <limber/simulation/command_line.h>
#include <limber/simulation/signals.h>
#include <limber/study/advice.h>
#include <limber/study/advice_runs.h>
#include <limber/study/child_process.h>
#include <limber/study/study_commands.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

namespace limber
{
  namespace
  {
    const std::string advise_usage = R"(limber advise [options] scene.prm

Runs a scene with and without what it could perhaps spare, and says what each
saves, what it changes, and whether that is advisable.

  --for-error number         relative change that is admitted, default 0.01
  --seconds number           wall time that a run may take, default 60; of
                             longer scenes the beginning is compared
  --set "Section/Name=value" change an entry first; may be repeated

Exit codes: 0 done, 1 wrong input, 2 the scene itself does not run, 128 + n
stopped by signal n.
)";



    struct AdviseOptions
    {
      double error = 0.01, seconds = 60;
    };



    /** After a signal during a run no more runs are started. */
    void
    stop_if_asked()
    {
      if (const int signal = caught_signal())
        throw Failure(ExitCode(int(ExitCode::stopped_by_signal) + signal),
                      "Stopped by signal " + std::to_string(signal) +
                        " before all was tried; what is advised above holds.");
    }



    /** Builds a scene in a process of its own, which brings its own MPI. */
    double
    first_step_of(const std::string              &scene,
                  const std::vector<std::string> &settings)
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
      stop_if_asked();

      // "... 512 points of 1 body in 720 cells of 0.25 m; first step 0.0027 s"
      const auto step = text.str().find("first step ");
      if (end.exit_code != 0 || step == std::string::npos)
        {
          // its message alone, behind what it has noted
          const std::string all   = text.str();
          const auto        start = all.rfind("Error: ");
          throw InputError("The scene " + in_quotes(scene) +
                           " cannot be built. " +
                           (start == std::string::npos ?
                              "See what 'limber " + scene + "' says." :
                              limber::trimmed(all.substr(start + 7))));
        }
      return std::stod(text.str().substr(step + 11));
    }



    void
    refuse_failed(const Trial &trial, const std::string &scene)
    {
      if (trial.until > 0 &&
          (trial.outcome == "finished" || trial.outcome == "time limit"))
        return;
      throw ComputationError("The scene " + in_quotes(scene) +
                             " itself does not run: it ends with '" +
                             trial.outcome +
                             "', so that nothing can be compared with it. Run "
                             "it alone for the reason, or raise '--seconds' "
                             "above the time that its first steps take.");
    }



    const char *
    heading(const Judgement judgement)
    {
      switch (judgement)
        {
          case Judgement::advised:
            return "Advised";
          case Judgement::trade:
            return "A trade";
          default:
            return "Not advised";
        }
    }



    /** @p factor: in CPU time; 0 where it is not known. */
    std::string
    gain_in_words(const Advice &advice, const double factor)
    {
      std::vector<std::string> gains;
      if (factor > 0)
        gains.push_back(factor < 1 ?
                          "nothing: it takes " + brief(1 / factor) +
                            " times the CPU time" :
                          "a factor of " + brief(factor) + " in CPU time");
      if (advice.memory > 0)
        gains.push_back(brief(advice.memory / 1048576) + " MB");
      return join(gains, ", ");
    }



    std::string
    changes_in_words(const Advice &advice, const Effect &effect)
    {
      if (effect.until <= 0)
        return advice.changes;
      std::string text =
        advice.changes + "; measured until " + brief(effect.until) + " s, ";
      if (effect.quantity.empty())
        return text + "nothing that is watched";
      return text + effect.quantity + " by " + brief(100 * effect.change) +
             " %";
    }



    void
    tell(const Advice       &advice,
         const JudgedAdvice &judged,
         const double        factor,
         const Effect       &effect)
    {
      std::vector<std::string> settings;
      for (const std::string &setting : advice.settings)
        settings.push_back(in_quotes(setting));
      std::cout << heading(judged.judgement) << ": " << advice.what << ". "
                << advice.text << ". Set " << join(settings, ", ")
                << ". Saves: " << gain_in_words(advice, factor)
                << ". Changes: " << changes_in_words(advice, effect)
                << ". Reason: " << judged.ground << "."
                << std::endl; // the next one may take a minute
    }



    /** What is done now, for who waits at a terminal: it may take a while. */
    void
    tell_progress(const std::string &text)
    {
      if (isatty(STDERR_FILENO))
        std::cerr << text << "..." << std::endl;
    }



    /** What the trial runs of all advice have in common. */
    template <int dim>
    struct Trials
    {
      const std::string             &path;
      const Problem<dim>            &problem;
      const std::vector<std::string> overrides;
      // Overrides for a scene that has the same equations at all points and is
      // built faster, where the scene as it is takes long
      const std::vector<std::string> lean;
      const AdviseOptions           &options;
      std::optional<Trial>           base;
      double                         way = 0; // see longest_way()

      Trial
      run(const std::string              &what,
          const std::vector<std::string> &settings) const
      {
        tell_progress("Running " + what + ", for " + brief(options.seconds) +
                      " s at most");
        Trial result = try_scene(path, settings, options.seconds);
        stop_if_asked();
        return result;
      }

      /** Judges an advice by a run with it; the first call also runs the scene
       * as it is. */
      void
      weigh(const Advice &advice)
      {
        if (!base)
          {
            base = run("the scene as it is", lean);
            refuse_failed(*base, path);
            double edge = problem.grid.finest_edge(0);
            for (unsigned int d = 1; d < dim; ++d)
              edge = std::min(edge, problem.grid.finest_edge(d));
            way = longest_way(base->table, edge);
          }
        // Advice on the grid replaces the settings of the lean scene.
        const bool sets_grid =
          std::any_of(advice.settings.begin(),
                      advice.settings.end(),
                      [](const std::string &setting) {
                        return setting.rfind("Grid/", 0) == 0;
                      });
        auto all = sets_grid ? overrides : lean;
        all.insert(all.end(), advice.settings.begin(), advice.settings.end());
        const Trial changed =
          run("it with the advice on '" + advice.what + "'", all);
        const Effect effect = compare_trials(problem, *base, changed);
        tell(advice,
             judge_advice(advice, changed, effect, options.error, way),
             effect.factor,
             effect);
      }
    };



    /**
     * The advice that makes empty cells coarse, if there are so many that it
     * takes some seconds to build the scene as it is. No run needs to support
     * it, as no point gets into a coarse cell.
     */
    template <int dim>
    std::optional<Advice>
    advise_lean_grid(const SceneFile &scene, const Problem<dim> &problem)
    {
      constexpr double many_cells = 3e5;
      double           cells      = 1;
      for (const unsigned int n : problem.grid.cells)
        cells *= n;
      if (problem.grid.levels > 0 || cells < many_cells)
        return {};
      return advise_levels(scene, problem);
    }



    /** The scene as it is, and once with each advice. */
    template <int dim>
    void
    tell_advice(const SceneFile                &scene,
                const std::string              &path,
                const std::vector<std::string> &overrides,
                const AdviseOptions            &options)
    {
      const Problem<dim> problem = read_problem<dim>(scene);
      auto               lean    = overrides;
      const auto         coarse  = advise_lean_grid(scene, problem);
      if (coarse)
        {
          lean.insert(lean.end(),
                      coarse->settings.begin(),
                      coarse->settings.end());
          tell(*coarse,
               {Judgement::advised,
                "no point gets into a coarse cell; the runs that follow have "
                "them, as the scene as it is takes long to build"},
               0,
               {});
        }
      check_size(read_problem<dim>(SceneFile(path, lean)),
                 Task::run,
                 this_machine());
      tell_progress("Building the scene");
      const auto  found = find_advice<dim>(scene,
                                          problem,
                                          options.error,
                                          first_step_of(path, lean));
      Trials<dim> trials{path, problem, overrides, lean, options, {}};
      for (const Advice &advice : found)
        if (coarse && advice.what == coarse->what)
          continue;
        else if (advice.factor > 0)
          tell(advice, {Judgement::advised, advice.ground}, advice.factor, {});
        else
          trials.weigh(advice);
      if (found.empty())
        std::cout << "Nothing to spare was found for an error of "
                  << brief(100 * options.error) << " %.\n";
    }



    /** The positive number behind an option of advise. */
    double
    number_behind(const int          argc,
                  const char *const *argv,
                  const int          i,
                  const std::string &example)
    {
      const auto number = i + 1 < argc ? to_number(argv[i + 1]) : std::nullopt;
      if (!number || *number <= 0)
        throw InputError("The option '" + std::string(argv[i]) +
                         "' on the command line lacks a number greater than "
                         "0. Write '" +
                         argv[i] + " " + example + "', for instance.");
      return *number;
    }
  } // namespace



  int
  advise_command(const int argc, const char *const *argv)
  {
    AdviseOptions             options;
    std::vector<const char *> rest = {argv[0]};
    for (int i = 2; i < argc; ++i)
      if (argv[i] == std::string("--for-error"))
        options.error = number_behind(argc, argv, i++, "0.01");
      else if (argv[i] == std::string("--seconds"))
        options.seconds = number_behind(argc, argv, i++, "60");
      else
        {
          const auto meant = nearest(argv[i], {"--for-error", "--seconds"});
          if (argv[i][0] == '-' && meant)
            throw InputError("The option " + in_quotes(argv[i]) +
                             " on the command line is not known. Usually it is "
                             "misspelt. Did you mean " +
                             in_quotes(*meant) + "?");
          rest.push_back(argv[i]);
        }
    const CommandLine line = parse_command_line(rest.size(), rest.data());
    if (line.help || line.scene.empty())
      {
        std::cout << advise_usage;
        return int(line.help ? ExitCode::success : ExitCode::wrong_input);
      }
    const SceneFile scene(line.scene, line.overrides);
    catch_signals();
    if (scene.dimension() == 2)
      tell_advice<2>(scene, line.scene, line.overrides, options);
    else
      tell_advice<3>(scene, line.scene, line.overrides, options);
    return int(ExitCode::success);
  }
} // namespace limber
