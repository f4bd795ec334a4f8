// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <limber/base/text.h>
#include <limber/output/array_file.h>
#include <limber/output/files.h>
#include <limber/simulation/checkpoints.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace limber
{
  // One list of members for both ways, in and out of a file.

  template <class Archive>
  void
  serialize(Archive &archive, CheckedValue &value, const unsigned int)
  {
    archive &value.distance &value.value;
  }



  template <class Archive>
  void
  serialize(Archive &archive, ZeroCrossings &crossings, const unsigned int)
  {
    archive &crossings.last_time &crossings.last_value &crossings
      .sign &crossings.count &crossings.first &crossings.last;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, TrackedPoint<dim> &point, const unsigned int)
  {
    archive &point.body &point.id &point.reference &point.lost;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, ObservablesState<dim> &state, const unsigned int)
  {
    archive &state.tracked &state.tracked_of &state.crossings &state
      .has_row &state.time &state.side_impulse &state.side_force;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, BalanceState<dim> &state, const unsigned int)
  {
    archive &state.kinetic_energy &state.strain_energy &state
      .gravitational_energy &state.momentum &state.energy_scale &state
      .momentum_scale;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, Ledger<dim> &ledger, const unsigned int)
  {
    archive &ledger.transfer &ledger.boundary_work &ledger.load_work &ledger
      .viscous &ledger.history &ledger.load_impulse &ledger
      .gravity_impulse &ledger.side_impulse &ledger.lost_mass &ledger
      .lost_energy &ledger.lost_momentum &ledger.lost_points;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, IntegratorState<dim> &state, const unsigned int)
  {
    archive &state.wave_speed &state.point_speed &state.displacement &state
      .largest_mass &state.face_pieces;
  }



  template <class Archive>
  void
  serialize(Archive &archive, WriterState &state, const unsigned int)
  {
    archive &state.points &state.grid;
  }



  template <class Archive, int dim>
  void
  serialize(Archive &archive, RunState<dim> &state, const unsigned int)
  {
    archive &state.step &state.time &state.step_size &state.ledger &state
      .integrator &state.balance &state.observables &state.checks &state
      .pictures &state.next_pictures &state.statistics_length &state.warnings;
  }



  namespace
  {
    // To be raised when the content of the files changes.
    constexpr std::uint64_t checkpoint_format = 3;

    constexpr const char *slots[] = {"slot_0.h5", "slot_1.h5"};
    constexpr const char *note    = "good_slot.txt";

    // So many points are read at once.
    constexpr std::size_t portion = 1 << 18;



    /** The place of a cell in the lattice of the scene, x fastest. */
    template <int dim>
    std::uint64_t
    place_in_lattice(const BackgroundGrid<dim> &grid, const std::uint32_t cell)
    {
      const CellGeometry<dim> &geometry = grid.geometry[cell];
      std::uint64_t            result   = 0;
      for (int d = dim - 1; d >= 0; --d)
        result = result * grid.description.cells[d] +
                 std::lround((geometry.origin[d] - grid.description.lower[d]) *
                             geometry.inverse_edge[d]);
      return result;
    }



    /** The local number of the cell at this place, if this rank owns it. */
    template <int dim>
    std::uint32_t
    owned_cell_at(const BackgroundGrid<dim> &grid, std::uint64_t place)
    {
      const GridDescription<dim> &box = grid.description;
      std::array<double, dim>     centre;
      for (int d = 0; d < dim; ++d, place /= box.cells[d - 1])
        centre[d] = box.lower[d] + (box.upper[d] - box.lower[d]) *
                                     (place % box.cells[d] + 0.5) /
                                     box.cells[d];
      const std::uint32_t cell = grid.bins.cell_at(centre);
      return cell < grid.n_owned_cells() ? cell : invalid_cell;
    }



    /** "body 0/mass" */
    std::string
    array_name(const unsigned int body, const std::string &field)
    {
      return "body " + std::to_string(body) + "/" + field;
    }



    template <typename T>
    std::vector<T>
    read_all(const ArrayFile &file, const std::string &name)
    {
      std::vector<T> result(file.size(name));
      file.read(name, 0, result.data(), result.size());
      return result;
    }



    /** What of a portion of points belongs to this rank. */
    struct OwnPoints
    {
      std::vector<std::size_t>   place; // in the portion
      std::vector<std::uint32_t> cell;
    };



    template <int dim>
    OwnPoints
    find_own(const ArrayFile           &file,
             const BackgroundGrid<dim> &grid,
             const unsigned int         body,
             const std::size_t          begin,
             const std::size_t          n)
    {
      std::vector<std::uint64_t> places(n);
      file.read(array_name(body, "cell"), begin, places.data(), n);
      OwnPoints result;
      for (std::size_t p = 0; p < n; ++p)
        {
          const std::uint32_t cell = owned_cell_at(grid, places[p]);
          if (cell == invalid_cell)
            continue;
          result.place.push_back(p);
          result.cell.push_back(cell);
        }
      return result;
    }



    template <typename T>
    std::vector<T>
    pick(const ArrayFile                &file,
         const std::string              &name,
         const std::size_t               begin,
         const std::size_t               n,
         const std::vector<std::size_t> &places)
    {
      std::vector<T> all(n), result;
      file.read(name, begin, all.data(), n);
      result.reserve(places.size());
      for (const std::size_t place : places)
        result.push_back(all[place]);
      return result;
    }



    /** Replace the points of a body by those of the file in cells of mine. */
    template <int dim>
    void
    read_points(const ArrayFile           &file,
                const BackgroundGrid<dim> &grid,
                const unsigned int         body,
                MaterialPoints<dim>       &points)
    {
      const std::size_t n     = file.size(array_name(body, "cell"));
      std::size_t       n_own = 0;
      for (std::size_t begin = 0; begin < n; begin += portion)
        n_own += find_own(file, grid, body, begin, std::min(portion, n - begin))
                   .cell.size();

      points.clear();
      points.reserve(n_own);
      const auto names = points.field_names();
      for (std::size_t begin = 0; begin < n; begin += portion)
        {
          const std::size_t size = std::min(portion, n - begin);
          const OwnPoints   own  = find_own(file, grid, body, begin, size);
          if (own.cell.empty())
            continue;
          std::vector<std::vector<double>> fields;
          for (const std::string &name : names)
            fields.push_back(pick<double>(
              file, array_name(body, name), begin, size, own.place));
          points.append(own.cell,
                        pick<std::uint64_t>(
                          file, array_name(body, "id"), begin, size, own.place),
                        fields);
        }
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



    /** On the disk for certain, as far as the system can tell. */
    void
    settle(const std::string &path)
    {
      const int  file    = open(path.c_str(), O_RDONLY);
      const bool settled = file >= 0 && fsync(file) == 0;
      const int  reason  = errno;
      if (file >= 0)
        close(file);
      if (!settled)
        throw cannot_write(path, std::strerror(reason));
    }
  } // namespace



  template <int dim>
  Checkpoints<dim>::Checkpoints(const Problem<dim>        &problem,
                                const BackgroundGrid<dim> &grid)
    : problem(problem)
    , grid(grid)
    , folder(problem.output.directory + "/checkpoint")
  {}



  template <int dim>
  void
  Checkpoints<dim>::save(const RunState<dim> &state, const Bodies &bodies)
  {
    const std::string slot = slots[good == folder + "/" + slots[0] ? 1 : 0];
    const std::string path = folder + "/" + slot, partial = path + ".part";
    on_first_rank(grid.communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directories(folder, error);
      if (error)
        throw cannot_write(folder, error.message());
    });
    try
      {
        write_file(partial, state, bodies);
      }
    catch (const Failure &)
      {
        std::error_code ignored; // the disk may be full of it
        if (dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0)
          std::filesystem::remove(partial, ignored);
        throw;
      }
    on_first_rank(grid.communicator, [&]() {
      settle(partial);
      std::error_code error;
      std::filesystem::rename(partial, path, error);
      if (error)
        throw cannot_write(path, error.message());
      write_whole_file(folder + "/" + note,
                       slot + "\nstep " + std::to_string(state.step) +
                         ", time " + to_text(state.time) + " s\n");
    });
    good = path;
  }



  template <int dim>
  void
  Checkpoints<dim>::write_file(const std::string   &path,
                               const RunState<dim> &state,
                               const Bodies        &bodies) const
  {
    const bool first =
      dealii::Utilities::MPI::this_mpi_process(grid.communicator) == 0;
    const std::string       scene = join(problem.fixed_entries, "\n");
    const std::vector<char> run =
      dealii::Utilities::pack(state, /*allow_compression=*/false);

    // HDF5's own tables take a few hundred bytes per array.
    std::uint64_t n_bytes = scene.size() + run.size() + (1 << 20);
    for (const auto &body : bodies)
      n_bytes += body->points.n_global() *
                 (body->points.field_names().size() + 2) * sizeof(double);
    GatheredFile file(path, n_bytes, grid.communicator);
    file.write("format", &checkpoint_format, first ? 1 : 0);
    file.write("scene", scene.data(), first ? scene.size() : 0);
    file.write("run", run.data(), first ? run.size() : 0);

    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const MaterialPoints<dim> &points = bodies[b]->points;
        const PointView<dim>       view   = points.view();
        std::vector<std::uint64_t> cells(view.size);
        for (std::size_t p = 0; p < view.size; ++p)
          cells[p] = place_in_lattice(grid, view.cell[p]);
        file.write(array_name(b, "cell"), cells.data(), view.size);
        file.write(array_name(b, "id"), points.all_ids().data(), view.size);
        const auto names = points.field_names();
        for (unsigned int f = 0; f < names.size(); ++f)
          file.write(array_name(b, names[f]),
                     points.field(f).data(),
                     view.size);
      }
    file.close();
  }



  template <int dim>
  void
  Checkpoints<dim>::find_good_file()
  {
    std::string   name;
    std::ifstream file(folder + "/" + note);
    std::getline(file, name);
    if (name != slots[0] && name != slots[1])
      throw InputError(
        "The folder " + in_quotes(folder) +
        " has no checkpoint to go on from: '" + note +
        "' does not name one. Usually the run ended before its first "
        "checkpoint, or --output-directory is another one. Run without "
        "--resume; 'Checkpoint/Interval' says how often one is written.");
    good = folder + "/" + name;
  }



  template <int dim>
  RunState<dim>
  Checkpoints<dim>::load(Bodies &bodies)
  {
    // Every rank reads for itself.
    std::optional<Failure> failure;
    RunState<dim>          state;
    try
      {
        find_good_file();
        state = read_file(bodies);
      }
    catch (const Failure &caught)
      {
        failure.emplace(caught);
      }
    throw_together(failure, grid.communicator);
    return state;
  }



  template <int dim>
  RunState<dim>
  Checkpoints<dim>::read_file(Bodies &bodies) const
  {
    const ArrayFile file(good, ArrayFile::Mode::read);
    if (read_all<std::uint64_t>(file, "format").at(0) != checkpoint_format)
      throw FileError("The checkpoint " + in_quotes(good) +
                      " has another format than this version of Limber "
                      "writes. Usually the program was changed in between. "
                      "Resume with the version named in log.txt, or run "
                      "without --resume.");
    const auto scene = read_all<char>(file, "scene");
    compare_entries({scene.begin(), scene.end()}, problem.fixed_entries);

    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (bodies[b]->points.has_reference() &&
            !file.has(array_name(b, "reference position x")))
          throw InputError(
            "The pictures are to show the displacement ('Output/Fields'), but "
            "the checkpoint " +
            in_quotes(good) +
            " does not know where the points were at the start. Usually the "
            "run was begun without pictures. Leave 'displacement' out of "
            "'Output/Fields'.");
        read_points(file, grid, b, bodies[b]->points);
      }
    return dealii::Utilities::unpack<RunState<dim>>(
      read_all<char>(file, "run"), /*allow_compression=*/false);
  }



  template class Checkpoints<2>;
  template class Checkpoints<3>;
} // namespace limber
