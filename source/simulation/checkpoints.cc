// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/records_of_ranks.h>
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/simulation/checkpoint_folder.h>
#include <limber/simulation/checkpoint_points.h>
#include <limber/simulation/checkpoints.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

namespace limber
{
  namespace
  {
    template <typename T>
    std::vector<T>
    read_all(const ArrayFile &file, const std::string &name)
    {
      std::vector<T> result(file.size(name));
      file.read(name, 0, result.data(), result.size());
      return result;
    }



    /** Throws unless the checkpoint is one of this very scene. */
    void
    compare_entries(const std::string              &former,
                    const std::vector<std::string> &present)
    {
      const std::vector<std::string> lines = split(former, '\n');
      for (std::size_t i = 0; i < std::max(lines.size(), present.size()); ++i)
        {
          const std::string was = i < lines.size() ? lines[i] : "nothing";
          const std::string is =
            i < present.size() ? trimmed(present[i]) : "nothing";
          if (was != is)
            throw InputError(
              "The scene differs from that of the checkpoint: it has " +
              in_quotes(is) + ", the checkpoint " + in_quotes(was) +
              ". Usually the scene was edited in between. Only 'End time', 'End step', "
              "'Output' and 'Checkpoint' may change when a run is resumed; "
              "set the entry back, or run without --resume.");
        }
    }



    /** The run of a file; throws where the bytes are none. */
    template <int dim>
    RunState<dim>
    unpacked_state(const ArrayFile &file)
    {
      try
        {
          return to_run_state<dim>(read_all<char>(file, "run"));
        }
      catch (const std::runtime_error &)
        {
          throw DamagedFile(file.name(), "has no state of a run in 'run'");
        }
    }



    /**
     * Run @p task and say what is wrong with the file on any rank, or nothing.
     * Other failures than damage are thrown on all ranks; collective.
     */
    template <class Task>
    std::string
    damage_on_any_rank(const MPI_Comm communicator, const Task &task)
    {
      std::optional<Failure> failure;
      try
        {
          task();
        }
      catch (const DamagedFile &damaged)
        {
          failure.emplace(ExitCode::file_error, damaged.reason);
        }
      catch (const InputError &caught)
        {
          failure.emplace(caught);
        }
      try
        {
          throw_together(failure, communicator);
        }
      catch (const FileError &damage)
        {
          return damage.what();
        }
      return "";
    }



    template <class Bodies>
    std::vector<std::size_t>
    count_points(const Bodies &bodies)
    {
      std::vector<std::size_t> result;
      for (const auto &body : bodies)
        result.push_back(body->points.n_global());
      return result;
    }
  } // namespace



  template <int dim>
  Checkpoints<dim>::Checkpoints(const Problem<dim>        &problem,
                                const BackgroundGrid<dim> &grid)
    : problem(problem)
    , grid(grid)
    , first(dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0)
    , folder(problem.output.directory + "/checkpoint")
  {}



