// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/solid_samples.h>
#include <limber/output/files.h>
#include <limber/output/point_arrays.h>
#include <limber/simulation/reference_fields.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

namespace limber
{
  template <int dim>
  void
  write_reference_fields(const std::string      &folder,
                         const unsigned int      number,
                         const SolidModel<dim>  &model,
                         const SolidMotion<dim> &motion)
  {
    on_first_rank(model.communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directory(folder + "/nodes", error);
      if (error)
        throw cannot_write(folder + "/nodes", error.message());
    });

    PointArrays<dim> arrays;
    arrays.time = motion.time;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      arrays.place.push_back(place);
      auto &u = arrays.displacement.emplace_back();
      auto &v = arrays.velocity.emplace_back();
      for (unsigned int d = 0; d < dim; ++d)
        {
          u[d] = motion.displacement[dofs[d]];
          v[d] = motion.velocity[dofs[d]];
        }
    });
    for (const MaterialState &state : nodal_states(model, motion.displacement))
      {
        const auto &s = state.stress;
        arrays.pressure.push_back(state.pressure);
        arrays.stress.push_back(
          {{s[0][0], s[1][1], s[2][2], s[0][1], s[1][2], s[2][0]}});
      }
    char name[32];
    std::snprintf(name, sizeof(name), "/nodes/nodes_%05u.h5", number);
    write_point_arrays(folder + name, arrays, model.communicator);
  }



  template <int dim>
  std::vector<NodalStress>
  read_reference_fields(const std::string     &path,
                        const SolidModel<dim> &model,
                        NodalVector           &displacement,
                        NodalVector           &velocity)
  {
    const auto arrays = read_point_arrays<dim>(path);

    // Ranks may number nodes in any order; they are identified by their places.
    const double unit = 1e-6 * model.smallest_edge;
    const auto   key  = [&](const dealii::Point<dim> &place) {
      std::array<long long, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = std::llround(place[d] / unit);
      return result;
    };
    std::map<std::array<long long, dim>, std::size_t> index;
    for (std::size_t i = 0; i < arrays.size(); ++i)
      index[key(arrays.place[i])] = i;

    std::vector<NodalStress> stresses;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      const auto found = index.find(key(place));
      if (found == index.end())
        throw FileError("The nodes in '" + path +
                        "' are not those of the mesh that the scene beside "
                        "it makes. Usually the folder was put together by "
                        "hand. Compute the reference anew.");
      for (unsigned int d = 0; d < dim; ++d)
        {
          displacement[dofs[d]] = arrays.displacement[found->second][d];
          velocity[dofs[d]]     = arrays.velocity[found->second][d];
        }
      NodalStress &stress = stresses.emplace_back();
      stress[0]           = arrays.pressure[found->second];
      std::copy_n(arrays.stress[found->second].begin(), 6, stress.begin() + 1);
    });
    displacement.update_ghost_values();
    velocity.update_ghost_values();
    return stresses;
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
  template std::vector<NodalStress>
  read_reference_fields(const std::string &,
                        const SolidModel<2> &,
                        NodalVector &,
                        NodalVector &);
  template std::vector<NodalStress>
  read_reference_fields(const std::string &,
                        const SolidModel<3> &,
                        NodalVector &,
                        NodalVector &);
} // namespace limber
