// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/simulation/passed_sides.h>
#include <limber/simulation/set_up.h>
#include <limber/simulation/signals.h>
#include <limber/simulation/simulation.h>

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace limber
{
  namespace
  {
    // The mesh is partitioned anew, which costs about as much as so many
    // steps, when ranks have waited for that long for the one with most points.
    constexpr double steps_to_balance = 200;

    // A step shorter than this share of the first one will never arrive.
    constexpr double smallest_step = 1e-6;

    // Times closer than this, relative to the step, are one time.
    constexpr double same_time = 1e-9;



    std::string
    in_words(const Diagnosis &diagnosis)
    {
      return diagnosis.mode.empty() ?
               "" :
               "Suspected: " + diagnosis.mode + ", for " + diagnosis.text;
    }



    /** Where no cause has been found: the usual one, and what to change. */
    std::string
    usual_cause(const FailureKind kind)
    {
      switch (kind)
        {
          case FailureKind::growing_energy:
          case FailureKind::not_finite:
            return "Usually the step is too long for the stiffness. Set "
                   "'Method/Courant number' to 0.4 or below and 'Method/Time "
                   "step' to 0.";
          case FailureKind::inverted_point:
            return "Usually the grid does not resolve the motion. Refine "
                   "'Grid/Cells', load more slowly, or set 'Method/Courant "
                   "number' to 0.4 or below.";
          case FailureKind::lost_points:
            return "Usually a side is free there. Close it in 'Boundaries' "
                   "with slip, or raise 'Method/Lost points limit' above the "
                   "share that is lost.";
          case FailureKind::step_too_small:
            return "Usually a point is compressed to nothing, see 'smallest "
                   "volume ratio' in the statistics. Refine 'Grid/Cells' or "
                   "load more slowly.";
          case FailureKind::other:
            break;
        }
      return "";
    }
  } // namespace



  template <int dim>
  Simulation<dim>::Simulation(const Problem<dim> &problem,
                              Console            &console,
                              const MPI_Comm      communicator)
    : problem(problem)
    , console(console)
    , communicator(communicator)
    , grid(problem.grid, communicator)
    , bodies(set_up_bodies(problem, grid))
    , nodes(grid)
    , state{problem, grid, nodes, bodies, 0, 0, 0, {}}
    , integrator(problem, grid, nodes, bodies, state.ledger)
    , balance_of_start(state)
    , health(state)
    , observables(state)
    , checks(problem.checks, observables.names())
    , writer(problem.output.directory)
    , checkpoints(problem, grid)
    , totals(balance_of_start.evaluate(state))
    , n_points_at_start(totals.points)
    , targets(checks.times())
  {
    targets.push_back(problem.end_time);
    std::sort(targets.begin(), targets.end());
    // Seeding and sorting have needed more than stays.
    malloc_trim(0);
  }



  template <int dim>
  void
  Simulation<dim>::describe() const
  {
    std::ostringstream text;
    text << totals.points << " points of " << bodies.size()
         << (bodies.size() == 1 ? " body in " : " bodies in ") << totals.cells
         << " cells of " << grid.smallest_edge << " m; first step "
         << integrator.longest_step() << " s, to end time " << problem.end_time
         << " s";
    console.say(text.str());
  }



  template <int dim>
  int
  Simulation<dim>::run()
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        const std::string path    = problem.output.directory + "/statistics";
        const auto        columns = statistics_columns(observables);
        if (resumed)
          statistics.emplace(path, resumed->statistics_length, columns.size());
        else
          statistics.emplace(path, columns);
      }
    start_wall = last_progress = last_checkpoint = wall_time();
    start_cpu                                    = cpu_time();
    try
      {
        loop();
      }
    catch (const ComputationError &failure)
      {
        finish_failed(failure);
      }

    if (stop != 0)
      return finish_stopped();
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
    const Diagnosis suspected = look_for_cause(/*unstable=*/true);
    std::string     message   = std::string(failure.what()) + " " +
                          (suspected.mode.empty() ? usual_cause(failure.kind) :
                                                    in_words(suspected)) +
                          " " + describe_last_state();
    try
      {
        const std::string checkpoint = describe_last_checkpoint();
        if (!checkpoint.empty())
          console.say(checkpoint);
        finish("unstable",
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
    // The speeds of a run that has blown up say nothing about its step.
    const Method &method = problem.method;
    const auto    speeds = integrator.state();
    Symptoms      symptoms =
      find_symptoms(state, speeds.wave_speed + speeds.point_speed);
    if (method.time_step == 0)
      symptoms.courant_number = method.courant_number;
    return diagnose(symptoms, problem, unstable);
  }



  // Where nodes have shown the step to be impossible, points are what they
  // were before it (with 'first', but for the stress); else what the step has
  // made of them.
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
  void
  Simulation<dim>::loop()
  {
    if (!resumed)
      {
        record();
        write_pictures();
      }
    const double first_step = integrator.longest_step();
    step_of_exchange        = state.step;
    while (state.time < problem.end_time &&
           (problem.end_step == 0 || state.step < problem.end_step))
      {
        look_at_the_clock();
        if (stop != 0)
          return;
        if (checkpoint_is_due ||
            (problem.checkpoint.steps > 0 && state.step != saved_step &&
             state.step % problem.checkpoint.steps == 0))
          write_checkpoint();

        if (integrator.reorganise())
          rebalance_if_it_pays();
        if (!(integrator.longest_step() > smallest_step * first_step))
          refuse_step(first_step);
        const double step = next_step();
        integrator.advance(state.time, step);
        state.time += step;
        state.step_size = step;
        ++state.step;
        // Sums of small steps miss the times to land on by round-off.
        for (const double target : targets)
          if (std::abs(state.time - target) < same_time * step)
            state.time = target;
        points_and_steps += totals.points;

        if (integrator.points_were_lost())
          report_lost_points();
        if (row_is_due())
          record();
        if (problem.output.time_interval > 0 &&
            state.time >= next_pictures - same_time * step)
          write_pictures();
        show_progress();
      }
  }



  template <int dim>
  void
  Simulation<dim>::refuse_step(const double first_step) const
  {
    throw ComputationError("The step has shrunk to " +
                             brief(integrator.longest_step()) + " s, from " +
                             brief(first_step) + " s at first, at time " +
                             brief(state.time) + " s.",
                           FailureKind::step_too_small);
  }



  // As long as the integrator admits, but not past a time to land on; two
  // equal steps rather than a long one and a sliver.
  template <int dim>
  double
  Simulation<dim>::next_step() const
  {
    const double longest = integrator.longest_step();
    double       target  = problem.end_time;
    if (problem.method.time_step == 0)
      {
        for (const double time : targets)
          if (time > state.time)
            target = std::min(target, time);
        if (problem.output.time_interval > 0 && next_pictures > state.time)
          target = std::min(target, next_pictures);
      }
    const double remaining = target - state.time;
    if (remaining <= longest * (1 + same_time))
      return remaining;
    if (problem.method.time_step == 0 && remaining < 2 * longest)
      return remaining / 2;
    return longest;
  }



  template <int dim>
  bool
  Simulation<dim>::row_is_due() const
  {
    return state.step % problem.output.statistics_interval == 0 ||
           state.step == problem.end_step ||
           std::find(targets.begin(), targets.end(), state.time) !=
             targets.end();
  }



  template <int dim>
  void
  Simulation<dim>::record()
  {
    totals              = balance_of_start.evaluate(state);
    const auto observed = observables.evaluate(state, totals);
    checks.add(state.time, observed);
    if (statistics)
      statistics->add(statistics_row(state, totals, observed));

    check_passed_sides(state);
    if (totals.smallest_volume <= 0)
      {
        throw ComputationError(
          "A point has turned inside out: the smallest volume ratio is " +
            brief(totals.smallest_volume) + ", at time " + brief(state.time) +
            " s with step " + brief(state.step_size) + " s.",
          FailureKind::inverted_point);
      }
    if (!(std::abs(totals.energy_drift) < problem.method.energy_growth_limit))
      {
        const bool finite = std::isfinite(totals.energy_drift);
        throw ComputationError(
          "The run is unstable: the total energy " +
            (finite ? "has drifted by " + brief(totals.energy_drift) +
                        " of its scale, 'Energy growth limit' is " +
                        brief(problem.method.energy_growth_limit) :
                      "is not finite") +
            ", at time " + brief(state.time) + " s with step " +
            brief(state.step_size) + " s.",
          finite ? FailureKind::growing_energy : FailureKind::not_finite);
      }
  }



  template <int dim>
  void
  Simulation<dim>::write_pictures()
  {
    const double interval = problem.output.time_interval;
    if (interval <= 0)
      return;
    const double before = cpu_time();
    writer.write(state);
    const double passed = state.time * (1 + same_time);
    if (next_pictures <= passed)
      next_pictures += interval;
    // Steps that are longer than the interval skip pictures.
    if (next_pictures <= passed)
      next_pictures +=
        interval * (std::floor((passed - next_pictures) / interval) + 1);
    output_cpu += cpu_time() - before;
  }



  template <int dim>
  void
  Simulation<dim>::report_lost_points()
  {
    std::vector<std::string> own;
    std::string              first; // of them, without its velocity
    for (const auto &[body, point] : integrator.lost_points())
      {
        std::ostringstream text;
        text.precision(4);
        text << "point " << point.id << " of body '" << body << "' "
             << (point.left_the_box ? "has left the box" :
                                      "has jumped past the cells known here")
             << " at (" << point.position << ")";
        if (own.empty())
          first = text.str();
        text << " with velocity (" << point.momentum / point.mass << ") m/s";
        own.push_back(text.str());
      }
    for (const auto &texts : dealii::Utilities::MPI::gather(communicator, own))
      for (const std::string &text : texts)
        console.warn_once("lost point " +
                            std::to_string(
                              std::min<std::size_t>(texts.size(), 5)),
                          "At time " + brief(state.time) + " s " + text +
                            ". Usually a side is free there, or the motion is "
                            "unstable.");

    const auto lost =
      dealii::Utilities::MPI::sum(state.ledger.lost_points, communicator);
    totals.points = n_points_at_start - lost;
    if (lost > problem.method.lost_points_limit * n_points_at_start)
      {
        throw ComputationError(std::to_string(lost) + " of " +
                                 std::to_string(n_points_at_start) +
                                 " points are lost at time " +
                                 brief(state.time) + " s" +
                                 (first.empty() ? "." : ": " + first + "."),
                               FailureKind::lost_points);
      }
  }



  template <int dim>
  void
  Simulation<dim>::rebalance_if_it_pays()
  {
    steps_waited +=
      (integrator.imbalance() - 1) * double(state.step - step_of_exchange);
    step_of_exchange = state.step;
    if (steps_waited < steps_to_balance)
      return;
    balance(grid, bodies);
    integrator.reinit();
    steps_waited = 0;
  }



  // Signals, and what wall time asks for; all ranks have to agree on it.
  template <int dim>
  void
  Simulation<dim>::look_at_the_clock()
  {
    checkpoint_is_due = false;
    const bool alone =
      dealii::Utilities::MPI::n_mpi_processes(communicator) == 1;
    if (!alone && state.step % 16 != 0)
      return;

    const CheckpointRequest &asked  = problem.checkpoint;
    const double             now    = wall_time();
    const int                signal = caught_signal();
    std::array<int, 2>       wanted{};
    wanted[0] =
      signal > 0 ? any_signal + signal :
      asked.wall_time_limit > 0 && now - start_wall > asked.wall_time_limit ?
                   wall_time_limit :
                   0;
    wanted[1] = asked.interval > 0 && now - last_checkpoint > asked.interval;
    if (!alone)
      MPI_Allreduce(
        MPI_IN_PLACE, wanted.data(), 2, MPI_INT, MPI_MAX, communicator);
    stop              = wanted[0];
    checkpoint_is_due = wanted[1] != 0;
  }



  template <int dim>
  void
  Simulation<dim>::show_progress()
  {
    const double now = wall_time();
    if (now - last_progress < problem.output.progress_interval)
      return;
    last_progress              = now;
    const double       elapsed = now - start_wall;
    std::ostringstream text;
    text << std::setprecision(4) << "step " << state.step << "  time "
         << state.time << " s  step size " << state.step_size << " s  points "
         << totals.points << "  energy drift " << totals.energy_drift << "  "
         << 1e9 * (cpu_time() - start_cpu - output_cpu) / points_and_steps *
              dealii::Utilities::MPI::n_mpi_processes(communicator)
         << " ns per point and step  left "
         << elapsed * (problem.end_time - state.time) /
              (state.time - (resumed ? resumed->time : 0))
         << " s";
    console.say(text.str());
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
    summary.ns_per_point_step =
      1e9 * computing / std::max(1ul, points_and_steps);

    summary.memory_bytes = sum(largest_memory(), communicator);
    const auto share     = [&](const double bytes) {
      return sum(bytes, communicator) / summary.memory_bytes;
    };
    summary.memory          = {{"program", share(memory_of_program)},
                               {"grid", share(memory_with_grid - memory_of_program)},
                               {"points", share(memory_with_points - memory_with_grid)},
                               {"nodes and buffers",
                                share(largest_memory() - memory_with_points)}};
    summary.bytes_per_point = summary.memory_bytes / n_points_at_start;
    summary.energy_drift    = totals.energy_drift;
    summary.momentum_error  = totals.momentum_error;
    summary.lost_points     = sum(state.ledger.lost_points, communicator);

    auto   verbs = integrator.verb_seconds;
    double all   = 0;
    for (double &seconds : verbs)
      all += seconds = sum(seconds, communicator);
    for (std::size_t v = 0; v < verbs.size(); ++v)
      summary.verbs.emplace_back(name_of(Verb(v)),
                                 verbs[v] / std::max(all, 1e-300));

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
    summary.health =
      judge(health.look(state, totals, balance_of_start.state().energy_scale));
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
         << summary.wall_seconds << " s; " << summary.ns_per_point_step
         << " ns per point and step, energy drift " << summary.energy_drift
         << ", momentum error " << summary.momentum_error << ", "
         << summary.lost_points << " points lost\n";
    for (const auto &[verb, share] : summary.verbs)
      text << "  " << std::left << std::setw(18) << verb << std::right
           << std::setw(6) << std::fixed << std::setprecision(1) << 100 * share
           << " %\n"
           << std::defaultfloat;
    text << std::setprecision(6);
    for (const CheckResult &check : summary.checks)
      text << "  check " << check.name << ": " << check.value << ", reference "
           << check.reference << " +- " << check.tolerance
           << (check.passed ? ", passed\n" : ", MISSED\n");
    text << health_text(summary.health) << "results in "
         << problem.output.directory;
    console.say(text.str());
  }



  template class Simulation<2>;
  template class Simulation<3>;
} // namespace limber
