// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/study/inf_sup.h>

#include <gtest/gtest.h>

using namespace limber;

/** @file The inf-sup test against values computed independently of this code.
 */

namespace
{
  struct Known
  {
    unsigned int cells;
    double       cell, node;
  };

  const std::vector<Known> known = {{4, 0.3676, 0.1920},
                                    {8, 0.2159, 0.1101},
                                    {12, 0.1502, 0.0747}};
} // namespace



TEST(InfSup, KnownValuesAndModes)
{
  for (const Known &k : known)
    {
      const InfSup cell = inf_sup({k.cells, PressureSpace::cell, 0, 1, 1});
      EXPECT_NEAR(cell.beta, k.cell, 1e-4);
      EXPECT_EQ(cell.zero_modes, 2u); // constant and checkerboard
      const InfSup node = inf_sup({k.cells, PressureSpace::node, 0, 1, 1});
      EXPECT_NEAR(node.beta, k.node, 1e-4);
      EXPECT_EQ(node.zero_modes, 8u);
    }
}



TEST(InfSup, PointsOfFullCellsConvergeToGauss)
{
  const double exact  = inf_sup({6, PressureSpace::cell, 0, 1, 1}).beta;
  const double coarse = inf_sup({6, PressureSpace::cell, 3, 1, 1}).beta;
  const double fine   = inf_sup({6, PressureSpace::cell, 12, 1, 1}).beta;
  EXPECT_NEAR(fine, exact, 1e-2 * exact);
  EXPECT_LT(std::abs(fine - exact), std::abs(coarse - exact) / 8);
}



// The constant and the checkerboard are no longer exact modes, but weak ones.
TEST(InfSup, RandomFillMakesZeroModesWeakModes)
{
  const InfSup some = inf_sup({8, PressureSpace::cell, 3, 0.5, 7});
  EXPECT_EQ(some.zero_modes, 0u);
  EXPECT_GT(some.beta, 0);
  EXPECT_LT(some.beta, 0.5 * inf_sup({8, PressureSpace::cell, 3, 1, 1}).beta);
  // the same filling again
  EXPECT_EQ(some.beta, inf_sup({8, PressureSpace::cell, 3, 0.5, 7}).beta);
}
