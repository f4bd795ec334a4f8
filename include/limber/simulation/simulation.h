// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_simulation_h
#define limber_simulation_simulation_h

#include <limber/adaptation/adaptation.h>
#include <limber/base/console.h>
#include <limber/base/exceptions.h>
#include <limber/base/memory.h>
#include <limber/output/checks.h>
#include <limber/output/diagnosis.h>
#include <limber/output/health_figures.h>
#include <limber/output/observables.h>
#include <limber/output/statistics.h>
#include <limber/output/summary.h>
#include <limber/output/totals.h>
#include <limber/output/writer.h>
#include <limber/simulation/checkpoints.h>
#include <limber/time/integrator.h>

#include <memory>
#include <optional>

namespace limber
{
  /**
   * A run: sets up grid, bodies and observers from a problem, steps through
   * time, and leaves a run folder that explains itself. Every member function
   * is collective.
   */
  template <int dim>
  class Simulation
  {
  public:
    /** Builds everything, writes nothing. */
    Simulation(const Problem<dim> &problem,
               Console            &console,
               MPI_Comm            communicator);

    /** Go on from the checkpoint in the run folder; before run(). */
    void
    resume();

    /**
     * Step to the end time. Returns success, check_missed or, after a signal
     * n or the wall time limit (as after a termination signal),
     * stopped_by_signal + n. When the run fails, pictures of the last state
     * and the summary are written before the Failure goes on.
     */
    int
    run();

    /** What would be run: cells, points, first step. */
    void
    describe() const;

  private:
    /** Why the loop ends before the end time; the larger one prevails. A
     * signal adds its number. */
    static constexpr int wall_time_limit = 1, any_signal = 1000;

    void
    loop();
    int
    finish_complete();
    int
    finish_stopped();
    [[noreturn]] void
    finish_failed(const ComputationError &failure);
    std::string
    describe_last_state();
    std::string
    describe_last_checkpoint() const;
    Diagnosis
    look_for_cause(bool unstable);
    double
    next_step() const;
    [[noreturn]] void
    refuse_step(double first_step) const;
    void
    record();
    void
    write_pictures();
    RunState<dim>
    present_state() const;
    void
    write_checkpoint();
    void
    prepare_extension();
    void
    report_lost_points();
    void
    rebalance_if_it_pays();
    void
    adapt_if_due();
    unsigned long
    points_ever() const;
    void
    show_progress();
    void
    finish(const std::string &verdict,
           const std::string &message,
           const std::string &failure,
           const std::string &suspected = "");
    Summary
    summarize() const;
    void
    show_summary(const Summary &summary) const;
    bool
    row_is_due() const;
    void
    look_at_the_clock();

    const Problem<dim> &problem;
    Console            &console;
    const MPI_Comm      communicator;
    // Memory in use before and after parts are built, in their order, bytes
    const double        memory_of_program = resident_memory();
    BackgroundGrid<dim> grid;
    const double        memory_with_grid = resident_memory();
    std::vector<std::unique_ptr<MaterialBody<dim>>> bodies;
    const double     memory_with_points = resident_memory();
    NodalFields<dim> nodes;
    State<dim>       state;
    const std::unique_ptr<Integrator<dim>> integrator;
    Adaptation<dim>                        adaptation;
    Balance<dim>                           balance_of_start;
    const Health<dim>                      health;
    Observables<dim>                       observables;
    Checks                                 checks;
    Writer<dim>                            writer;
    Checkpoints<dim>                       checkpoints;
    std::optional<Statistics>              statistics;

    Totals<dim>         totals; // of the last row
    const unsigned long n_points_at_start;
    unsigned long       points_and_steps = 0; // sum of points over steps
    unsigned long       step_of_exchange = 0; // of points between ranks
    double              steps_waited     = 0; // of ranks for each other
    std::vector<double> targets;              // times to land on, ascending, s
    double              next_pictures = 0;    // s
    double              start_wall = 0, start_cpu = 0, output_cpu = 0;
    double              last_progress          = 0;
    bool                lost_through_open_side = false; // points, last time

    // Of a run that is resumed: where it has been taken up
    std::optional<RunState<dim>> resumed;

    int           stop              = 0;     // reason, 0: none
    bool          checkpoint_is_due = false; // by the clock
    double        last_checkpoint   = 0;     // s of wall time
    unsigned long saved_step        = 0;     // of the last checkpoint
  };
} // namespace limber

#endif
