// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <limber/base/records_of_ranks.h>
#include <limber/base/run_info.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/fem/natural_modes.h>
#include <limber/fem/reference_solver.h>
#include <limber/output/checks.h>
#include <limber/output/files.h>
#include <limber/output/run_folder.h>
#include <limber/output/summary.h>
#include <limber/points/shape_volume.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>
#include <limber/simulation/reference_fields.h>
#include <limber/simulation/reference_observables.h>
#include <limber/simulation/reference_run.h>

#include <boost/property_tree/json_parser.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <optional>
#include <sstream>

namespace limber
{
  namespace
  {
    constexpr double same_time = 1e-9; // relative to a step

    // Energy drift up to which a reference is accepted.
    constexpr double admitted_growth = 0.01;



    /** The entries on which the result of a reference depends: all but those of
     * output and messages, and of the method, whose integration 'auto' of the
     * reference follows if it is quasi-static. */
    std::vector<std::pair<std::string, std::string>>
    deciding_entries(const SceneFile &scene)
    {
      auto       entries = scene.parameters().entries();
      const bool is_quasi_static =
        std::find(entries.begin(),
                  entries.end(),
                  std::pair<std::string, std::string>("Method/Time integration",
                                                      "quasi-static")) !=
        entries.end();
      const auto is_idle = [&](const auto &entry) {
        const std::string &name = entry.first;
        if (name == "Method/Damping rate")
          return false;
        if (name == "Method/Time integration" || name == "Method/Time step")
          return !is_quasi_static;
        return name == "Output/Directory" || name == "Output/Replace" ||
               name == "Output/Progress interval" || name == "Memory limit" ||
               name.rfind("Checkpoint/", 0) == 0 ||
               name.rfind("Method/", 0) == 0;
      };
      entries.erase(std::remove_if(entries.begin(), entries.end(), is_idle),
                    entries.end());
      return entries;
    }



    /** Verdict and parameters of a finished reference; empty: there is none. */
    std::pair<std::string, std::string>
    former_reference(const std::string &folder)
    {
      namespace fs = std::filesystem;
      if (!fs::exists(folder + "/nodes") &&
          !fs::exists(folder + "/frequencies"))
        return {};
      try
        {
          boost::property_tree::ptree summary;
          read_json(folder + "/summary.json", summary);
          const auto verdict = summary.get<std::string>("verdict", "");
          if (verdict != "finished" && verdict != "check missed")
            return {};
          std::ifstream      file(folder + "/parameters.prm");
          std::ostringstream parameters;
          parameters << file.rdbuf();
          return {verdict, parameters.str()};
        }
      catch (const boost::property_tree::ptree_error &)
        {
          return {};
        }
    }



    /** The verdict of a finished reference of the same scene; else nothing. */
    std::optional<std::string>
    former_verdict(const std::string &folder, const SceneFile &scene)
    {
      // One rank looks, before any writes there.
      std::pair<std::string, std::string> former;
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        former = former_reference(folder);
      former = {broadcast_text(former.first, MPI_COMM_WORLD),
                broadcast_text(former.second, MPI_COMM_WORLD)};
      if (former.second.empty())
        return {};
      try
        {
          const SceneFile other(
            ParameterText{former.second, FileFormat::prm, folder});
          if (deciding_entries(other) == deciding_entries(scene))
            return former.first;
        }
      catch (const Failure &)
        {} // written by a version that knew other entries
      return {};
    }



    template <int dim>
    class ReferenceRun
    {
    public:
      ReferenceRun(const Problem<dim> &problem, Console &console)
        : problem(problem)
        , console(console)
        , model(problem, MPI_COMM_WORLD)
        , solver(model)
        , observables(model, solver)
        , checks(problem.checks, names_of(problem.observables))
        , targets(checks.times())
      {
        check_steps(problem, Task::reference, solver.longest_step());
        targets.push_back(problem.end_time);
        for (unsigned int k = 1; problem.output.time_interval > 0 &&
                                 k * problem.output.time_interval <
                                   problem.end_time * (1 - same_time);
             ++k)
          targets.push_back(k * problem.output.time_interval);
        std::sort(targets.begin(), targets.end());
      }

