// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/plain_dealii.h>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dim>
  void
  compare(const unsigned int n_cells, const unsigned int n_steps)
  {
    Comparison<dim> both(n_cells);
    ASSERT_EQ(both.difference(), 1e300); // no stress yet
    for (unsigned int k = 0; k < n_steps; ++k)
      {
        both.advance_limber();
        both.advance_plain();
        ASSERT_LT(both.difference(), 1e-11) << "after " << k + 1 << " steps";
      }
    EXPECT_EQ(both.ledger.lost_points, 0u);
  }
} // namespace



TEST(PlainAgreement, StepsAreThoseOfAPlainLoopIn2d)
{
  compare<2>(8, 50);
}



TEST(PlainAgreement, StepsAreThoseOfAPlainLoopIn3d)
{
  compare<3>(4, 30);
}
