// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/cantilever_scene.h>
#include <support/scene_run.h>

#include <map>

/**
 * @file The shear stress of a beam in bending. A Q1 cell of width a that bends
 * with the curvature kappa has the shear stress G kappa (x - x_c), a saw-tooth
 * along the beam. Treatments that average the shear strain do not have it.
 */

using namespace limber;

namespace
{
  constexpr double quarter_period = 3; // s, about



  struct ShearStress
  {
    double saw_tooth; // rms of what differs from the mean of the cell, Pa
    double largest;   // difference in a column of cells away from the root, Pa
    double bending;   // the largest stress along the beam there, Pa
  };



  ShearStress
  shear_stress(const std::string &treatment)
  {
    SceneRun<2> run(cantilever_scene,
                    {"Body beam/Locking treatment=" + treatment,
                     "Body beam/Constants=v0 = 1e-4",
                     "Method/Stress update=musl"});
    run.advance_to(quarter_period);
    const PointView<2> points = run.points();

    std::map<std::uint32_t, std::pair<double, unsigned int>> sums;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        auto &[sum, n] = sums[points.cell[p]];
        sum += points.deviator[2][p];
        ++n;
      }
    ShearStress result{0, 0, 0};
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const auto &[sum, n]    = sums[points.cell[p]];
        const double difference = points.deviator[2][p] - sum / n;
        result.saw_tooth += difference * difference / points.size;
        if (points.position[0][p] < 1 || points.position[0][p] > 1.25)
          continue;
        const double along = points.deviator[0][p] - points.pressure[p];
        result.largest     = std::max(result.largest, std::abs(difference));
        result.bending     = std::max(result.bending, std::abs(along));
      }
    result.saw_tooth = std::sqrt(result.saw_tooth);
    return result;
  }
} // namespace



TEST(ParasiticShear, IsWhatTheCurvatureMakes)
{
  // Bending stress E kappa y / (1 - nu^2) at outermost points, 7/8 of half the
  // depth from the middle; shear stress G kappa a / 4 at points a quarter of
  // the edge from the middle of their cells.
  const double      nu       = 0.3;
  const double      expected = (1 - nu) / 2 * (0.25 / 4) / (0.5 * 7 / 8);
  const ShearStress found    = shear_stress("none");
  EXPECT_NEAR(found.largest / found.bending, expected, 0.03 * expected);
}



TEST(ParasiticShear, IsAThousandTimesSmallerWhereShearIsAveraged)
{
  const double untreated = shear_stress("none").saw_tooth;
  for (const std::string treatment :
       {"cell shear", "cell full", "assumed strain"})
    {
      SCOPED_TRACE(treatment);
      EXPECT_LT(shear_stress(treatment).saw_tooth, 1e-3 * untreated);
    }
  // The volume alone does not help.
  EXPECT_GT(shear_stress("cell").saw_tooth, 0.5 * untreated);
}
