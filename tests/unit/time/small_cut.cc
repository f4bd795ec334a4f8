// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/cantilever_scene.h>
#include <support/scene_run.h>

/**
 * @file A cantilever in its first mode whose outermost row of points lies by
 * xi h inside the next row of cells. The stress update 'usl' then needs
 * Courant numbers below sqrt(2 xi); the other two do not notice.
 */

using namespace limber;

namespace
{
  constexpr double cell = 0.25, xi = 1e-4;



  /** The largest change of kinetic and strain energy, over their sum. */
  double
  largest_energy_error(const std::string &order,
                       const double       courant_number,
                       const double       end_time)
  {
    SceneRun<2> run(cantilever_scene,
                    {"Body beam/Locking treatment=none",
                     "Method/Stress update=" + order,
                     "Method/Courant number=" + digits(courant_number)});
    // rows of points at 1/4 and 3/4 of a cell
    run.translate(dealii::Tensor<1, 2>({0., (0.25 + xi) * cell}));

    const double start  = run.totals().all.total_energy();
    double       result = 0;
    run.advance_to(end_time, [&]() {
      result =
        std::max(result, std::abs(run.totals().all.total_energy() / start - 1));
      if (!(result < 10))
        throw ComputationError("The energy has grown tenfold.");
    });
    return result;
  }
} // namespace



// The clamped wall takes some 0.02 % per second with the velocity that points
// next to it have against it, in addition to the swing of symplectic Euler.
TEST(SmallCut, UsfAndMuslKeepTheEnergy)
{
  for (const std::string order : {"usf", "musl", "usavg"})
    EXPECT_LT(largest_energy_error(order, 0.6, 3), 0.002) << order;
}



TEST(SmallCut, UslBlowsUpAboveItsLimit)
{
  for (const double courant_number : {0.6, 0.05})
    EXPECT_THROW(largest_energy_error("usl", courant_number, 8),
                 ComputationError);
}
