// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Loads on bodies whose points have domains: nodes that get stress from a
 * domain have to get its load as well.
 */

using namespace limber;

namespace
{
  /**
   * A bar under a stress along it (Pa) at the start. Its right end lies
   * a fifth of a cell beyond the last edge of cells that holds points: the
   * domains of these reach over it.
   */
  std::string
  stretched_bar(const std::string &kernel,
                const std::string &stress,
                const std::string &loads)
  {
    return R"(
    set Bodies = bar
    subsection Body bar
      set Placement = fitted
      set Initial stress = xx: )" +
           stress + R"(
      subsection Box
        set Upper corner = 1.02, 0.2
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0
      end
    end
    subsection Grid
      set Upper corner = 1.2, 0.2
      set Cells = 12, 2
    end
    subsection Boundaries
      set right = free
    end
    subsection Method
      set Kernel = )" +
           kernel + "\nend\nsubsection Loads\n" + loads + "\nend\n";
  }



  /** Largest speed of a point after a while, m/s. */
  double
  largest_speed(const std::string &scene)
  {
    SceneRun<2> run(scene);
    run.advance_to(0.02);
    double result = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      result = std::max(result, run.velocity(p).norm());
    return result;
  }

  // What 10 Pa set a free end in motion by, s / (rho c)
  const double speed_of_wave = 3.16e-4;
} // namespace



// Boxes (GIMP) see the end of the body through means over themselves, and the
// balance there is not exact.
TEST(LoadsOnDomains, ATractionHoldsTheStressThatItBrings)
{
  for (const std::string kernel : {"cpdi", "cpdi2"})
    EXPECT_LT(largest_speed(stretched_bar(kernel, "10", R"(
      set Face loads = pull
      subsection Face load pull
        set Body = bar
        set Face = right
        set Traction = 10; 0
      end)")),
              1e-10 * speed_of_wave)
      << kernel;
}



// rho b (L - x) is in balance with a force per mass b; that of the domains to
// the second order in their size.
TEST(LoadsOnDomains, ABodyForceHoldsTheStressThatItBrings)
{
  for (const std::string kernel : {"cpdi", "cpdi2", "gimp", "cpgimp"})
    EXPECT_LT(largest_speed(stretched_bar(kernel,
                                          "10*(1.02 - x)/1.02",
                                          "set Body force = 0.01/1.02; 0")),
              0.02 * speed_of_wave)
      << kernel;
}
