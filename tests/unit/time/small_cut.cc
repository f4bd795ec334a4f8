// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file A cantilever in its first mode whose outermost row of points lies by
 * xi h inside the next row of cells. The stress update 'last' then needs
 * Courant numbers below sqrt(2 xi); the other two do not notice.
 */

using namespace limber;

namespace
{
  const std::string cantilever = R"(
    set Bodies = beam
    subsection Body beam
      subsection Box
        set Lower corner = 0, 2
        set Upper corner = 8, 3
      end
      set Constants = L = 8, b = 1.875104068711961, s = 0.734095513758924
      set Initial velocity = 0; 0.005*(cosh(b*x/L) - cos(b*x/L) - s*(sinh(b*x/L) - sin(b*x/L)))
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 9, 5
      set Cells = 36, 20
    end
    subsection Boundaries
      set left = no slip
      set right = free
      set bottom = free
      set top = free
    end)";

  constexpr double cell = 0.25, xi = 1e-4, end_time = 8;



  /** Largest and last deviation of the energy from that at the start. */
  std::pair<double, double>
  energy_errors(const std::string &order, const double courant_number)
  {
    SceneRun<2> run(cantilever,
                    {"Method/Stress update=" + order,
                     "Method/Courant number=" + digits(courant_number)});
    // rows of points at 1/4 and 3/4 of a cell
    run.translate(dealii::Tensor<1, 2>({0., (0.25 + xi) * cell}));

    const double start   = run.totals().all.total_energy();
    double       largest = 0, last = 0;
    run.advance_to(end_time, [&]() {
      if (run.n_done % 10 != 0)
        return;
      last    = std::abs(run.totals().all.total_energy() / start - 1);
      largest = std::max(largest, last);
      if (!(largest < 10))
        throw ComputationError("grown");
    });
    return {largest, last};
  }
} // namespace



TEST(SmallCut, UsfAndMuslKeepTheEnergy)
{
  for (const std::string order : {"first", "last, remapped"})
    {
      const auto e = energy_errors(order, 0.6);
      printf("%s largest %.5f last %.5f\n", order.c_str(), e.first, e.second);
      EXPECT_LT(e.first, 0.002) << order;
    }
}



TEST(SmallCut, UslBlowsUpAboveItsLimit)
{
  EXPECT_THROW(energy_errors("last", 0.6), ComputationError);
  EXPECT_THROW(energy_errors("last", 0.05), ComputationError);
}
