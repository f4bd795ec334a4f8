// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/checks.h>

#include <gtest/gtest.h>

namespace limber::test
{
  TEST(Checks, TakeTheNearestRowOrTheLast)
  {
    Check early, late;
    early.name       = "early";
    early.observable = "b";
    early.at_time    = 0.5;
    early.reference  = 5;
    early.tolerance  = 0;
    late             = early;
    late.name        = "late";
    late.at_time.reset();
    late.reference = 9;
    Checks checks({early, late}, {"a", "b"});
    EXPECT_EQ(checks.times(), std::vector<double>{0.5});
    for (unsigned int i = 0; i < 10; ++i)
      checks.add(0.1 * i, {-1, double(i)});

    const auto results = checks.results();
    ASSERT_EQ(results.size(), 2u);
    EXPECT_TRUE(results[0].passed);
    EXPECT_EQ(results[0].value, 5);
    EXPECT_TRUE(results[1].passed);
    EXPECT_EQ(results[1].value, 9);
  }



  TEST(Checks, FailWhereTheDifferenceIsTooLargeOrNotANumber)
  {
    Check check;
    check.observable = "a";
    check.reference  = 1;
    check.tolerance  = 0.1;
    Checks checks({check}, {"a"});
    EXPECT_FALSE(checks.results()[0].passed); // no row at all
    checks.add(0, {1.2});
    EXPECT_FALSE(checks.results()[0].passed);
    checks.add(1, {1.05});
    EXPECT_TRUE(checks.results()[0].passed);
    EXPECT_EQ(checks.results()[0].text(),
              "check : 1.05, reference 1 +- 0.1, passed");
    checks.add(2, {std::numeric_limits<double>::quiet_NaN()});
    EXPECT_FALSE(checks.results()[0].passed);
    EXPECT_EQ(checks.results()[0].text(),
              "check : no value yet, reference 1 +- 0.1, MISSED");
  }
} // namespace limber::test