      void
      describe() const
      {
        std::ostringstream text;
        text << model.mesh->n_global_active_cells() << " elements, "
             << model.dof_handler.n_dofs() / dim << " nodes, smallest edge "
             << model.smallest_edge << " m; step " << solver.longest_step()
             << " s, to end time " << problem.end_time << " s";
        console.say(text.str());
        compare_mesh_with_body();
        const std::vector<double> areas = model.loaded_areas();
        for (std::size_t l = 0; l < areas.size(); ++l)
          console.say("Face load " + in_quotes(problem.loads.faces[l].name) +
                      " acts on " + brief(areas[l]) +
                      (dim == 2 ? " m." : " m^2."));
      }

      // A mesh of a formula, or from a file, may be that of another body.
      void
      compare_mesh_with_body() const
      {
        constexpr double   differs = 0.05;
        const Body<dim>   &body    = problem.bodies.front();
        const double       size    = shape_volume(*body.shape);
        const double       of_mesh = dealii::GridTools::volume(*model.mesh);
        const Corners<dim> box     = body.shape->bounding_box();
        for (int d = 0; d < dim; ++d)
          {
            const double gap = 1e-6 * problem.grid.edge(d);
            if (box.first[d] < problem.grid.lower[d] - gap ||
                box.second[d] > problem.grid.upper[d] + gap)
              return; // the body is a half or a quarter of the shape
          }
        dealii::Point<dim> lower = box.second, upper = box.first;
        model.for_each_owned_node([&](const auto &place, const auto &) {
          for (int d = 0; d < dim; ++d)
            {
              lower[d] = std::min(lower[d], place[d]);
              upper[d] = std::max(upper[d], place[d]);
            }
        });
        bool lies_elsewhere = false;
        for (int d = 0; d < dim; ++d)
          {
            const double low    = dealii::Utilities::MPI::min(lower[d],
                                                           model.communicator),
                         high   = dealii::Utilities::MPI::max(upper[d],
                                                            model.communicator),
                         extent = box.second[d] - box.first[d];
            lies_elsewhere |= std::abs(low - box.first[d]) > differs * extent ||
                              std::abs(high - box.second[d]) > differs * extent;
          }
        const std::string unit = dim == 2 ? " m^2" : " m^3";
        if (std::abs(of_mesh - size) > differs * size)
          console.warn("The mesh has " + brief(of_mesh) + unit + ", body " +
                       in_quotes(body.name) + " " + brief(size) + unit +
                       ": what is computed is the mesh. Usually 'Reference/"
                       "Mesh file' is of another body, or too coarse for it.");
        else if (lies_elsewhere && body.shape->exact_volume())
          console.warn("The mesh does not lie where body " +
                       in_quotes(body.name) +
                       " does: what is computed is the mesh. Usually "
                       "'Reference/Mesh file' is in other units or has another "
                       "origin.");
      }

      int
      run()
      {
        if (dealii::Utilities::MPI::this_mpi_process(model.communicator) == 0)
          statistics.emplace(problem.output.directory + "/statistics",
                             observables.columns());
        start_wall = last_progress = wall_time();
        start_cpu                  = cpu_time();
        try
          {
            loop();
          }
        catch (const ComputationError &failure)
          {
            finish(verdict_of(failure.kind), failure.what());
            throw;
          }
        const auto results = checks.results();
        const bool passed =
          std::all_of(results.begin(),
                      results.end(),
                      [](const CheckResult &check) { return check.passed; });
        finish(passed ? "finished" : "check missed", "");
        return int(passed ? ExitCode::success : ExitCode::check_missed);
      }

    private:
      void
      loop()
      {
        const SolidMotion<dim> &motion = solver.motion();
        record();
        write_fields();
        double begin = 0;
        for (const double target : targets)
          {
            if (target <= begin * (1 + same_time))
              continue;
            while (motion.time < target * (1 - same_time))
              {
                // Equal steps, as many as it takes to reach the target
                const double remaining = target - motion.time;
                const double n =
                  std::ceil(remaining / solver.longest_step() - same_time);
                solver.advance(remaining / std::max(1., n));
                if (motion.time > target * (1 - same_time))
                  solver.set_time(target);
                if (row_is_due(motion.time == target))
                  record();
                show_progress();
              }
            if (is_time_of_fields(target))
              write_fields();
            begin = target;
          }
      }

      bool
      is_explicit() const
      {
        return problem.reference.method == ReferenceMethod::explicit_steps;
      }

      bool
      row_is_due(const bool at_target) const
      {
        return at_target || !is_explicit() ||
               solver.motion().step % problem.output.statistics_interval == 0;
      }

