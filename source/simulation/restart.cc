// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/simulation/set_up.h>
#include <limber/simulation/simulation.h>

#include <sstream>

/** @file Conversion of a Simulation to a RunState and back. */
namespace limber
{
  template <int dim>
  void
  Simulation<dim>::resume()
  {
    resumed = checkpoints.load(present_state(),
                               bodies,
                               [&](const RunState<dim> &former) {
                                 adaptation.restore(former.adaptation);
                               });
    if (problem.end_time < resumed->time)
      throw InputError("'End time' is " + brief(problem.end_time) + " s, but " +
                       checkpoints.good_file() + " is of time " +
                       brief(resumed->time) +
                       " s: that is past. Usually the scene was changed. Set a "
                       "later 'End time', or repeat the run without "
                       "'--resume'.");
    state.step = saved_step = resumed->step;
    state.time              = resumed->time;
    state.step_size         = resumed->step_size;
    // Ledgers are summed over ranks, so one of them gets all.
    state.ledger = {};
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      state.ledger = resumed->ledger;
    state.ledger.obstacles.resize(problem.obstacles.size());
    next_pictures = resumed->next_pictures;

    // Points were read by the owners of their cells.
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
      balance(grid, bodies);
    integrator->restore(resumed->integrator);

    // evaluate() may raise the scales of the balance, which only rows should
    // do.
    balance_of_start.restore(resumed->balance);
    totals = balance_of_start.evaluate(state);
    balance_of_start.restore(resumed->balance);
    observables.restore(resumed->observables);
    checks.restore(resumed->checks);
    writer.restore(resumed->pictures, communicator);
    console.restore_counts(resumed->warnings);

    if (!checkpoints.warning().empty())
      console.warn(checkpoints.warning());
    std::ostringstream text;
    text << "Resumed after step " << state.step << ", time " << state.time
         << " s, from " << checkpoints.good_file();
    console.say(text.str());
  }



  template <int dim>
  RunState<dim>
  Simulation<dim>::present_state() const
  {
    RunState<dim> now;
    now.step              = state.step;
    now.time              = state.time;
    now.step_size         = state.step_size;
    now.ledger            = state.ledger.sum_over_ranks(communicator);
    now.integrator        = integrator->state();
    now.adaptation        = adaptation.state();
    now.balance           = balance_of_start.state();
    now.observables       = observables.state();
    now.checks            = checks.state();
    now.pictures          = writer.state();
    now.next_pictures     = next_pictures;
    now.statistics_length = statistics ? statistics->length() : 0;
    now.warnings          = console.warning_counts();
    return now;
  }



  template <int dim>
  void
  Simulation<dim>::write_checkpoint()
  {
    const double before = cpu_time();
    integrator->synchronise();
    if (statistics)
      statistics->flush();
    checkpoints.save(present_state(), bodies);

    std::ostringstream text;
    text << "Checkpoint of step " << state.step << ", time " << state.time
         << " s: " << checkpoints.good_file();
    console.say(text.str());
    saved_step      = state.step;
    last_checkpoint = wall_time();
    output_cpu += cpu_time() - before;
  }



  // All results are there by now, whatever happens to the checkpoint.
  template <int dim>
  void
  Simulation<dim>::prepare_extension()
  {
    const auto is_saved = [&]() {
      return !checkpoints.good_file().empty() && saved_step == state.step;
    };
    if (problem.checkpoint.at_the_end && !is_saved())
      try
        {
          write_checkpoint();
        }
      catch (const FileError &failure)
        {
          throw FileError("The run has finished and its results are complete, "
                          "but not its last checkpoint. " +
                          std::string(failure.what()));
        }
    if (!is_saved())
      return;
    const bool         by_time = state.time >= problem.end_time;
    std::ostringstream text;
    text << "To extend this run: --resume --set \"End "
         << (by_time ? "time=" : "step=")
         << (by_time ? 2 * problem.end_time : 2. * problem.end_step) << '"';
    if (by_time && problem.loads_grow_until_the_end())
      text << " --set \"Loads/Load factor=" << problem.factor_until_the_end()
           << '"';
    console.say(text.str());
  }



  template void
  Simulation<2>::resume();
  template void
  Simulation<3>::resume();
  template RunState<2>
  Simulation<2>::present_state() const;
  template RunState<3>
  Simulation<3>::present_state() const;
  template void
  Simulation<2>::write_checkpoint();
  template void
  Simulation<3>::write_checkpoint();
  template void
  Simulation<2>::prepare_extension();
  template void
  Simulation<3>::prepare_extension();
} // namespace limber