  template <int dim>
  void
  Checkpoints<dim>::save(const RunState<dim> &state, const Bodies &bodies)
  {
    const std::string slot = slot_after(good);
    const std::string path = folder + "/" + slot, partial = path + ".part";
    on_first_rank(grid.communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directories(folder, error);
      if (error)
        throw cannot_write(folder, error.message());
      if (run == 0)
        {
          std::random_device draw;
          run = (std::uint64_t(draw()) << 32) | draw();
        }
    });
    Seal seal;
    try
      {
        seal = write_file(partial, state, bodies);
        on_first_rank(grid.communicator, [&]() { put_seal(partial, seal); });
      }
    catch (const Failure &)
      {
        std::error_code ignored; // the disk may be full of it
        if (first)
          std::filesystem::remove(partial, ignored);
        throw;
      }
    // Each is on the disk before the next refers to it.
    on_first_rank(grid.communicator, [&]() {
      if (state.statistics_length > 0)
        settle(problem.output.directory + "/statistics");
      std::error_code error;
      std::filesystem::rename(partial, path, error);
      if (error)
        throw cannot_write(path, error.message());
      settle(folder);
      write_note(folder, slot, seal);
    });
    good = slot;
  }



  template <int dim>
  Seal
  Checkpoints<dim>::write_file(const std::string   &path,
                               const RunState<dim> &state,
                               const Bodies        &bodies) const
  {
    const std::string       scene = join(problem.fixed_entries, "\n");
    const std::vector<char> bytes = to_bytes(state);

    std::vector<std::string> names = {"scene", "run"};
    // HDF5's own tables take a few hundred bytes per array.
    std::uint64_t n_bytes = scene.size() + bytes.size() + (1 << 20);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const auto own = point_array_names(b, bodies[b]->points);
        names.insert(names.end(), own.begin(), own.end());
        n_bytes += bodies[b]->points.n_global() * own.size() * sizeof(double);
      }

    Seal seal;
    seal.format = checkpoint_format;
    seal.run    = run;
    seal.step   = state.step;
    seal.time   = state.time;
    seal.room   = room_for_seal(names);
    GatheredFile file(path, n_bytes, grid.communicator, seal.room);
    file.write("scene", scene.data(), first ? scene.size() : 0);
    file.write("run", bytes.data(), first ? bytes.size() : 0);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      write_points(file, grid, b, bodies[b]->points);
    file.close();
    seal.pieces = file.pieces();
    return seal;
  }



  template <int dim>
  RunState<dim>
  Checkpoints<dim>::load(
    const RunState<dim>                              &start,
    Bodies                                           &bodies,
    const std::function<void(const RunState<dim> &)> &adopt_mesh)
  {
    const auto n_at_start = count_points(bodies);
    Survey     survey; // on the first rank
    on_first_rank(grid.communicator,
                  [&]() { survey = survey_checkpoints(folder); });
    for (;;)
      {
        // One rank decides for all, as others might see another state of the
        // disk. No file is opened by HDF5 before all of it has been checked.
        Candidate candidate;
        on_first_rank(grid.communicator,
                      [&]() { candidate = next_candidate(survey); });
        good = broadcast_text(candidate.name, grid.communicator);
        RunState<dim> state;
        std::string   damage = damage_on_any_rank(grid.communicator, [&]() {
          state = read_state(good_file(), start);
          if (first)
            check_statistics(good_file(), state.statistics_length);
        });
        if (damage.empty())
          {
            adopt_mesh(state);
            damage = damage_on_any_rank(grid.communicator, [&]() {
              read_bodies(good_file(), n_at_start, state, bodies);
            });
          }
        if (damage.empty())
          {
            run = candidate.seal.run;
            if (first)
              found_wrong = warning_about(survey);
            return state;
          }
        survey.faults.push_back(good + " " + damage);
      }
  }



  template <int dim>
  RunState<dim>
  Checkpoints<dim>::read_state(const std::string   &path,
                               const RunState<dim> &start) const
  {
    const ArrayFile file(path, ArrayFile::Mode::read);
    const auto      scene = read_all<char>(file, "scene");
    compare_entries({scene.begin(), scene.end()}, problem.fixed_entries);
    const RunState<dim> state = unpacked_state<dim>(file);
    if (const std::string fault = fault_of(state, start); !fault.empty())
      throw DamagedFile(path, fault);
    if (grid.has_levels())
      try
        {
          RefinedCells<dim> mesh = grid.no_divided_cells();
          mesh.set(state.adaptation.mesh);
          mesh.set(state.adaptation.wanted);
        }
      catch (const std::invalid_argument &)
        {
          throw DamagedFile(path, "has a mesh in 'run' that is none");
        }
    return state;
  }



  template <int dim>
  void
  Checkpoints<dim>::read_bodies(const std::string              &path,
                                const std::vector<std::size_t> &n_at_start,
                                const RunState<dim>            &state,
                                Bodies                         &bodies) const
  {
    const ArrayFile file(path, ArrayFile::Mode::read);
    std::size_t     n = 0;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (bodies[b]->points.has_reference() &&
            !file.has("body " + std::to_string(b) + "/reference position x"))
          throw InputError(
            "Pictures of the displacement ('Output/Fields') and a body force "
            "with 'Loads/Body force at = initial place' need to know where "
            "the points were at the start, and the checkpoint " +
            in_quotes(path) +
            " does not. Usually the run was begun without pictures. Leave "
            "'displacement' out of 'Output/Fields', or begin anew.");
        // as many numbers as points have had
        n += read_points(file,
                         grid,
                         b,
                         problem.adapts() ? state.adaptation.next_id[b] :
                                            n_at_start[b],
                         bodies[b]->points);
      }
    const std::size_t wanted =
      std::accumulate(n_at_start.begin(), n_at_start.end(), std::size_t(0)) +
      state.adaptation.points_added - state.adaptation.points_joined -
      state.ledger.lost_points;
    if (n != wanted)
      throw DamagedFile(path,
                        "has " + std::to_string(n) + " points instead of " +
                          std::to_string(wanted));
  }



  // The table is cut back to the checkpoint: to whole rows, all of them there.
  template <int dim>
  void
  Checkpoints<dim>::check_statistics(const std::string  &path,
                                     const std::uint64_t length) const
  {
    std::ifstream file(problem.output.directory + "/statistics",
                       std::ios::binary);
    if (length == 0 || (file.seekg(length - 1) && file.get() == '\n'))
      return;
    throw DamagedFile(path,
                      "needs " + std::to_string(length) +
                        " bytes of 'statistics', which are not there");
  }



  template class Checkpoints<2>;
  template class Checkpoints<3>;
} // namespace limber
