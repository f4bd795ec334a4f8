// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/functions.h>

#include <gtest/gtest.h>

using dealii::Point;
using limber::Formula;
using limber::InputError;

namespace
{
  std::string
  formula_error(const std::string       &expression,
                const unsigned int       n_components,
                const limber::Constants &constants = {})
  {
    try
      {
        Formula<2>(expression, constants, n_components, "entry 'Here'");
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace



TEST(Formula, ValuesFollowPlaceTimeAndConstants)
{
  const Formula<3> formula("a*x + y^2; if(z > 1, 2, 3); sin(pi*t)",
                           {{"a", 10.}},
                           3,
                           "here");
  const Point<3>   point(1, 2, 3);
  EXPECT_DOUBLE_EQ(formula.value(point, 0.), 14.);
  EXPECT_DOUBLE_EQ(formula.value(point, 0., 1), 2.);
  EXPECT_DOUBLE_EQ(formula.value(point, 0.5, 2), 1.);

  const auto vector = formula.vector(point, 1.5);
  EXPECT_DOUBLE_EQ(vector[0], 14.);
  EXPECT_DOUBLE_EQ(vector[2], -1.);
}



TEST(Formula, OfNothingIsEmptyAndZero)
{
  const Formula<2> formula;
  EXPECT_TRUE(formula.empty());
  EXPECT_TRUE(formula.is_zero());
  EXPECT_EQ(formula.n_components(), 0u);
}



TEST(Formula, IsZeroOnlyWhereLiterallyZero)
{
  EXPECT_TRUE(Formula<2>("0; 0.0", {}, 2, "").is_zero());
  EXPECT_FALSE(Formula<2>("0; x - x", {}, 2, "").is_zero());
  EXPECT_FALSE(Formula<2>("0; 0; 1", {}, 3, "").is_zero());
  EXPECT_FALSE(Formula<2>("0", {}, 1, "").empty());
}



TEST(Formula, CopiesAreUsableByThemselves)
{
  Formula<2> copy;
  {
    const Formula<2> original("x + t", {}, 1, "");
    copy = original;
  }
  EXPECT_DOUBLE_EQ(copy.value(Point<2>(2, 0), 3.), 5.);
  EXPECT_EQ(copy.expression(), "x + t");
}



TEST(Formula, TellsWhereItIsNotFinite)
{
  const Formula<2> formula("1/x", {}, 1, "");
  EXPECT_TRUE(formula.is_finite(Point<2>(1, 0), 0.));
  EXPECT_FALSE(formula.is_finite(Point<2>(0, 0), 0.));
}



TEST(Formula, ErrorsNameTheEntryAndTheReason)
{
  const std::string unknown = formula_error("sine(x)", 1);
  EXPECT_NE(unknown.find("sine(x)"), std::string::npos);
  EXPECT_NE(unknown.find("entry 'Here'"), std::string::npos);
  EXPECT_NE(unknown.find("Unexpected token"), std::string::npos) << unknown;

  EXPECT_NE(formula_error("(x", 1).find("Missing parenthesis"),
            std::string::npos);
  EXPECT_NE(formula_error("1, 2", 2).find("1 component"), std::string::npos);
  EXPECT_NE(formula_error("1; ", 2).find("empty component"), std::string::npos);
  EXPECT_NE(formula_error("x", 1, {{"t", 1.}}).find("constant 't'"),
            std::string::npos);
}
