// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/point_arrays.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace
{
  using namespace limber;



  template <int dim>
  void
  write_and_read(const bool with_mass)
  {
    const std::string  folder = test::fresh_folder("point_arrays.dir");
    const unsigned int n_ranks =
      dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);

    PointArrays<dim> own;
    own.time = 0.25;
    for (unsigned int p = 0; p < 3; ++p)
      {
        const double number = 3 * rank + p + 1;
        for (unsigned int d = 0; d < dim; ++d)
          {
            own.place.resize(p + 1);
            own.displacement.resize(p + 1);
            own.velocity.resize(p + 1);
            own.place[p][d]        = number + 0.1 * d;
            own.displacement[p][d] = 1e-12 * number + d;
            own.velocity[p][d]     = -number * d;
          }
        own.pressure.push_back(1e9 * number);
        std::array<double, 6> stress{};
        for (unsigned int k = 0; k < (dim == 2 ? 4 : 6); ++k)
          stress[k] = number / (k + 1);
        own.stress.push_back(stress);
        if (with_mass)
          own.mass.push_back(number);
      }
    write_point_arrays(folder + "/points_00007.h5", own, MPI_COMM_WORLD);

    const auto all = read_point_arrays<dim>(folder + "/points_00007.h5");
    EXPECT_EQ(all.time, 0.25);
    ASSERT_EQ(all.size(), 3 * n_ranks);
    EXPECT_EQ(all.mass.empty(), !with_mass);
    for (unsigned int p = 0; p < 3; ++p)
      {
        EXPECT_EQ(all.place[3 * rank + p], own.place[p]);
        EXPECT_EQ(all.displacement[3 * rank + p], own.displacement[p]);
        EXPECT_EQ(all.velocity[3 * rank + p], own.velocity[p]);
        EXPECT_EQ(all.pressure[3 * rank + p], own.pressure[p]);
        EXPECT_EQ(all.stress[3 * rank + p], own.stress[p]);
        if (with_mass)
          {
            EXPECT_EQ(all.mass[3 * rank + p], own.mass[p]);
          }
      }
  }



  TEST(PointArrays, ReturnWhatWasWritten)
  {
    write_and_read<2>(true);
    write_and_read<3>(true);
    write_and_read<2>(false);
  }



  TEST(PointArrays, OfAFolderWithoutThemThereAreNone)
  {
    EXPECT_TRUE(find_point_arrays("nowhere", "points").empty());
  }
} // namespace
