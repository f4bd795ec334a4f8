// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/array_file.h>
#include <limber/output/files.h>
#include <limber/simulation/reference_fields.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

namespace limber
{
  namespace
  {
    const std::string directions = "xyz";

    std::string
    name_of(const std::string &quantity, const unsigned int axis)
    {
      return quantity + " " + directions[axis];
    }
  } // namespace



  template <int dim>
  void
  write_reference_fields(const std::string      &folder,
                         const unsigned int      number,
                         const SolidModel<dim>  &model,
                         const SolidMotion<dim> &motion)
  {
    on_first_rank(model.communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directories(folder + "/nodes", error);
      if (error)
        throw cannot_write(folder + "/nodes", error.message());
    });

    std::map<std::string, std::vector<double>> arrays;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        {
          arrays[name_of("place", d)].push_back(place[d]);
          arrays[name_of("displacement", d)].push_back(
            motion.displacement[dofs[d]]);
          arrays[name_of("velocity", d)].push_back(motion.velocity[dofs[d]]);
        }
    });
    for (const MaterialState &state : model.nodal_states(motion.displacement))
      {
        arrays["pressure"].push_back(state.pressure);
        arrays["volume ratio"].push_back(state.volume_ratio);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = i; j < 3; ++j)
            if (dim == 3 || i == j || j < 2)
              arrays[std::string("stress ") + directions[i] + directions[j]]
                .push_back(state.stress[i][j]);
      }

    // Ranks without nodes write nothing of everything, in the same order.
    std::vector<std::string> names;
    for (const auto &[name, values] : arrays)
      names.push_back(name);
    for (const auto &others :
         dealii::Utilities::MPI::all_gather(model.communicator, names))
      if (others.size() > names.size())
        names = others;

    char digits[32];
    std::snprintf(digits, sizeof(digits), "/nodes/nodes_%05u.h5", number);
    const std::uint64_t n_bytes = 16384 + names.size() *
                                            (model.dof_handler.n_dofs() / dim) *
                                            sizeof(double);
    GatheredFile file(folder + digits, n_bytes, model.communicator);
    const bool   first =
      dealii::Utilities::MPI::this_mpi_process(model.communicator) == 0;
    file.write("time", &motion.time, first ? 1 : 0);
    for (const std::string &name : names)
      file.write(name, arrays[name].data(), arrays[name].size());
    file.close();
  }



  std::vector<std::pair<double, std::string>>
  reference_field_files(const std::string &folder)
  {
    std::vector<std::pair<double, std::string>> result;
    std::error_code                             error;
    for (const auto &entry :
         std::filesystem::directory_iterator(folder + "/nodes", error))
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



  template <int dim>
  void
  read_reference_fields(const std::string     &path,
                        const SolidModel<dim> &model,
                        NodalVector           &displacement,
                        NodalVector           &velocity)
  {
    const ArrayFile   file(path, ArrayFile::Mode::read);
    const std::size_t n    = file.size("pressure");
    const auto        read = [&](const std::string &name) {
      std::vector<double> values(n);
      file.read(name, 0, values.data(), n);
      return values;
    };
    std::array<std::vector<double>, dim> place, u, v;
    for (unsigned int d = 0; d < dim; ++d)
      {
        place[d] = read(name_of("place", d));
        u[d]     = read(name_of("displacement", d));
        v[d]     = read(name_of("velocity", d));
      }

    // Ranks number nodes as they like; their places tell which is which.
    const double unit = 1e-6 * model.smallest_edge;
    const auto   key  = [&](const auto &coordinate) {
      std::array<long long, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = std::llround(coordinate(d) / unit);
      return result;
    };
    std::map<std::array<long long, dim>, std::size_t> index;
    for (std::size_t i = 0; i < n; ++i)
      index[key([&](const unsigned int d) { return place[d][i]; })] = i;

    model.for_each_owned_node([&](const auto &x, const auto &dofs) {
      const auto found =
        index.find(key([&](const unsigned int d) { return x[d]; }));
      if (found == index.end())
        throw FileError("The nodes in '" + path +
                        "' are not those of the mesh that the scene beside "
                        "it makes. Usually the folder was put together by "
                        "hand. Compute the reference anew.");
      for (unsigned int d = 0; d < dim; ++d)
        {
          displacement[dofs[d]] = u[d][found->second];
          velocity[dofs[d]]     = v[d][found->second];
        }
    });
    displacement.update_ghost_values();
    velocity.update_ghost_values();
  }



  template void
  write_reference_fields(const std::string &,
                         const unsigned int,
                         const SolidModel<2> &,
                         const SolidMotion<2> &);
  template void
  write_reference_fields(const std::string &,
                         const unsigned int,
                         const SolidModel<3> &,
                         const SolidMotion<3> &);
  template void
  read_reference_fields(const std::string &,
                        const SolidModel<2> &,
                        NodalVector &,
                        NodalVector &);
  template void
  read_reference_fields(const std::string &,
                        const SolidModel<3> &,
                        NodalVector &,
                        NodalVector &);
} // namespace limber
