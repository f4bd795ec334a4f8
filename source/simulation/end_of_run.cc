// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/simulation/set_up.h>
#include <limber/simulation/simulation.h>

#include <algorithm>
#include <csignal>
#include <iomanip>
#include <sstream>

/** @file How a run may end, and the messages about that. */
namespace limber
{
  namespace
  {
    std::string
    in_words(const Diagnosis &diagnosis)
    {
      return diagnosis.mode.empty() ?
               "" :
               "Suspected: " + diagnosis.mode + ", for " + diagnosis.text;
    }



    /** The entry that makes steps shorter than they were. */
    std::string
    shorter_steps(const Method &method)
    {
      if (method.time_step > 0)
        return "'Method/Time step' to 0";
      return "'Method/Courant number' to " +
             brief(std::min(0.4, 0.5 * method.courant_number));
    }



    /** Where no cause has been found: the usual one and its remedy. */
    std::string
    usual_cause(const FailureKind kind,
                const Method     &method,
                const bool        through_open_side)
    {
      switch (kind)
        {
          case FailureKind::growing_energy:
          case FailureKind::not_finite:
            return "Usually the step is too long for the stiffness. Set " +
                   shorter_steps(method) + ".";
          case FailureKind::inverted_point:
            return "Usually the grid does not resolve the motion. Refine "
                   "'Grid/Cells', load more slowly, or set " +
                   shorter_steps(method) + ".";
          case FailureKind::lost_points:
            return through_open_side ?
                     "Usually a side is free there or moves away. Close it in 'Boundaries' "
                     "with slip, let an obstacle move instead, or raise 'Method/Lost points limit' above the "
                     "share that is lost." :
                     "No side is free there, so the motion is unstable. Set "
                     "'Method/Blend time', smaller cells, or a 'Method/Lost "
                     "points limit' above the share that is lost.";
          case FailureKind::step_too_small:
            if (method.integration == TimeIntegration::quasi_static)
              return "Usually the load is the largest that can be borne (limit "
                     "load, buckling): there is no equilibrium beyond. Let a "
                     "side or an obstacle move instead of a load, or set "
                     "'Method/Time integration = implicit'.";
            return "Usually a point is compressed to nothing, see 'smallest "
                   "volume ratio' in the statistics. Refine 'Grid/Cells' or "
                   "load more slowly.";
          case FailureKind::passed_side: // its message is complete
          case FailureKind::other:
            break;
        }
      return "";
    }
  } // namespace



  template <int dim>
  int
  Simulation<dim>::finish_complete()
  {
    const auto results = checks.results();
    const bool passed =
      std::all_of(results.begin(), results.end(), [](const CheckResult &check) {
        return check.passed;
      });
    if (passed)
      finish("finished", "", "");
    else
      {
        const Diagnosis suspected = look_for_cause(/*unstable=*/false);
        if (!suspected.mode.empty())
          console.say(in_words(suspected));
        finish("check missed", in_words(suspected), "", suspected.mode);
      }
    prepare_extension();
    return int(passed ? ExitCode::success : ExitCode::check_missed);
  }



  template <int dim>
  int
  Simulation<dim>::finish_stopped()
  {
    if (checkpoints.good_file().empty() || saved_step != state.step)
      write_checkpoint();
    if (stop == wall_time_limit)
      {
        finish("wall time", "the limit of the scene; go on with --resume", "");
        return int(ExitCode::stopped_by_signal) + SIGTERM;
      }
    const int signal = stop - any_signal;
    finish("stopped",
           "by signal " + std::to_string(signal) + "; go on with --resume",
           "");
    return int(ExitCode::stopped_by_signal) + signal;
  }



  template <int dim>
  void
  Simulation<dim>::finish_failed(const ComputationError &failure)
  {
    integrator->synchronise();
    Diagnosis suspected = look_for_cause(/*unstable=*/true);
    // Points of a body that has gone unstable leave through open sides as well.
    if (failure.kind == FailureKind::lost_points && lost_through_open_side &&
        !suspected.is_unstable)
      suspected = {};
    std::string message =
      std::string(failure.what()) + " " +
      (suspected.mode.empty() ?
         usual_cause(failure.kind, problem.method, lost_through_open_side) :
         in_words(suspected)) +
      " " + describe_last_state();
    try
      {
        const std::string checkpoint = describe_last_checkpoint();
        if (!checkpoint.empty())
          console.say(checkpoint);
        finish(verdict_of(failure.kind),
               message + (checkpoint.empty() ? "" : " " + checkpoint),
               word_for(failure.kind),
               suspected.mode);
      }
    catch (const FileError &)
      {
        message += " Log or summary could not be written.";
      }
    throw ComputationError(message, failure.kind);
  }



  template <int dim>
  Diagnosis
  Simulation<dim>::look_for_cause(const bool unstable)
  {
    // The speeds of a run that has become unstable do not tell its Courant
    // number.
    const Method &method = problem.method;
    const auto    speeds = integrator->state();
    Symptoms      symptoms =
      find_symptoms(state, speeds.wave_speed + speeds.point_speed);
    if (method.time_step == 0)
      symptoms.courant_number = method.courant_number;
    return diagnose(symptoms, problem, unstable);
  }



  // If the nodes have shown that the step is impossible, points are in the
  // state before it (with 'usf', except for the stress); otherwise in that
  // after it.
  template <int dim>
  std::string
  Simulation<dim>::describe_last_state()
  {
    std::string       text;
    const std::string path = problem.output.directory + "/points.pvd";
    try
      {
        const auto &former = writer.state().points;
        if (former.empty() || former.back().first != state.time)
          writer.write(state);
        text = "The last state is the last picture in " + path + ".";
      }
    catch (const FileError &failure)
      {
        text = std::string("The last state is lost. ") + failure.what();
      }
    return text;
  }



