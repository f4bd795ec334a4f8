// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/pack.h>
#include <limber/grid/record_window.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace limber;

namespace
{
  template <class Number>
  class PackOf : public testing::Test
  {
  public:
    static constexpr int width = pack_width<Number>;

    /** 1, -2, 3, -4, ... */
    static Number
    alternating()
    {
      std::vector<double> values(width);
      for (int i = 0; i < width; ++i)
        values[i] = (i % 2 ? -1 : 1) * (i + 1);
      return load<Number>(values.data());
    }
  };

  using Widths = testing::Types<double, Pack<2>, Pack<4>, Pack<8>>;
  TYPED_TEST_SUITE(PackOf, Widths);
} // namespace



TYPED_TEST(PackOf, LoadsAndStoresWhereNothingIsAligned)
{
  constexpr int       width = TestFixture::width;
  std::vector<double> from(width + 1), to(width + 2, 7.);
  for (int i = 0; i <= width; ++i)
    from[i] = i;
  store(load<TypeParam>(from.data() + 1), to.data() + 1);
  for (int i = 0; i < width; ++i)
    EXPECT_EQ(to[i + 1], i + 1.);
  EXPECT_EQ(to.front(), 7.);
  EXPECT_EQ(to.back(), 7.);
}



TYPED_TEST(PackOf, ReductionsAndSelectionsGoLaneByLane)
{
  constexpr int   width = TestFixture::width;
  const TypeParam a     = TestFixture::alternating();
  EXPECT_EQ(sum(a), width == 1 ? 1. : -width / 2.);
  EXPECT_EQ(maximum(a), width == 1 ? 1. : width - 1.);
  EXPECT_EQ(sum(broadcast<TypeParam>(0.25)), 0.25 * width);

  const TypeParam positive = magnitude(a), root = square_root(positive * a * a);
  const TypeParam floor = larger(a, broadcast<TypeParam>(-1.5));
  for (int i = 0; i < width; ++i)
    {
      EXPECT_EQ(lane(positive, i), i + 1.);
      EXPECT_EQ(lane(root, i), std::sqrt((i + 1.) * (i + 1.) * (i + 1.)));
      EXPECT_EQ(lane(floor, i), i % 2 ? -1.5 : i + 1.);
    }
}



TYPED_TEST(PackOf, FirstLanesAreChosen)
{
  constexpr int width = TestFixture::width;
  for (int n = 0; n <= width; ++n)
    {
      const auto      chosen = first_lanes<TypeParam>(n);
      const TypeParam a =
        chosen ? broadcast<TypeParam>(1.) : broadcast<TypeParam>(2.);
      for (int i = 0; i < width; ++i)
        EXPECT_EQ(lane(a, i), i < n ? 1. : 2.);
    }
}



TYPED_TEST(PackOf, InverseCubeRootIsGoodToRoundOff)
{
  double worst = 0;
  for (int k = -60000; k <= 60000; ++k)
    {
      const double    x    = std::pow(10., k * 1e-4);
      const TypeParam root = inverse_cube_root(
        broadcast<TypeParam>(x) * TypeParam(broadcast<TypeParam>(1.)));
      for (int i = 0; i < pack_width<TypeParam>; ++i)
        worst = std::max(worst, std::abs(lane(root, i) * std::cbrt(x) - 1));
    }
  EXPECT_LT(worst, 1e-15);
}



TYPED_TEST(PackOf, LogarithmIsGoodToRoundOffNextToOneToo)
{
  constexpr int n = pack_width<TypeParam>;
  for (int k = -3000; k <= 3000; ++k)
    {
      for (const double x : {std::exp(0.2 * k), 1 + 1e-6 * k})
        {
          const TypeParam found = logarithm(broadcast<TypeParam>(x));
          for (int i = 0; i < n; ++i)
            EXPECT_NEAR(lane(found, i),
                        std::log(x),
                        5e-16 * std::abs(std::log(x)))
              << x;
        }
    }
  for (int i = 0; i < n; ++i)
    EXPECT_EQ(lane(logarithm(broadcast<TypeParam>(1.)), i), 0);
  for (const double x : {-1., 0., std::nan("")})
    for (int i = 0; i < n; ++i)
      EXPECT_TRUE(std::isnan(lane(logarithm(broadcast<TypeParam>(x)), i))) << x;
}



