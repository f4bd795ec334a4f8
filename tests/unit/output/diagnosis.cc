// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/diagnosis.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    bool
    speaks()
    {
      return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    }



    template <class Pressure>
    void
    set_pressure(SampleRun<2> &run, const Pressure &pressure)
    {
      const PointView<2> points = run.points().view();
      for (std::size_t p = 0; p < points.size; ++p)
        points.pressure[p] =
          pressure(points.position[0][p], points.position[1][p]);
    }
  } // namespace



  TEST(Diagnosis, ABodyAtRestShowsNothing)
  {
    SampleRun<2>   run(/*projected=*/true);
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    EXPECT_EQ(seen.unseen_energy, 0);
    EXPECT_EQ(seen.not_finite, 0u);
    EXPECT_NEAR(seen.bodies[0].filling, 0.5, 1e-12);
    EXPECT_EQ(seen.bodies[0].isolated_cells, 0);
    EXPECT_EQ(diagnose(seen, run.problem, true).mode, "");
  }



  // Whatever else an unstable run shows.
  TEST(Diagnosis, AffineVelocitiesWithLinearFunctionsAreNamedFirst)
  {
    SampleRun<2> run(/*projected=*/true);
    set_pressure(run, [](double x, double y) {
      return std::lround(8 * x + 8 * y) % 2 == 0 ? 1e3 : -1e3;
    });
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    run.problem.method.transfer = Transfer::aflip;
    const Diagnosis found       = diagnose(seen, run.problem, true);
    EXPECT_EQ(found.mode, "affine velocity");
    EXPECT_TRUE(found.is_unstable);
    EXPECT_NE(found.text.find("'Method/Transfer = flip'"), std::string::npos);
    run.problem.method.transfer = Transfer::apic; // has a bound
    EXPECT_NE(diagnose(seen, run.problem, true).mode, "affine velocity");
    run.problem.method.transfer = Transfer::aflip;
    run.problem.grid.kernel     = KernelKind::quadratic;
    EXPECT_NE(diagnose(seen, run.problem, true).mode, "affine velocity");
  }



  TEST(Diagnosis, LinearPressureIsNoCheckerboardAndDoesNotLock)
  {
    SampleRun<2> run(/*projected=*/false);
    set_pressure(run, [](double, double y) { return 10 * (1 - y); });
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    EXPECT_NEAR(seen.bodies[0].checkerboard, 0, 1e-3);
    EXPECT_LT(seen.bodies[0].pressure_scatter, 0.2);
  }



  TEST(Diagnosis, PressureThatOscillatesWithinCellsIsLocking)
  {
    SampleRun<2> run(/*projected=*/false);
    set_pressure(run, [](double x, double) {
      return std::fmod(x, 0.25) < 0.125 ? 11. : -9.;
    });
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    EXPECT_NEAR(seen.bodies[0].pressure_scatter, 10, 0.1);
    const Diagnosis found = diagnose(seen, run.problem, false);
    EXPECT_EQ(found.mode, "locking");
    EXPECT_NE(found.text.find("Locking treatment = cell'"), std::string::npos);
    run.problem.grid.kernel = KernelKind::quadratic;
    EXPECT_NE(
      diagnose(seen, run.problem, false).text.find("Locking treatment = node'"),
      std::string::npos);
    // which is no reason why points get lost
    EXPECT_FALSE(diagnose(seen, run.problem, true).is_unstable);
  }



  TEST(Diagnosis, Checkerboard)
  {
    SampleRun<2> run(/*projected=*/true);
    set_pressure(run, [](double x, double y) {
      return (int(x / 0.25) + int(y / 0.25)) % 2 == 0 ? 1. : -1.;
    });
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    EXPECT_NEAR(seen.bodies[0].checkerboard, 2, 1e-4);
    const Diagnosis found = diagnose(seen, run.problem, false);
    EXPECT_EQ(found.mode, "checkerboard");
    EXPECT_NE(found.text.find("/Checkerboard control = 0.5'"),
              std::string::npos);
    // what is set already is no remedy
    run.problem.bodies[0].checkerboard_control = 0.5;
    run.problem.bodies[0].hourglass_control    = 0.1;
    EXPECT_NE(
      diagnose(seen, run.problem, false).text.find("/Hourglass control = 0.2'"),
      std::string::npos);
  }



  TEST(Diagnosis, NullSpace)
  {
    SampleRun<2>       run(/*projected=*/true);
    const PointView<2> points = run.points().view();
    for (std::size_t p = 0; p < points.size; ++p)
      points.velocity[0][p] =
        std::fmod(points.position[0][p], 0.25) < 0.125 ? 1 : -1;
    const Symptoms seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    EXPECT_GT(seen.unseen_energy, 0.8); // all but at the free ends
    const Diagnosis found = diagnose(seen, run.problem, false);
    EXPECT_EQ(found.mode, "null space");
    EXPECT_NE(found.text.find("Method/Blend time = 0.05'"), std::string::npos)
      << found.text;
    EXPECT_EQ(found.text.find("apic"), std::string::npos);

    // a liquid that its control would have held
    run.problem.bodies[0].is_liquid = true;
    EXPECT_NE(diagnose(seen, run.problem, false)
                .text.find("Body block/Hourglass control = 0.2'"),
              std::string::npos);
    run.problem.bodies[0].hourglass_control = 0.1;
    EXPECT_NE(diagnose(seen, run.problem, false).text.find("Blend time"),
              std::string::npos);
  }



  TEST(Diagnosis, CutCellAndCourantNumber)
  {
    SampleRun<2> run(/*projected=*/true);
    Symptoms     seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    Problem<2> problem     = run.problem;
    seen.courant_number    = 0.4;
    seen.bodies[0].filling = 0.01;
    problem.method.order   = StressUpdateOrder::usl;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "small cut cell");

    // The filter makes the limit stricter, and smooth functions have none; what
    // a step that was set exceeds is said of all.
    problem.method.transfer     = Transfer::fmpm;
    const std::string of_filter = diagnose(seen, problem, true).text;
    EXPECT_NE(of_filter.find("less than 0.32 edges"), std::string::npos)
      << of_filter;
    EXPECT_NE(of_filter.find("Kernel = quadratic"), std::string::npos);
    EXPECT_EQ(of_filter.find("Transfer order"), std::string::npos);
    problem.grid.kernel = KernelKind::gimp;
    seen.courant_number = 0.2;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "");
    seen.courant_number = 0.4;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "Courant number");
    problem.grid.kernel     = KernelKind::linear;
    problem.method.transfer = Transfer::flip;

    problem.method.order = StressUpdateOrder::musl;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "");
    seen.courant_number = 2.5;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "Courant number");
    seen.courant_number            = 0.4;
    seen.bodies[0].smallest_volume = -0.2;
    EXPECT_EQ(diagnose(seen, problem, true).mode, "inverted point");
  }



  // FLIP refuses the entries of the filter.
  TEST(Diagnosis, FlipIsProposedWithWhatItTakes)
  {
    SampleRun<2> run(/*projected=*/true);
    Symptoms     seen = find_symptoms(run.state, 1.);
    if (!speaks())
      return;
    Problem<2> problem            = run.problem;
    problem.method.order          = StressUpdateOrder::usl;
    problem.method.transfer       = Transfer::fmpm;
    problem.method.transfer_order = 8;
    const std::string flip = "'Transfer = flip' and 'Transfer order = 4'";
    for (const double courant_number : {0.4, 0.9}) // small cut cell, and beyond
      {
        seen.courant_number    = courant_number;
        const std::string text = diagnose(seen, problem, true).text;
        EXPECT_NE(text.find(flip), std::string::npos) << text;
      }
    problem.method.transfer_period = 3;
    EXPECT_NE(diagnose(seen, problem, true)
                .text.find(flip + " and 'Transfer period = 1'"),
              std::string::npos);
  }
} // namespace limber::test