  template <int dim>
  std::string
  Simulation<dim>::describe_last_checkpoint() const
  {
    if (checkpoints.good_file().empty())
      return "";
    return "The last checkpoint, of step " + std::to_string(saved_step) +
           ", is " + checkpoints.good_file() + ".";
  }



  template <int dim>
  Summary
  Simulation<dim>::summarize() const
  {
    using dealii::Utilities::MPI::sum;
    Summary summary;
    summary.steps    = state.step;
    summary.points   = totals.points;
    summary.ranks    = dealii::Utilities::MPI::n_mpi_processes(communicator);
    summary.end_time = state.time;
    summary.wall_seconds = wall_time() - start_wall;
    summary.cpu_seconds  = sum(cpu_time() - start_cpu, communicator);
    const double computing =
      sum(cpu_time() - start_cpu - output_cpu, communicator);
    if (points_and_steps > 0)
      summary.ns_per_point_step = 1e9 * computing / points_and_steps;

    summary.memory_bytes = sum(largest_memory(), communicator);
    const auto share     = [&](const double bytes) {
      return sum(bytes, communicator) / summary.memory_bytes;
    };
    summary.memory          = {{"program", share(memory_of_program)},
                               {"grid", share(memory_with_grid - memory_of_program)},
                               {"points", share(memory_with_points - memory_with_grid)},
                               {"nodes and buffers",
                                share(largest_memory() - memory_with_points)}};
    summary.bytes_per_point = summary.memory_bytes / points_ever();
    summary.energy_drift    = totals.energy_drift;
    summary.momentum_error  = totals.momentum_error;
    summary.lost_points     = sum(state.ledger.lost_points, communicator);
    summary.put_back =
      static_cast<unsigned long>(sum(state.ledger.put_back, communicator));

    summary.verbs = integrator->verb_seconds();
    double all    = 0;
    for (auto &[name, seconds] : summary.verbs)
      all += seconds = sum(seconds, communicator);
    for (auto &[name, share_of_step] : summary.verbs)
      share_of_step /= std::max(all, 1e-300);

    if (problem.adapts())
      {
        const AdaptationState &adapted = adaptation.state();
        summary.adaptation = {{"times asked", double(adapted.times_asked)},
                              {"mesh changes", double(adapted.mesh_changes)},
                              {"points split", double(adapted.points_split)},
                              {"seconds",
                               dealii::Utilities::MPI::max(adaptation.seconds(),
                                                           communicator)}};
        if (problem.grid.joins_points)
          summary.adaptation.insert(summary.adaptation.end() - 1,
                                    {"points joined",
                                     double(adapted.points_joined)});
        if (problem.grid.joins_points || problem.splits_stretched_points())
          summary.adaptation.insert(summary.adaptation.end() - 1,
                                    {"energy removed",
                                     totals.removed_by_adaptation});
        if (grid.has_levels())
          summary.levels = adaptation.report();
      }

    summary.checks = checks.results();
    for (const auto &[text, count] : console.warning_counts())
      summary.warnings.push_back(text + ": " + std::to_string(count));
    return summary;
  }



  template <int dim>
  void
  Simulation<dim>::finish(const std::string &verdict,
                          const std::string &message,
                          const std::string &failure,
                          const std::string &suspected)
  {
    if (statistics)
      statistics->close();
    Summary summary   = summarize();
    summary.verdict   = verdict;
    summary.message   = message;
    summary.failure   = failure;
    summary.suspected = suspected;
    integrator->bring_points_home();
    summary.health =
      judge(health.look(state, totals, balance_of_start.state()));
    if (statistics)
      write_summary(problem.output.directory, summary);
    show_summary(summary);
  }



  template <int dim>
  void
  Simulation<dim>::show_summary(const Summary &summary) const
  {
    std::ostringstream text;
    text << std::setprecision(4) << summary.verdict << ": " << summary.steps
         << " steps to time " << summary.end_time << " s in "
         << summary.wall_seconds << " s; ";
    if (points_and_steps > 0)
      text << summary.ns_per_point_step << " ns per point and step, ";
    text << "energy drift " << summary.energy_drift << ", momentum error "
         << summary.momentum_error << ", " << summary.lost_points
         << " points lost\n";
    if (!summary.adaptation.empty())
      {
        text << summary.levels << "  adaptation:";
        for (const auto &[name, value] : summary.adaptation)
          text << " " << name << " " << value
               << (name == "seconds" ? "\n" : ",");
      }
    for (const auto &[verb, share] : summary.verbs)
      text << "  " << std::left << std::setw(18) << verb << std::right
           << std::setw(6) << std::fixed << std::setprecision(1) << 100 * share
           << " %\n"
           << std::defaultfloat;
    if (const std::string effort = integrator->effort(); !effort.empty())
      text << "  " << effort << '\n';
    text << std::setprecision(6);
    for (const CheckResult &check : summary.checks)
      text << "  " << check.text() << '\n';
    text << health_text(summary.health) << "results in "
         << problem.output.directory;
    console.say(text.str());
  }



  template int
  Simulation<2>::finish_complete();
  template int
  Simulation<2>::finish_stopped();
  template void
  Simulation<2>::finish_failed(const ComputationError &);
  template int
  Simulation<3>::finish_complete();
  template int
  Simulation<3>::finish_stopped();
  template void
  Simulation<3>::finish_failed(const ComputationError &);
} // namespace limber