      bool
      is_time_of_fields(const double time) const
      {
        if (time == problem.end_time)
          return true;
        const double interval = problem.output.time_interval;
        return interval > 0 &&
               std::abs(time / interval - std::round(time / interval)) <
                 same_time;
      }

      void
      record()
      {
        totals              = observables.totals();
        const auto observed = observables.observe(totals);
        checks.add(solver.motion().time, observed);
        if (statistics)
          statistics->add(observables.row(totals, observed));
        const bool grows =
          totals.energy_drift > admitted_growth + totals.unresolved;
        if (std::isfinite(totals.kinetic_energy) && !grows)
          return;
        refuse_growth();
      }

      [[noreturn]] void
      refuse_growth() const
      {
        std::ostringstream text;
        text << "The energy of the finite element reference has grown by "
             << totals.energy_drift << " of its scale at time "
             << solver.motion().time << " s. Usually the step is too long"
             << (is_explicit() ?
                   "" :
                   ": Newmark's method is not stable in large rotations")
             << ". Set 'Reference/Time step = ";
        if (is_explicit())
          text << "0', which takes a stable one.";
        else
          text << 0.5 * solver.motion().step_size
               << "', or 'Reference/Method = explicit'.";
        throw ComputationError(text.str());
      }

      void
      write_fields()
      {
        write_reference_fields(problem.output.directory,
                               n_fields++,
                               model,
                               solver.motion());
      }

      void
      show_progress()
      {
        const double now = wall_time();
        if (now - last_progress < problem.output.progress_interval)
          return;
        last_progress                  = now;
        const SolidMotion<dim> &motion = solver.motion();
        std::ostringstream      text;
        text << std::setprecision(4) << "step " << motion.step << "  time "
             << motion.time << " s  step size " << motion.step_size << " s  ";
        if (std::isfinite(totals.energy_drift))
          text << "energy drift " << totals.energy_drift << "  ";
        text << "left "
             << (now - start_wall) * (problem.end_time - motion.time) /
                  motion.time
             << " s";
        console.say(text.str());
      }

      void
      finish(const std::string &verdict, const std::string &message)
      {
        using dealii::Utilities::MPI::sum;
        const SolidMotion<dim> &motion = solver.motion();
        Summary                 summary;
        summary.verdict  = verdict;
        summary.message  = message;
        summary.steps    = motion.step;
        summary.points   = model.dof_handler.n_dofs() / dim;
        summary.end_time = motion.time;
        summary.ranks =
          dealii::Utilities::MPI::n_mpi_processes(model.communicator);
        summary.wall_seconds = wall_time() - start_wall;
        summary.cpu_seconds  = sum(cpu_time() - start_cpu, model.communicator);
        summary.ns_per_point_step =
          1e9 * summary.cpu_seconds /
          std::max(1., double(motion.step) * summary.points);
        summary.energy_drift = totals.energy_drift;
        summary.checks       = checks.results();
        for (const auto &[text, count] : console.warning_counts())
          summary.warnings.push_back(text + ": " + std::to_string(count));
        if (statistics)
          {
            statistics->close();
            write_summary(problem.output.directory, summary);
          }

        std::ostringstream text;
        text << std::setprecision(4) << verdict << ": " << motion.step
             << " steps to time " << motion.time << " s in "
             << summary.wall_seconds << " s, " << motion.newton_steps
             << " corrections with " << motion.factorisations << " tangents";
        if (std::isfinite(totals.energy_drift)) // there is motion
          text << ", energy drift " << totals.energy_drift;
        text << "\n" << std::setprecision(6);
        for (const CheckResult &check : summary.checks)
          text << "  " << check.text() << '\n';
        text << "results in " << problem.output.directory;
        console.say(text.str());
      }

      const Problem<dim>       &problem;
      Console                  &console;
      SolidModel<dim>           model;
      ReferenceSolver<dim>      solver;
      ReferenceObservables<dim> observables;
      Checks                    checks;
      std::optional<Statistics> statistics; // on the first rank
      ReferenceTotals<dim>      totals;
      std::vector<double>       targets; // times to land on, ascending, s
      unsigned int              n_fields   = 0;
      double                    start_wall = 0, start_cpu = 0;
      double                    last_progress = 0;
    };



