// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/output/vtu.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace limber
{
  namespace
  {
    using dealii::DataOutBase::VtkFlags;



    std::string
    reason_of(const int mpi_error)
    {
      char text[MPI_MAX_ERROR_STRING];
      int  length = 0;
      MPI_Error_string(mpi_error, text, &length);
      return std::string(text, length);
    }



    /** deal.II writes names into attributes as they are. */
    PictureFields
    named_for_xml(PictureFields fields)
    {
      for (std::string &name : fields.names)
        name = escaped_for_xml(name);
      for (auto &range : fields.ranges)
        std::get<2>(range) = escaped_for_xml(std::get<2>(range));
      std::map<std::string, std::string> units;
      for (const auto &[name, unit] : fields.units)
        units[escaped_for_xml(name)] = escaped_for_xml(unit);
      fields.units = units;
      return fields;
    }



    VtkFlags
    flags_for(const PictureFields &fields, const double time)
    {
      VtkFlags flags;
      flags.time                = time;
      flags.print_date_and_time = false; // equal runs give equal files
      flags.compression_level   = VtkFlags::best_speed; // 12 times faster
      flags.physical_units      = fields.units;
      return flags;
    }



    /** What this rank contributes to the file. */
    template <int patch_dim, int dim>
    std::string
    piece_of_file(
      const std::vector<dealii::DataOutBase::Patch<patch_dim, dim>> &patches,
      const PictureFields                                           &fields,
      const VtkFlags                                                &flags,
      const MPI_Comm communicator)
    {
      const unsigned int rank =
        dealii::Utilities::MPI::this_mpi_process(communicator);
      const unsigned int n_ranks =
        dealii::Utilities::MPI::n_mpi_processes(communicator);
      const unsigned long n_patches =
        dealii::Utilities::MPI::sum<unsigned long>(patches.size(),
                                                   communicator);
      std::ostringstream text;
      if (rank == 0)
        dealii::DataOutBase::write_vtu_header(text, flags);
      // ParaView dislikes empty pieces, but a file needs one.
      if (!patches.empty() || (rank == 0 && n_patches == 0))
        dealii::DataOutBase::write_vtu_main(
          patches, fields.names, fields.ranges, flags, text);
      if (rank == n_ranks - 1)
        dealii::DataOutBase::write_vtu_footer(text);
      return text.str();
    }



    /** All texts, rank after rank, into one file. Returns MPI's error code. */
    int
    write_pieces(const std::string &path,
                 const std::string &text,
                 const MPI_Comm     communicator)
    {
      unsigned long       offset = 0;
      const unsigned long length = text.size();
      MPI_Exscan(&length, &offset, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator);
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        offset = 0;

      MPI_File file;
      int      error = MPI_File_open(communicator,
                                path.c_str(),
                                MPI_MODE_CREATE | MPI_MODE_WRONLY,
                                MPI_INFO_NULL,
                                &file);
      if (error != MPI_SUCCESS)
        return error;
      error = MPI_File_set_size(file, 0);
      MPI_Barrier(communicator);

      // MPI counts in 32 bits.
      constexpr std::size_t most = 1 << 30;
      for (std::size_t begin = 0; begin < text.size() && error == MPI_SUCCESS;
           begin += most)
        {
          const int  n         = std::min(most, text.size() - begin);
          int        n_written = 0;
          MPI_Status status;
          error = MPI_File_write_at(
            file, offset + begin, text.data() + begin, n, MPI_CHAR, &status);
          if (error == MPI_SUCCESS)
            MPI_Get_count(&status, MPI_CHAR, &n_written);
          if (error == MPI_SUCCESS && n_written != n)
            error = MPI_ERR_NO_SPACE;
        }
      const int closed = MPI_File_close(&file);
      return error == MPI_SUCCESS ? closed : error;
    }
  } // namespace



  void
  PictureFields::add(const std::string &name,
                     const std::string &unit,
                     const unsigned int n_components)
  {
    using namespace dealii::DataComponentInterpretation;
    const unsigned int first = names.size();
    names.insert(names.end(), n_components, name);
    if (n_components > 1)
      ranges.emplace_back(first,
                          first + n_components - 1,
                          name,
                          n_components > 3 ? component_is_part_of_tensor :
                                             component_is_part_of_vector);
    if (!unit.empty())
      units[name] = unit;
  }



  template <int patch_dim, int dim>
  void
  write_vtu(
    const std::string                                             &path,
    const std::vector<dealii::DataOutBase::Patch<patch_dim, dim>> &patches,
    const PictureFields                                           &fields,
    const double                                                   time,
    const MPI_Comm                                                 communicator)
  {
    const std::string   partial = path + ".part";
    const PictureFields named   = named_for_xml(fields);
    const int           error   = write_pieces(
      partial,
      piece_of_file(patches, named, flags_for(named, time), communicator),
      communicator);
    std::optional<Failure> failure;
    if (error != MPI_SUCCESS)
      {
        failure.emplace(cannot_write(path, reason_of(error)));
        std::remove(partial.c_str()); // makes room on a full disk
      }
    throw_together(failure, communicator);

    on_first_rank(communicator, [&]() {
      if (std::rename(partial.c_str(), path.c_str()) != 0)
        throw cannot_write(path, std::strerror(errno));
    });
  }



  template <int dim>
  using PointPatches = std::vector<dealii::DataOutBase::Patch<0, dim>>;
  template <int dim>
  using CellPatches = std::vector<dealii::DataOutBase::Patch<dim, dim>>;

  template void
  write_vtu<0, 2>(const std::string &,
                  const PointPatches<2> &,
                  const PictureFields &,
                  const double,
                  const MPI_Comm);
  template void
  write_vtu<0, 3>(const std::string &,
                  const PointPatches<3> &,
                  const PictureFields &,
                  const double,
                  const MPI_Comm);
  template void
  write_vtu<2, 2>(const std::string &,
                  const CellPatches<2> &,
                  const PictureFields &,
                  const double,
                  const MPI_Comm);
  template void
  write_vtu<3, 3>(const std::string &,
                  const CellPatches<3> &,
                  const PictureFields &,
                  const double,
                  const MPI_Comm);
} // namespace limber
