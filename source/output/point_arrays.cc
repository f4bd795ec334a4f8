// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/array_file.h>
#include <limber/output/point_arrays.h>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace limber
{
  namespace
  {
    const std::string     directions     = "xyz";
    constexpr const char *stress_names[] = {"stress xx",
                                            "stress yy",
                                            "stress zz",
                                            "stress xy",
                                            "stress yz",
                                            "stress zx"};
    // Where they stand in a matrix by rows
    constexpr unsigned int stress_entries[] = {0, 4, 8, 1, 5, 6};

    unsigned int
    n_stresses(const unsigned int dim)
    {
      return dim == 2 ? 4 : 6;
    }



    /** One array of a file: its name, how many numbers, which they are. */
    template <int dim>
    void
    for_each_array(
      PointArrays<dim> &arrays,
      const std::function<void(const std::string &,
                               const std::function<double *(std::size_t)> &)>
        &work)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          work(std::string("initial place ") + directions[d],
               [&, d](const std::size_t p) { return &arrays.place[p][d]; });
          work(std::string("displacement ") + directions[d],
               [&, d](const std::size_t p) {
                 return &arrays.displacement[p][d];
               });
          work(std::string("velocity ") + directions[d],
               [&, d](const std::size_t p) { return &arrays.velocity[p][d]; });
        }
      work("pressure",
           [&](const std::size_t p) { return &arrays.pressure[p]; });
      for (unsigned int k = 0; k < n_stresses(dim); ++k)
        work(stress_names[k],
             [&, k](const std::size_t p) { return &arrays.stress[p][k]; });
    }



    template <int dim>
    void
    resize(PointArrays<dim> &arrays, const std::size_t n)
    {
      arrays.place.resize(n);
      arrays.displacement.resize(n);
      arrays.velocity.resize(n);
      arrays.pressure.resize(n);
      arrays.stress.resize(n);
    }
  } // namespace



  template <int dim>
  void
  write_point_arrays(const std::string      &path,
                     const PointArrays<dim> &own,
                     const MPI_Comm          communicator)
  {
    const bool first =
      dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    const std::size_t n =
      dealii::Utilities::MPI::sum<unsigned long>(own.size(), communicator);
    const bool with_mass =
      dealii::Utilities::MPI::max(int(!own.mass.empty()), communicator) != 0;
    constexpr std::uint64_t overhead = 1 << 16; // of HDF5, generously
    GatheredFile            file(path,
                      overhead +
                        n * sizeof(double) * (3 * dim + 2 + n_stresses(dim)),
                      communicator);
    file.write("time", &own.time, first ? 1 : 0);

    PointArrays<dim>    copy = own;
    std::vector<double> values(own.size());
    for_each_array<dim>(copy, [&](const std::string &name, const auto &entry) {
      for (std::size_t p = 0; p < values.size(); ++p)
        values[p] = *entry(p);
      file.write(name, values.data(), values.size());
    });
    if (with_mass)
      file.write("mass", own.mass.data(), own.mass.size());
    file.close();
  }



  template <int dim>
  PointArrays<dim>
  read_point_arrays(const std::string &path)
  {
    const ArrayFile  file(path, ArrayFile::Mode::read);
    PointArrays<dim> result;
    file.read("time", 0, &result.time, 1);
    const std::size_t n = file.size("pressure");
    resize(result, n);
    std::vector<double> values(n);
    for_each_array<dim>(result,
                        [&](const std::string &name, const auto &entry) {
                          file.read(name, 0, values.data(), n);
                          for (std::size_t p = 0; p < n; ++p)
                            *entry(p) = values[p];
                        });
    if (file.has("mass"))
      {
        result.mass.resize(n);
        file.read("mass", 0, result.mass.data(), n);
      }
    return result;
  }



  template <int dim>
  PointArrays<dim>
  to_arrays(const Picture<0, dim> &picture, const double time)
  {
    const auto first_of = [&](const std::string &field) {
      const auto found = std::find(picture.fields.names.begin(),
                                   picture.fields.names.end(),
                                   field);
      AssertThrow(found != picture.fields.names.end(),
                  dealii::ExcInternalError());
      return static_cast<unsigned int>(found - picture.fields.names.begin());
    };
    const unsigned int u = first_of("displacement"), v = first_of("velocity"),
                       p = first_of("pressure"), s = first_of("stress"),
                       m = first_of("mass");

    PointArrays<dim> result;
    result.time = time;
    resize(result, picture.patches.size());
    result.mass.resize(picture.patches.size());
    for (std::size_t i = 0; i < picture.patches.size(); ++i)
      {
        const auto &patch = picture.patches[i];
        result.place[i]   = patch.vertices[0];
        for (unsigned int d = 0; d < dim; ++d)
          {
            result.displacement[i][d] = patch.data(u + d, 0);
            result.velocity[i][d]     = patch.data(v + d, 0);
            result.place[i][d] -= result.displacement[i][d];
          }
        result.pressure[i] = patch.data(p, 0);
        result.mass[i]     = patch.data(m, 0);
        for (unsigned int k = 0; k < 6; ++k)
          result.stress[i][k] = patch.data(s + stress_entries[k], 0);
      }
    return result;
  }



  std::vector<std::pair<double, std::string>>
  find_point_arrays(const std::string &folder, const std::string &series)
  {
    std::vector<std::pair<double, std::string>> result;
    std::error_code                             error;
    for (const auto &entry :
         std::filesystem::directory_iterator(folder + "/" + series, error))
      if (entry.path().extension() == ".h5")
        {
          const ArrayFile file(entry.path().string(), ArrayFile::Mode::read);
          double          time = 0;
          file.read("time", 0, &time, 1);
          result.emplace_back(time, entry.path().string());
        }
    std::sort(result.begin(), result.end());
    return result;
  }



  template void
  write_point_arrays(const std::string &, const PointArrays<2> &, MPI_Comm);
  template void
  write_point_arrays(const std::string &, const PointArrays<3> &, MPI_Comm);
  template PointArrays<2>
  read_point_arrays(const std::string &);
  template PointArrays<3>
  read_point_arrays(const std::string &);
  template PointArrays<2>
  to_arrays(const Picture<0, 2> &, const double);
  template PointArrays<3>
  to_arrays(const Picture<0, 3> &, const double);
} // namespace limber
