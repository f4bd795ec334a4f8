// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/array_file.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace
{
  using namespace limber;



  TEST(ArrayFile, ReturnsWhatAllRanksHavePutIn)
  {
    const std::string  path = test::fresh_folder("array_file.dir") + "/a.h5";
    const unsigned int n_ranks =
      dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    // The first rank has none, the others have ever more.
    const std::vector<double>        own(3 * rank, 0.1 * rank);
    const std::vector<std::uint64_t> large(2, (1ul << 60) + rank);
    {
      GatheredFile file(path, 1000, MPI_COMM_WORLD);
      file.write("group of mine/numbers", own.data(), own.size());
      file.write("large", large.data(), large.size());
      file.write("text", "first", rank == 0 ? 5 : 0);
      file.close();
    }

    const ArrayFile file(path, ArrayFile::Mode::read);
    ASSERT_EQ(file.size("group of mine/numbers"),
              3 * n_ranks * (n_ranks - 1) / 2);
    std::size_t begin = 0;
    for (unsigned int r = 0; r < n_ranks; ++r)
      for (unsigned int i = 0; i < 3 * r; ++i)
        {
          double value;
          file.read("group of mine/numbers", begin++, &value, 1);
          EXPECT_EQ(value, 0.1 * r);
        }
    std::vector<std::uint64_t> all(file.size("large"));
    file.read("large", 0, all.data(), all.size());
    for (unsigned int i = 0; i < 2 * n_ranks; ++i)
      EXPECT_EQ(all[i], (1ul << 60) + i / 2);
    EXPECT_EQ(file.size("text"), 5u);
    EXPECT_FALSE(file.has("nothing"));
    EXPECT_THROW(file.size("nothing"), FileError);
  }



  TEST(ArrayFile, TellsOfFailuresOnAllRanks)
  {
    GatheredFile nowhere("no such folder/a.h5", 1000, MPI_COMM_WORLD);
    const double value = 1;
    nowhere.write("number", &value, 1);
    EXPECT_THROW(nowhere.close(), FileError);

    GatheredFile enormous("enormous.h5", 1ul << 62, MPI_COMM_WORLD);
    EXPECT_THROW(enormous.close(), FileError);
    EXPECT_THROW(ArrayFile("no such file", ArrayFile::Mode::read), FileError);
  }
} // namespace
