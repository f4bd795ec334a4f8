// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/output/pictures.h>
#include <limber/output/writer.h>

#include <gtest/gtest.h>

#include <cmath>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    /** Sum of an attribute such as NumberOfPoints over all pieces. */
    unsigned int
    total(const std::string &text, const std::string &attribute)
    {
      unsigned int      result = 0;
      const std::string key    = attribute + "=\"";
      for (auto at = text.find(key); at != std::string::npos;
           at      = text.find(key, at + 1))
        result += std::stoi(text.substr(at + key.size()));
      return result;
    }



    bool
    has(const std::string &text, const std::string &part)
    {
      return text.find(part) != std::string::npos;
    }
  } // namespace



  TEST(Writer, WritesPointsGridAndSeries)
  {
    SampleRun<2> run(true);
    run.problem.output.fields = {"displacement",
                                 "velocity",
                                 "pressure",
                                 "stress",
                                 "equivalent stress",
                                 "volume ratio",
                                 "mass",
                                 "point pressure",
                                 "point stress",
                                 "body"};
    const std::string folder  = fresh_folder("writer.dir");
    Writer<2>         writer(folder);
    writer.write(run.state);
    run.state.time = 0.12345678;
    writer.write(run.state);

    for (const char *const number : {"00000", "00001"})
      {
        const std::string points =
          content(folder + "/points/points_" + number + ".vtu");
        EXPECT_EQ(total(points, "NumberOfPoints"), run.n_points);
        for (const std::string &field : run.problem.output.fields)
          EXPECT_TRUE(has(points, "Name=\"" + field + "\"")) << field;
        EXPECT_TRUE(has(points, "units=\"m/s\""));
        EXPECT_TRUE(has(points, "</VTKFile>"));
        const std::string grid =
          content(folder + "/grid/grid_" + number + ".vtu");
        EXPECT_EQ(total(grid, "NumberOfCells"), 16u);
        EXPECT_TRUE(has(grid, "Name=\"pressure of block\""));
        EXPECT_TRUE(has(grid, "Name=\"volume ratio of block\""));
      }
    const std::string series = content(folder + "/points.pvd");
    EXPECT_TRUE(has(series, "points/points_00001.vtu"));
    EXPECT_TRUE(has(series, "0.12345678"));
    EXPECT_TRUE(has(content(folder + "/grid.pvd"), "grid/grid_00001.vtu"));
    EXPECT_EQ(writer.state().points.size(), 2u);
  }



  TEST(Writer, TakesASeriesUpWhereACheckpointLeftIt)
  {
    SampleRun<2>      run(false);
    const std::string folder = fresh_folder("writer.dir");
    WriterState       former;
    {
      Writer<2> writer(folder);
      writer.write(run.state);
      former = writer.state();
      for (run.state.time = 1; run.state.time < 3; ++run.state.time)
        writer.write(run.state);
    }
    Writer<2> writer(folder);
    writer.restore(former, MPI_COMM_WORLD);
    EXPECT_FALSE(has(content(folder + "/points.pvd"), "points_00001"));
    EXPECT_EQ(content(folder + "/points/points_00002.vtu"), "");
    writer.write(run.state);
    EXPECT_TRUE(has(content(folder + "/grid.pvd"), "grid_00001"));

    writer.restore({}, MPI_COMM_WORLD);
    EXPECT_EQ(content(folder + "/grid/grid_00000.vtu"), "");
    EXPECT_EQ(content(folder + "/grid.pvd"), "");
  }



  TEST(Writer, ThreeDimensionsWithoutFields)
  {
    SampleRun<3> run(false);
    run.problem.output.fields = {};
    const std::string folder  = fresh_folder("writer.dir");
    Writer<3>(folder).write(run.state);
    EXPECT_EQ(total(content(folder + "/points/points_00000.vtu"),
                    "NumberOfPoints"),
              run.n_points);
    EXPECT_EQ(total(content(folder + "/grid/grid_00000.vtu"), "NumberOfCells"),
              64u);
  }



  TEST(Writer, NoPointsAnywhere)
  {
    SampleRun<2> run(true);
    run.problem.output.fields = {"velocity", "pressure"};
    PointView<2> points       = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      points.cell[p] = invalid_cell;
    run.points().remove_lost();
    const std::string folder = fresh_folder("writer.dir");
    Writer<2>(folder).write(run.state);
    const std::string text = content(folder + "/points/points_00000.vtu");
    EXPECT_EQ(total(text, "NumberOfPoints"), 0u);
    EXPECT_TRUE(has(text, "</VTKFile>"));
  }



  TEST(Writer, AFolderThatIsNotThereIsReportedByAllRanks)
  {
    SampleRun<2> run(false);
    EXPECT_THROW(write_vtu("no such folder/points.vtu",
                           draw_points(run.state).patches,
                           {},
                           0,
                           MPI_COMM_WORLD),
                 FileError);
  }



  TEST(Pictures, StressIsCauchyWithAllNineComponents)
  {
    SampleRun<2> run(false);
    run.problem.output.fields = {"displacement", "stress", "equivalent stress"};
    PointView<2> points       = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        points.position[0][p] += 0.01;
        points.pressure[p]    = 1e5;
        points.deviator[0][p] = 3e4;
        points.deviator[1][p] = -1e4;
        points.deviator[2][p] = 5e3;
      }
    const double        J       = 1 - 1e5 / run.bulk_modulus;
    const Picture<0, 2> picture = draw_points(run.state);
    const std::string   last    = picture.fields.names.back();
    ASSERT_EQ(picture.patches.size(), run.points().size());
    EXPECT_EQ(picture.fields.names.size(), 12u);
    EXPECT_EQ(last, "equivalent stress");
    for (const auto &patch : picture.patches)
      {
        const auto &data = patch.data;
        EXPECT_NEAR(data(0, 0), 0.01, 1e-8);
        EXPECT_NEAR(data(2, 0) * J, -7e4, 0.1);   // xx
        EXPECT_NEAR(data(3, 0) * J, 5e3, 0.1);    // xy
        EXPECT_NEAR(data(6, 0) * J, -11e4, 0.1);  // yy
        EXPECT_NEAR(data(10, 0) * J, -12e4, 0.1); // zz
        EXPECT_NEAR(data(11, 0) * J,
                    std::sqrt(1.5 * (9e8 + 1e8 + 4e8 + 2 * 25e6)),
                    0.1);
      }
  }
} // namespace limber::test
