// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/output/statistics.h>

#include <gtest/gtest.h>

#include <cmath>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    // Each rank its own: the class is used by one rank only.
    std::string
    own_table()
    {
      const std::string folder = fresh_folder("statistics.dir");
      return folder + "/statistics" +
             std::to_string(
               dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    }
  } // namespace



  TEST(Statistics, HaveNumberedColumnsWithUnitsAndExactNumbers)
  {
    const std::string path  = own_table();
    const double      third = 1. / 3;
    {
      Statistics statistics(path, {{"step", ""}, {"time", "s"}, {"tip", "m"}});
      EXPECT_EQ(content(path), "# 1: step\n# 2: time [s]\n# 3: tip [m]\n");
      statistics.add({0, 0.1, third});
      statistics.add({1, 0.2, -std::numeric_limits<double>::quiet_NaN()});
    }
    std::istringstream text(content(path));
    std::string        line;
    for (unsigned int i = 0; i < 3; ++i)
      std::getline(text, line);
    std::getline(text, line);
    EXPECT_EQ(line.substr(0, 6), "0 0.1 ");
    EXPECT_EQ(std::stod(line.substr(6)), third);
    std::getline(text, line);
    EXPECT_EQ(line, "1 0.2 nan");
    EXPECT_FALSE(std::getline(text, line));
  }



  TEST(Statistics, ContinueWhereACheckpointLeftThem)
  {
    const std::string path   = own_table();
    std::uintmax_t    length = 0;
    {
      Statistics statistics(path, {{"step", ""}});
      statistics.add({1});
      statistics.flush();
      length = statistics.length();
      statistics.add({2});
    }
    EXPECT_EQ(length, content(path).size() - 2);
    {
      Statistics statistics(path, length, 1);
      statistics.add({3});
    }
    EXPECT_EQ(content(path), "# 1: step\n1\n3\n");
    EXPECT_THROW(Statistics(path, 1000, 1), FileError);
  }



  TEST(Statistics, FullDiskAndMissingFolderAreReported)
  {
    EXPECT_THROW(Statistics("no such folder/statistics", {{"step", ""}}),
                 FileError);
    if (!std::filesystem::exists("/dev/full"))
      GTEST_SKIP();
    try
      {
        Statistics statistics("/dev/full", {{"step", ""}});
        FAIL() << "nothing was thrown";
      }
    catch (const FileError &error)
      {
        EXPECT_NE(std::string(error.what()).find("No space left"),
                  std::string::npos)
          << error.what();
        EXPECT_EQ(error.code, ExitCode::file_error);
      }
  }



  TEST(Statistics, FixedColumnsFitTheirRow)
  {
    SampleRun<3>  run(false);
    Observable<3> mass_centre;
    mass_centre.name        = "height";
    mass_centre.unit        = "m";
    mass_centre.kind        = &observable_kind<3>("centre of mass");
    mass_centre.axis        = 2;
    run.problem.observables = {mass_centre};
    Observables<3>  observables(run.state);
    const Totals<3> totals  = Balance<3>(run.state).evaluate(run.state);
    const auto      columns = statistics_columns(run.problem);
    const auto      row     = statistics_row(run.state,
                                    totals,
                                    observables.evaluate(run.state, totals));

    ASSERT_EQ(columns.size(), row.size());
    EXPECT_EQ(columns[1].name, "time");
    EXPECT_EQ(columns[9].name, "momentum z");
    EXPECT_EQ(columns.back().name, "height");
    EXPECT_EQ(columns.back().unit, "m");
    EXPECT_NEAR(row.back(), 0.5, 1e-14);
    EXPECT_EQ(row[3], 256);
    EXPECT_NEAR(row[6], 500, 1e-10);
  }
} // namespace limber::test