TYPED_TEST(PackOf, LogarithmOfARatioIsGoodToRoundOffOfTheDifference)
{
  constexpr int n = pack_width<TypeParam>;
  for (const double from : {0.3, 1., 1.7})
    for (int k = -9; k <= 120; ++k) // from closer than round-off to far apart
      for (const double sign : {-1., 1.})
        {
          const double difference = sign * from * std::pow(10., -0.1 * k - 0.5);
          const double to         = from + difference;
          if (to <= 0)
            continue;
          const TypeParam found =
            logarithm_of_ratio(broadcast<TypeParam>(to),
                               broadcast<TypeParam>(from));
          const double exact = std::log1p((to - from) / from);
          // farther apart the ratio itself is rounded
          const double rounded = std::abs(exact) > 0.02 ? 2.3e-16 : 0;
          for (int i = 0; i < n; ++i)
            EXPECT_NEAR(lane(found, i),
                        exact,
                        1e-15 * std::abs(exact) + rounded)
              << to << " over " << from;
        }
}



TYPED_TEST(PackOf, InverseCubeRootOfOneIsOne)
{
  const TypeParam one = inverse_cube_root(broadcast<TypeParam>(1.));
  for (int i = 0; i < pack_width<TypeParam>; ++i)
    EXPECT_NEAR(lane(one, i), 1., 2e-16);
}



TYPED_TEST(PackOf, IntegersAreWhatIsBeforeThePoint)
{
  constexpr int       width = TestFixture::width;
  std::vector<double> values(width);
  for (int i = 0; i < width; ++i)
    values[i] = 1000 * i + 0.999 * (i % 2);
  const auto a = load<TypeParam>(values.data());
  for (int i = 0; i < width; ++i)
    EXPECT_EQ(lane(rounded_down(a), i), 1000 * i);
}



// In groups as large as a pack is wide, and one that is not full.
TEST(Packs, AreSummedUpTogether)
{
  constexpr int                          width = 4;
  std::array<Pack<width>, 2 * width + 3> packs;
  for (std::size_t n = 0; n < packs.size(); ++n)
    for (int i = 0; i < width; ++i)
      packs[n][i] = 10. * n + i;
  const auto sums = all_sums(packs);
  for (std::size_t n = 0; n < packs.size(); ++n)
    EXPECT_EQ(sums[n], 40. * n + 6);
}



TEST(Packs, TakeTheirLanesTwice)
{
  const Pack<4> a = {1, 2, 3, 4};
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(doubled(a)[i], 1 + i % 4);
}



namespace
{
  /** From slots to records, with @p width points. */
  template <int width, int n_slots>
  void
  expect_records()
  {
    using Number = Pack<width>;
    std::array<Number, n_slots> slots;
    for (int s = 0; s < n_slots; ++s)
      for (int p = 0; p < width; ++p)
        slots[s][p] = 10. * s + p;
    using Record = std::conditional_t<n_slots == 8, SplitPack, Pack<n_slots>>;
    const auto records = records_of<Record>(slots);
    for (int p = 0; p < width; ++p)
      for (int s = 0; s < n_slots; ++s)
        EXPECT_EQ(records[p][s], 10. * s + p);
  }
} // namespace



TEST(Packs, OfSlotsBecomeRecordsOfPoints)
{
  expect_records<4, 2>();
  expect_records<4, 4>();
  expect_records<4, 8>();
  expect_records<8, 4>();
  expect_records<8, 8>();
}
