// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <limber/base/memory.h>
#include <limber/base/text.h>
#include <limber/base/unforeseen.h>

#include <unistd.h>

#include <atomic>
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



    // In one call, as messages of mpirun would come in between otherwise.
    void
    write_error(const char *const text)
    {
      std::fprintf(stderr, "Error: %s\n", text);
    }



    // Does not allocate.
    template <std::size_t n>
    void
    tell_memory(char (&text)[n])
    {
      std::snprintf(text,
                    n,
                    without_memory,
                    resident_memory() / 1e9,
                    machine_memory(1) / 1e9);
    }



    // Shared by the ranks of a machine, as a handler without memory can have
    // no messages from them. Null with one rank.
    std::atomic<int> *has_spoken = nullptr;



    // A rank that is not the first waits here until that one has ended it.
    // Signals interrupt the sleep, so it counts.
    void
    wait_for_the_end()
    {
      for (unsigned int seconds = 0; seconds < 30; ++seconds)
        sleep(1);
    }



    [[noreturn]] void
    end_all_ranks()
    {
      std::set_new_handler(nullptr);
      if (has_spoken->exchange(1) == 0)
        {
          char text[400];
          tell_memory(text);
          write_error(text);
        }
      else
        wait_for_the_end();
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
        tell_memory(text);
        return ComputationError(text);
      }
    return ComputationError(
      "A fault that nobody has foreseen: " + in_quotes(told(unforeseen)) +
      ". It is one of the program or of a library, not of the scene. Please "
      "report it with the scene; '--validate' tells whether it comes before "
      "the first step.");
  }



  LastWord::LastWord()
    : spoken(MPI_WIN_NULL)
  {
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
      return;

    MPI_Comm machine;
    MPI_Comm_split_type(
      MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const bool first = dealii::Utilities::MPI::this_mpi_process(machine) == 0;

    void    *memory = nullptr;
    MPI_Aint size   = sizeof(std::atomic<int>);
    int      unit   = 1;
    MPI_Win_allocate_shared(
      first ? size : 0, unit, MPI_INFO_NULL, machine, &memory, &spoken);
    MPI_Win_shared_query(spoken, 0, &size, &unit, &memory);
    has_spoken = static_cast<std::atomic<int> *>(memory);
    if (first)
      new (has_spoken) std::atomic<int>(0);
    MPI_Barrier(machine);
    MPI_Comm_free(&machine);
    std::set_new_handler(end_all_ranks);
  }



  LastWord::~LastWord()
  {
    if (has_spoken == nullptr)
      return;
    std::set_new_handler(nullptr);
    has_spoken = nullptr;
    MPI_Win_free(&spoken);
  }



  void
  LastWord::say(const Failure &failure) const
  {
    if (has_spoken == nullptr || has_spoken->exchange(1) == 0)
      write_error(failure.what());
    else
      wait_for_the_end();
    if (has_spoken != nullptr)
      MPI_Abort(MPI_COMM_WORLD, int(failure.code));
  }
} // namespace limber