    template <int dim>
    int
    find_frequencies(const Problem<dim> &problem, Console &console)
    {
      const double          start = wall_time(), start_cpu = cpu_time();
      const SolidModel<dim> model(problem, MPI_COMM_WORLD);
      const auto [n_rigid, modes] =
        natural_frequencies(model, problem.reference.frequencies);
      std::ostringstream table, text;
      table << "# 1: mode\n# 2: frequency [Hz]\n" << std::setprecision(10);
      text << model.mesh->n_global_active_cells() << " elements, "
           << model.dof_handler.n_dofs() / dim << " nodes, " << n_rigid
           << " motions without strain\n"
           << std::setprecision(6);
      for (unsigned int k = 0; k < modes.size(); ++k)
        {
          table << k + 1 << ' ' << modes[k] << '\n';
          text << "  mode " << k + 1 << ": " << modes[k] << " Hz\n";
        }
      Summary summary;
      summary.verdict = "finished";
      summary.points  = model.dof_handler.n_dofs() / dim;
      summary.ranks =
        dealii::Utilities::MPI::n_mpi_processes(model.communicator);
      summary.wall_seconds = wall_time() - start;
      summary.cpu_seconds =
        dealii::Utilities::MPI::sum(cpu_time() - start_cpu, model.communicator);
      const std::string folder = problem.output.directory;
      on_first_rank(model.communicator, [&]() {
        write_whole_file(folder + "/frequencies", table.str());
        write_summary(folder, summary);
      });
      text << "results in " << folder;
      console.say(text.str());
      return int(ExitCode::success);
    }



    template <int dim>
    int
    run(const SceneFile &scene, const CommandLine &command, Console &console)
    {
      const Problem<dim> problem = read_problem<dim>(scene);
      check_size(problem, Task::reference, this_machine(MPI_COMM_WORLD));
      for (const std::string &setting : command.overrides)
        console.say("From the command line: " + printable(setting) + ".");
      for (const std::string &warning : scene.warnings())
        console.warn(warning);
      const std::string &folder = problem.output.directory;
      if (const auto verdict = former_verdict(folder, scene);
          verdict && !problem.output.replace && !command.validate)
        {
          console.say("The reference of this scene is in " + folder +
                      " already (" + *verdict + ").");
          return int(*verdict == "finished" ? ExitCode::success :
                                              ExitCode::check_missed);
        }

      FolderLock lock;
      const auto begin = [&]() {
        lock =
          prepare_run_folder(folder, problem.output.replace, MPI_COMM_WORLD);
        if (!lock.warning().empty())
          console.warn(lock.warning());
        write_run_texts(folder, run_texts(scene), MPI_COMM_WORLD);
        console.open_log(folder + "/log.txt");
      };
      if (problem.reference.frequencies > 0 && !command.validate)
        {
          begin();
          const int code = find_frequencies(problem, console);
          console.close_log();
          return code;
        }
      ReferenceRun<dim> reference(problem, console);
      reference.describe();
      if (command.validate)
        {
          console.say("The scene is valid.");
          return int(ExitCode::success);
        }
      begin();
      const int code = reference.run();
      console.close_log();
      return code;
    }
  } // namespace



  namespace
  {
    const std::string reference_usage = R"(limber reference [options] scene.prm
mpirun -np 4 limber reference [options] scene.prm

Solves the scene of a solid body by finite elements, as section 'Reference' of
the scene says, and leaves a run folder that 'limber compare' and 'limber plot'
read. A folder that holds the same reference already is left as it is.

  --frequencies n                       natural frequencies of the body at rest
                                        instead of its motion
  --validate                            check everything, compute nothing
  --set "Section/Name=value"            change an entry; may be repeated
  --output-directory path               the run folder, same as Output/Directory

Exit codes: 0 finished, 1 wrong input, 2 computation failed, 3 file error,
4 a check was missed, 128 + n stopped by signal n.
)";
  } // namespace



  int
  run_reference(const CommandLine &command, Console &console)
  {
    if (command.help)
      {
        console.show(reference_usage);
        return int(ExitCode::success);
      }
    if (command.resume)
      throw InputError("The option '--resume' on the command line goes on "
                       "with runs; a reference is computed in one go. Leave "
                       "it out.");
    if (command.scene.empty())
      throw InputError("The word 'reference' on the command line lacks its "
                       "scene. Usually it was forgotten. Write 'limber "
                       "reference scene.prm'.");
    auto overrides = command.overrides;
    if (command.frequencies)
      overrides.push_back("Reference/Frequencies=" + *command.frequencies);
    const SceneFile scene(command.scene, overrides);
    console.say(banner(run_info()));
    return scene.dimension() == 2 ? run<2>(scene, command, console) :
                                    run<3>(scene, command, console);
  }
} // namespace limber
