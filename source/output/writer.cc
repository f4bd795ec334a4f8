// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/files.h>
#include <limber/output/pictures.h>
#include <limber/output/pieces.h>
#include <limber/output/point_arrays.h>
#include <limber/output/writer.h>

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <vector>

namespace limber
{
  namespace
  {
    /** "points/points_00012.vtu", as the series names it. */
    std::string
    piece_name(const std::string &series,
               const std::size_t  number,
               const std::string &ending = ".vtu")
    {
      char digits[24];
      std::snprintf(digits, sizeof(digits), "%05zu", number);
      return series + "/" + series + "_" + digits + ending;
    }



    void
    make_folder(const std::string &folder)
    {
      std::error_code error;
      std::filesystem::create_directory(folder, error);
      if (error)
        throw cannot_write(folder, error.message());
    }



    void
    write_series(const std::string                                 &path,
                 const std::vector<std::pair<double, std::string>> &pieces)
    {
      std::ostringstream text;
      text.precision(16); // times, of which six digits are not enough
      dealii::DataOutBase::write_pvd_record(text, pieces);
      write_whole_file(path, text.str());
    }



    /** Removes what a run left that was killed while it wrote. */
    void
    remove_unfinished(const std::string &folder, const std::string &series)
    {
      std::error_code                    error;
      std::vector<std::filesystem::path> unfinished;
      for (const auto &entry :
           std::filesystem::directory_iterator(folder + "/" + series, error))
        if (is_unfinished_piece(entry.path().filename().string(), series))
          unfinished.push_back(entry.path());
      for (const auto &file : unfinished)
        std::filesystem::remove(file, error);
    }



    /** Removes pieces of the series beyond the last one. */
    void
    shorten_series(const std::string                                 &folder,
                   const std::string                                 &series,
                   const std::vector<std::pair<double, std::string>> &pieces)
    {
      remove_unfinished(folder, series);
      std::error_code error;
      std::size_t     number = pieces.size();
      while (std::filesystem::remove(folder + "/" + piece_name(series, number),
                                     error))
        {
          std::filesystem::remove(folder + "/" +
                                    piece_name(series, number, ".h5"),
                                  error);
          ++number;
        }
      const std::string path = folder + "/" + series + ".pvd";
      if (!pieces.empty())
        write_series(path, pieces);
      else
        std::filesystem::remove(path, error);
      if (error)
        throw cannot_write(path, error.message());
    }
  } // namespace



  template <int dim>
  Writer<dim>::Writer(const std::string &folder)
    : folder(folder)
  {}



  template <int dim>
  void
  Writer<dim>::write(const State<dim> &state)
  {
    const MPI_Comm    communicator = state.grid.communicator;
    const std::size_t number       = written.points.size();
    const std::string points       = piece_name("points", number),
                      grid         = piece_name("grid", number);
    on_first_rank(communicator, [&]() {
      make_folder(folder + "/points");
      make_folder(folder + "/grid");
    });

    {
      const Picture<0, dim> picture = draw_points(state);
      write_vtu(folder + "/" + points,
                picture.patches,
                picture.fields,
                state.time,
                communicator);
      if (state.problem.output.point_arrays)
        write_point_arrays(folder + "/" + piece_name("points", number, ".h5"),
                           to_arrays(picture, state.time),
                           communicator);
    }
    const Picture<dim, dim> picture = draw_grid(state);
    write_vtu(folder + "/" + grid,
              picture.patches,
              picture.fields,
              state.time,
              communicator);

    written.points.emplace_back(state.time, points);
    written.grid.emplace_back(state.time, grid);
    on_first_rank(communicator, [&]() {
      write_series(folder + "/points.pvd", written.points);
      write_series(folder + "/grid.pvd", written.grid);
    });
  }



  template <int dim>
  void
  Writer<dim>::restore(const WriterState &former, const MPI_Comm communicator)
  {
    written = former;
    on_first_rank(communicator, [&]() {
      shorten_series(folder, "points", written.points);
      shorten_series(folder, "grid", written.grid);
    });
  }



  template class Writer<2>;
  template class Writer<3>;
} // namespace limber
