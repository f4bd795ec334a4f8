// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/unforeseen.h>
#include <limber/output/files.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace limber
{
  void
  write_whole_file(const std::string &path, const std::string &text)
  {
    const std::string partial = path + ".part";
    std::remove(partial.c_str()); // of a run that was killed
    try
      {
        TextFile file(partial, TextFile::Mode::fresh);
        file.write(text);
        file.close();
      }
    catch (const FileError &)
      {
        std::remove(partial.c_str());
        throw;
      }
    if (std::rename(partial.c_str(), path.c_str()) != 0)
      throw cannot_write(path, std::strerror(errno));
  }



  void
  throw_together(const std::optional<Failure> &own, const MPI_Comm communicator)
  {
    const unsigned int n =
      dealii::Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int failed =
      dealii::Utilities::MPI::min(own ? rank : n, communicator);
    if (failed == n)
      return;

    std::array<unsigned long, 2> header{};
    std::string                  message;
    if (rank == failed)
      {
        message = own->what();
        header  = {{static_cast<unsigned long>(own->code), message.size()}};
      }
    MPI_Bcast(header.data(), 2, MPI_UNSIGNED_LONG, failed, communicator);
    message.resize(header[1]);
    MPI_Bcast(&message[0], header[1], MPI_CHAR, failed, communicator);

    switch (static_cast<ExitCode>(header[0]))
      {
        case ExitCode::wrong_input:
          throw InputError(message);
        case ExitCode::computation_failed:
          throw ComputationError(message);
        case ExitCode::file_error:
          throw FileError(message);
        default:
          throw Failure(static_cast<ExitCode>(header[0]), message);
      }
  }



  void
  on_first_rank(const MPI_Comm communicator, const std::function<void()> &task)
  {
    std::optional<Failure> failure;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          task();
        }
      catch (const Failure &caught)
        {
          failure.emplace(caught);
        }
      catch (const std::filesystem::filesystem_error &caught)
        {
          failure.emplace(
            cannot_write(caught.path1().string(), caught.code().message()));
        }
      catch (const std::exception &caught)
        {
          failure.emplace(as_failure(caught));
        }
    throw_together(failure, communicator);
  }
} // namespace limber
