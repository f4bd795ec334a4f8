// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>
#include <limber/base/timing.h>
#include <limber/problem/obstacle_way.h>
#include <limber/simulation/passed_sides.h>
#include <limber/simulation/set_up.h>
#include <limber/simulation/signals.h>
#include <limber/simulation/simulation.h>
#include <limber/time/face_pieces.h>

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
    // Load balance: the mesh is partitioned anew, which costs about as much as
    // so many steps, when ranks have waited for that long for the one with most
    // points.
    constexpr double steps_to_balance = 200;

    // Bytes for empty cells from which a note is made.
    constexpr double worth_telling = 2e8;

    // Points of a full cell
    template <int dim>
    double
    number_of_points(const std::array<unsigned int, dim> &per_edge)
    {
      double result = 1;
      for (const unsigned int n : per_edge)
        result *= n;
      return result;
    }

    // With a step below this share of the first one the run would never end.
    constexpr double smallest_step = 1e-6;

    // Times closer than this, relative to the step, are one time.
    constexpr double same_time = 1e-9;
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
    , integrator(
        make_integrator<dim>({problem, grid, nodes, bodies, state.ledger}))
    , adaptation(problem, grid, bodies)
    , balance_of_start(state)
    , health(state)
    , observables(state)
    , checks(problem.checks, names_of(problem.observables))
    , writer(problem.output.directory)
    , checkpoints(problem, grid)
    , totals(balance_of_start.evaluate(state))
    , n_points_at_start(totals.points)
    , targets(checks.times())
  {
    targets.push_back(problem.end_time);
    std::sort(targets.begin(), targets.end());
    // Seeding and sorting have needed memory that can be returned.
    malloc_trim(0);
  }



  template <int dim>
  void
  Simulation<dim>::describe() const
  {
    std::ostringstream text;
    text << totals.points << " points of " << bodies.size()
         << (bodies.size() == 1 ? " body in " : " bodies in ") << totals.cells
         << " cells of " << (grid.has_levels() ? "at least " : "")
         << grid.smallest_edge << " m; first step "
         << integrator->longest_step() << " s, to end time " << problem.end_time
         << " s";
    console.say(text.str());
    if (problem.method.integration == TimeIntegration::explicit_steps)
      {
        const auto   speeds = integrator->state();
        const double number = integrator->longest_step() *
                              (speeds.wave_speed + speeds.point_speed) /
                              smallest_edge_with_points(state);
        if (number > 1 + 1e-6)
          console.warn("The first step has Courant number " + brief(number) +
                       ": explicit steps beyond 1 become unstable. Set "
                       "'Method/" +
                       (problem.method.time_step > 0 ?
                          "Time step = 0'." :
                          "Courant number = 0.4'."));
      }
    for (const FaceLoad<dim> &load : problem.loads.faces)
      for (const auto &body : problem.bodies)
        if (body.name == load.body)
          {
            double area = 0;
            for (const auto &piece :
                 pieces_at_start<dim>(load, body, problem.grid))
              area += piece.area;
            console.say("Face load " + in_quotes(load.name) + " acts on " +
                        brief(area) + (dim == 2 ? " m" : " m^2") + " of body " +
                        in_quotes(body.name) + ".");
          }

    // Empty cells take no time, but they may take most of the memory.
    if (grid.has_levels())
      return;
    double filled = 0;
    for (const auto &body : bodies)
      filled += body->points.n_global() /
                number_of_points<dim>(body->description.points_per_cell_edge);
    const auto all_ranks = [&](const double bytes) {
      return dealii::Utilities::MPI::sum(bytes, communicator);
    };
    const double all  = all_ranks(resident_memory());
    const double room = all_ranks(memory_with_grid - memory_of_program) *
                        (1 - std::min(1., filled / totals.cells));
    if (room > worth_telling && room > 0.5 * all)
      console.say("Empty cells of the box take " + brief(room / 1e6) +
                  " of the " + brief(all / 1e6) +
                  " MB of memory, and no time: 'limber advise' says how "
                  "'Grid/Levels' makes them coarse.");
  }



  template <int dim>
  int
  Simulation<dim>::run()
  {
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        const std::string path    = problem.output.directory + "/statistics";
        const auto        columns = statistics_columns(problem);
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
    return finish_complete();
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
    const double first_step = integrator->longest_step();
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

        if (integrator->reorganise(state.time))
          rebalance_if_it_pays();
        adapt_if_due();
        if (!(integrator->longest_step() > smallest_step * first_step))
          refuse_step(first_step);
        const double asked = next_step();
        const double step  = integrator->advance(state.time, asked);
        if (step < asked)
          console.say("step " + std::to_string(state.step + 1) + " from time " +
                      brief(state.time) + " s: " +
                      integrator->reason_for_shorter_step() + " over " +
                      brief(asked) + " s, so it is " + brief(step) + " s long");
        if (const std::string warning = integrator->warning(); !warning.empty())
          console.warn("At time " + brief(state.time) + " s " + warning);
        state.time += step;
        state.step_size = step;
        ++state.step;
        // Sums of small steps miss the times to land on by round-off.
        for (const double target : targets)
          if (std::abs(state.time - target) < same_time * step)
            state.time = target;
        points_and_steps += totals.points;

        if (integrator->points_were_lost())
          report_lost_points();
        if (row_is_due())
          record();
        else if (problem.method.integration == TimeIntegration::quasi_static)
          observables.follow_forces(state.time,
                                    balance_of_start.evaluate(state));
        else if (state.step % Balance<dim>::longest_interval == 0)
          balance_of_start.evaluate(state); // for its scales
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
                             brief(integrator->longest_step()) + " s, from " +
                             brief(first_step) + " s at first, at time " +
                             brief(state.time) + " s.",
                           FailureKind::step_too_small);
  }



  // The longest stable step, shortened to end at the next target; two equal
  // steps rather than a long and a very short one.
  template <int dim>
  double
  Simulation<dim>::next_step() const
  {
    double longest = integrator->longest_step();
    // In other schemes the speed of sound limits the step more than this.
    if (problem.method.integration == TimeIntegration::semi_implicit &&
        problem.method.time_step == 0)
      longest = step_that_obstacles_allow(problem, state.time, longest);
    double target = problem.end_time;
    // Explicit steps of a given length end near enough to any time.
    if (problem.method.time_step == 0 ||
        problem.method.integration != TimeIntegration::explicit_steps)
      {
        const double now = state.time + same_time * longest;
        for (const double time : targets)
          if (time > now)
            target = std::min(target, time);
        if (problem.output.time_interval > 0 && next_pictures > now)
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
    integrator->synchronise();
    totals              = balance_of_start.evaluate(state);
    const auto observed = observables.evaluate(state, totals);
    checks.add(state.time, observed);
    if (statistics)
      statistics->add(statistics_row(state, totals, observed));

    check_passed_sides(state, console);
    if (totals.smallest_volume <= 0)
      {
        throw ComputationError(
          "A point has turned inside out: the smallest volume ratio is " +
            brief(totals.smallest_volume) + ", at time " + brief(state.time) +
            " s with step " + brief(state.step_size) + " s.",
          FailureKind::inverted_point);
      }
    // The work of sides and loads on a body at rest is on record a step after
    // its strain energy: in its first steps all of that may be missing.
    constexpr unsigned long first_steps = 10;
    if (!(std::abs(totals.energy_drift) < problem.method.energy_growth_limit) &&
        (state.step > first_steps || !std::isfinite(totals.energy_drift)))
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
    integrator->synchronise();
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
    std::string              first; // the first of them, without its velocity
    int                      through_open = 0;
    for (const auto &[body, point] : integrator->lost_points())
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
        for (unsigned int d = 0; d < dim; ++d)
          for (const unsigned int end : {0, 1})
            if (const Side<dim> &side = problem.sides[2 * d + end];
                (end == 0 ? point.position[d] < problem.grid.lower[d] :
                            point.position[d] > problem.grid.upper[d]) &&
                (side.held == HeldComponents::none || !side.velocity.empty()))
              through_open = 1;
      }
    lost_through_open_side =
      dealii::Utilities::MPI::max(through_open, communicator) > 0;
    for (const auto &texts : gather_texts(own, communicator))
      for (const std::string &text : texts)
        console.warn_once(
          "lost point " +
            std::to_string(std::min<std::size_t>(texts.size(), 5)),
          "At time " + brief(state.time) + " s " + text +
            (lost_through_open_side ?
               ". Usually a side is free there or moves away, or the motion is "
               "unstable." :
               ". No side is free there: the motion is unstable."));

    const auto lost =
      dealii::Utilities::MPI::sum(state.ledger.lost_points, communicator);
    totals.points = points_ever() - lost;
    if (lost > problem.method.lost_points_limit * points_ever())
      {
        throw ComputationError(std::to_string(lost) + " of " +
                                 std::to_string(points_ever()) +
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
      (integrator->imbalance() - 1) * double(state.step - step_of_exchange);
    step_of_exchange = state.step;
    if (steps_waited < steps_to_balance)
      return;
    integrator->synchronise();
    balance(grid, bodies);
    integrator->reinit();
    steps_waited = 0;
  }



  // Repartitions the mesh where adaptation leaves a rank with many more points
  // than others, which would wait for it.
  template <int dim>
  void
  Simulation<dim>::adapt_if_due()
  {
    constexpr double largest_imbalance = 1.1;
    if (!adaptation.is_due(integrator->largest_displacement()))
      return;
    integrator->synchronise();
    typename Adaptation<dim>::KeptPoints kept(bodies.size());
    for (const auto &point : observables.state().tracked)
      kept[point.body].insert(point.id);
    const auto loaded  = integrator->detached_pieces();
    const bool changed = adaptation.adapt(state.time, kept);
    state.ledger.adaptation += adaptation.energy_removed();
    if (!changed)
      return;
    integrator->reinit();
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1 &&
        integrator->imbalance() > largest_imbalance)
      {
        balance(grid, bodies);
        integrator->reinit();
      }
    integrator->attach(loaded);
    totals.points =
      points_ever() -
      dealii::Utilities::MPI::sum(state.ledger.lost_points, communicator);
  }



  // Points of the start, and those from splitting, less merged ones.
  template <int dim>
  unsigned long
  Simulation<dim>::points_ever() const
  {
    return n_points_at_start + adaptation.state().points_added -
           adaptation.state().points_joined;
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



  template class Simulation<2>;
  template class Simulation<3>;
} // namespace limber
