// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_checkpoints_h
#define limber_simulation_checkpoints_h

#include <limber/simulation/run_state.h>
#include <limber/simulation/seal.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /**
   * The folder `checkpoint` of a run: two files that are written in turn, and
   * a note that names the good one. The note is changed when the new file is
   * complete and on the disk, so there is a good file at every moment after the
   * first one. Every file is sealed; one that is not what was written is never
   * used, and the other one is taken instead. Every member function is
   * collective unless it says otherwise.
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
     * Replace all points, those of the start, by the ones of the good file, or
     * of the other where that is damaged. @p start: the state at the start;
     * @p adopt_mesh makes the mesh that of the state, before points are read.
     * Throws InputError where there is no checkpoint or it belongs to another
     * scene, FileError where none can be used.
     */
    RunState<dim>
    load(const RunState<dim>                              &start,
         Bodies                                           &bodies,
         const std::function<void(const RunState<dim> &)> &adopt_mesh);

    /** What load() has found wrong; empty: nothing. On the first rank. */
    const std::string &
    warning() const
    {
      return found_wrong;
    }

    /** The good file, as "output/checkpoint/slot_0.h5"; empty: none yet. */
    std::string
    good_file() const
    {
      return good.empty() ? good : folder + "/" + good;
    }

  private:
    Seal
    write_file(const std::string   &path,
               const RunState<dim> &state,
               const Bodies        &bodies) const;
    RunState<dim>
    read_state(const std::string &path, const RunState<dim> &start) const;
    void
    read_bodies(const std::string              &path,
                const std::vector<std::size_t> &n_at_start,
                const RunState<dim>            &state,
                Bodies                         &bodies) const;
    void
    check_statistics(const std::string &path, std::uint64_t length) const;

    const Problem<dim>        &problem;
    const BackgroundGrid<dim> &grid;
    const bool                 first; // rank
    const std::string          folder;
    std::string                good;    // "slot_0.h5"
    std::uint64_t              run = 0; // number of the run, on the first rank
    std::string                found_wrong;
  };
} // namespace limber

#endif
