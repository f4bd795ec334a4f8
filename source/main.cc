// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <limber/base/console.h>
#include <limber/base/open_mpi.h>
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/base/unforeseen.h>
#include <limber/output/own_folder.h>
#include <limber/output/run_folder.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>
#include <limber/simulation/command_line.h>
#include <limber/simulation/reference_run.h>
#include <limber/simulation/signals.h>
#include <limber/simulation/simulation.h>
#include <limber/study/commands.h>
#include <limber/study/compare.h>
#include <limber/study/plot_scripts.h>

#include <cstdlib>
#include <iostream>
#include <sstream>

namespace
{
  using namespace limber;

  template <int dim>
  int
  run(const SceneFile &scene, const CommandLine &command, Console &console)
  {
    const Problem<dim> problem = read_problem<dim>(scene);
    check_size(problem, Task::run, this_machine(MPI_COMM_WORLD));
    const auto about_sides = check_moving_sides(problem);
    for (const std::string &setting : command.overrides)
      console.say("From the command line: " + printable(setting) + ".");
    for (const std::string &warning : scene.warnings())
      console.warn(warning);
    for (const std::string &warning : about_sides)
      console.warn(warning);
    for (const std::string &note : problem.notes)
      console.say(note);

    Simulation<dim> simulation(problem, console, MPI_COMM_WORLD);
    simulation.describe();
    if (command.validate)
      {
        const std::string objection =
          objection_to(problem.output.directory,
                       run_folder_kind(),
                       command.resume         ? FolderUse::resume :
                       problem.output.replace ? FolderUse::replace :
                                                FolderUse::fresh);
        if (!objection.empty())
          console.warn("The scene is valid, but a run would be refused now. " +
                       objection);
        else
          console.say("The scene is valid.");
        return int(ExitCode::success);
      }

    const std::string &folder = problem.output.directory;
    const FolderLock   lock =
      command.resume ?
          reopen_run_folder(folder, MPI_COMM_WORLD) :
          prepare_run_folder(folder, problem.output.replace, MPI_COMM_WORLD);
    if (!lock.warning().empty())
      console.warn(lock.warning());
    if (command.resume)
      simulation.resume();
    write_run_texts(folder, run_texts(scene), MPI_COMM_WORLD);
    console.open_log(folder + "/log.txt", command.resume);
    catch_signals();
    const int code = simulation.run();
    console.close_log();
    return code;
  }



  int
  execute(const CommandLine &command, Console &console)
  {
    if (command.help)
      console.show(usage());
    else if (command.version)
      console.show(banner(run_info()));
    else if (command.list)
      console.show(list_text(*command.list));
    else if (command.print_parameters && command.scene.empty())
      {
        std::ostringstream text;
        print_parameters(text, *command.print_parameters);
        console.show(text.str());
      }
    else if (command.scene.empty())
      {
        console.show(usage());
        return int(ExitCode::wrong_input);
      }
    else if (command.frequencies)
      throw InputError(
        "The option '--frequencies' on the command line belongs to the finite "
        "element reference. Usually the word before it was forgotten. Write "
        "'limber reference --frequencies 3 " +
        command.scene + "'.");
    else
      {
        const SceneFile scene(command.scene, command.overrides);
        if (command.print_parameters)
          {
            std::ostringstream text;
            print_parameters(text, *command.print_parameters, &scene);
            console.show(text.str());
          }
        else
          {
            console.say(banner(run_info()));
            return scene.dimension() == 2 ? run<2>(scene, command, console) :
                                            run<3>(scene, command, console);
          }
      }
    return int(ExitCode::success);
  }

} // namespace



int
main(int argc, char *argv[])
{
  prepare_signals();
  // Before MPI: the runs of a study are processes with an MPI of their own.
  const bool is_plot = is_plot_command(argc, argv);
  if (is_plot || is_study_command(argc, argv))
    try
      {
        return is_plot ? run_plot_command(argc, argv) :
                         run_study_command(argc, argv);
      }
    catch (const Failure &failure)
      {
        std::cerr << "Error: " << failure.what() << std::endl;
        return int(failure.code);
      }
    catch (const std::exception &unforeseen)
      {
        const auto failure = as_failure(unforeseen);
        std::cerr << "Error: " << failure.what() << std::endl;
        return int(failure.code);
      }

  tune_open_mpi();
  // Run folders have a lock of their own; that of HDF5 fails where the file
  // system has none.
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const bool                               first =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;

  const LastWord last_word;

  // Failures are the same on every rank, so one speaks and all end. What is
  // not foreseen may concern one rank alone: it speaks and ends the others.
  try
    {
      Console console(first, std::cout);
      check_first_word(argc, argv);
      if (argc > 1 && std::string(argv[1]) == "reference")
        return run_reference(parse_command_line(argc - 1, argv + 1), console);
      if (argc > 1 && std::string(argv[1]) == "compare")
        return run_compare({argv + 2, argv + argc}, console);
      return execute(parse_command_line(argc, argv), console);
    }
  catch (const Failure &failure)
    {
      if (first)
        std::cerr << "Error: " << failure.what() << std::endl;
      // A full disk is met by the rank that writes; the others wait for it.
      if (failure.code == ExitCode::file_error &&
          dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
        MPI_Abort(MPI_COMM_WORLD, int(failure.code));
      return int(failure.code);
    }
  catch (const std::exception &unforeseen)
    {
      const auto failure = as_failure(unforeseen);
      last_word.say(failure);
      return int(failure.code);
    }
}
