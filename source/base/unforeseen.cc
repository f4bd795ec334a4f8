// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <limber/base/memory.h>
#include <limber/base/text.h>
#include <limber/base/unforeseen.h>

#include <cstdio>
#include <new>
#include <sstream>
#include <stdexcept>

namespace limber
{
  namespace
  {
    constexpr const char *without_memory =
      "Memory is exhausted: this process holds %.3g GB of the machine's %.3g "
      "GB. Usually the scene has too many cells or points, or other programs "
      "run beside it. Set 'Grid/Cells' or 'Points per cell edge' lower, or "
      "take more machines.";



    std::string
    told(const std::exception &unforeseen)
    {
      if (const auto *of_deal_ii =
            dynamic_cast<const dealii::ExceptionBase *>(&unforeseen))
        {
          std::ostringstream text;
          of_deal_ii->print_info(text);
          return trimmed(text.str());
        }
      return unforeseen.what();
    }



    [[noreturn]] void
    end_all_ranks()
    {
      std::set_new_handler(nullptr);
      std::fputs("Error: ", stderr);
      std::fprintf(stderr,
                   without_memory,
                   resident_memory() / 1e9,
                   machine_memory(1) / 1e9);
      std::fputs("\n", stderr);
      MPI_Abort(MPI_COMM_WORLD, int(ExitCode::computation_failed));
      throw std::bad_alloc();
    }
  } // namespace



  ComputationError
  as_failure(const std::exception &unforeseen)
  {
    // Arrays that are longer than any memory have an exception of their own.
    if (dynamic_cast<const std::bad_alloc *>(&unforeseen) != nullptr ||
        dynamic_cast<const std::length_error *>(&unforeseen) != nullptr)
      {
        char text[400];
        std::snprintf(text,
                      sizeof(text),
                      without_memory,
                      resident_memory() / 1e9,
                      machine_memory(1) / 1e9);
        return ComputationError(text);
      }
    return ComputationError(
      "A fault that nobody has foreseen: " + in_quotes(told(unforeseen)) +
      ". It is one of the program or of a library, not of the scene. Please "
      "report it with the scene; '--validate' tells whether it comes before "
      "the first step.");
  }



  void
  end_all_ranks_without_memory()
  {
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      std::set_new_handler(end_all_ranks);
  }
} // namespace limber
