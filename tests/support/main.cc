// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cfenv>
#include <iostream>

namespace
{
  /** What the ranks other than the first say: only what went wrong. */
  class FailurePrinter : public testing::EmptyTestEventListener
  {
    void
    OnTestPartResult(const testing::TestPartResult &result) override
    {
      if (result.failed())
        std::cout << "[  rank "
                  << dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)
                  << "  ] " << result.file_name() << ':' << result.line_number()
                  << ": " << result.message() << std::endl;
    }
  };
} // namespace



/** GoogleTest under MPI: every rank runs every case. */
int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  testing::InitGoogleTest(&argc, argv);

#ifdef DEBUG
  // The package's debug library does not trap these; MPI_Init itself may
  // raise them, hence not before.
  feenableexcept(FE_DIVBYZERO | FE_INVALID);
#endif

  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    {
      auto &listeners = testing::UnitTest::GetInstance()->listeners();
      delete listeners.Release(listeners.default_result_printer());
      listeners.Append(new FailurePrinter);
    }

  return RUN_ALL_TESTS();
}
