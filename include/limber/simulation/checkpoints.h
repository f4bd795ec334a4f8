// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_checkpoints_h
#define limber_simulation_checkpoints_h

#include <limber/output/checks.h>
#include <limber/output/observables.h>
#include <limber/output/writer.h>
#include <limber/time/explicit_integrator.h>

#include <map>
#include <string>

namespace limber
{
  /** What a run is made of at the end of a step, besides its points. */
  template <int dim>
  struct RunState
  {
    unsigned long                       step      = 0;
    double                              time      = 0; // s
    double                              step_size = 0; // of the last step, s
    Ledger<dim>                         ledger;        // over all ranks
    IntegratorState<dim>                integrator;
    BalanceState<dim>                   balance;
    ObservablesState<dim>               observables;
    std::vector<CheckedValue>           checks;
    WriterState                         pictures;
    double                              next_pictures     = 0; // s
    std::uint64_t                       statistics_length = 0; // bytes
    std::map<std::string, unsigned int> warnings;
  };



  /**
   * The folder `checkpoint` of a run: two files that are written in turn, and
   * a note that names the good one. The note is changed when the new file is
   * complete, so there is a good file at every moment after the first one.
   * Every member function is collective unless it says otherwise.
   *
   * Points are stored with the place of their cell in the lattice of the
   * scene, so that every rank finds its own whatever the partition is.
   */
  template <int dim>
  class Checkpoints
  {
  public:
    using Bodies = std::vector<std::unique_ptr<MaterialBody<dim>>>;

    Checkpoints(const Problem<dim> &problem, const BackgroundGrid<dim> &grid);

    /** Throws FileError; the former checkpoint is then still good. */
    void
    save(const RunState<dim> &state, const Bodies &bodies);

    /**
     * Replace all points by those of the good file. Throws InputError where
     * there is none or it belongs to another scene, FileError where it cannot
     * be read.
     */
    RunState<dim>
    load(Bodies &bodies);

    /** The good file, as "output/checkpoint/slot_0.h5"; empty: none yet. */
    const std::string &
    good_file() const
    {
      return good;
    }

  private:
    void
    write_file(const std::string   &path,
               const RunState<dim> &state,
               const Bodies        &bodies) const;
    RunState<dim>
    read_file(Bodies &bodies) const;
    void
    find_good_file();

    const Problem<dim>        &problem;
    const BackgroundGrid<dim> &grid;
    const std::string          folder;
    std::string                good;
  };
} // namespace limber

#endif
