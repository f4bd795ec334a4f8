// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/place_sums.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class Dimension>
  class PlaceSums : public testing::Test
  {
  public:
    static constexpr int         dim      = Dimension::value;
    static constexpr int         lanes    = vector_lanes<dim>;
    static constexpr std::size_t n_nodes  = 40;
    static constexpr std::size_t n_places = 30;

    PlaceSums()
    {
      for (std::size_t p = 0; p < n_places; ++p)
        {
          // none, one, odd and even numbers of them
          for (std::size_t k = p % 7; k > 0; --k)
            shares.all.push_back(
              {static_cast<std::uint32_t>(random.below(n_nodes)), random()});
          shares.begin.push_back(shares.all.size());
          takes_part.push_back(p % 3 != 0);
        }
    }

    /** Vectors, and zero in what is beyond dim. */
    std::vector<double>
    vectors(const std::size_t n)
    {
      std::vector<double> result(n * lanes);
      for (std::size_t k = 0; k < n; ++k)
        for (int d = 0; d < dim; ++d)
          result[k * lanes + d] = random();
      return result;
    }

    Random            random;
    PlaceShares       shares;
    std::vector<char> takes_part;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(PlaceSums, Dimensions);



  double
  dot(const std::vector<double> &a, const std::vector<double> &b)
  {
    double result = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
      result += a[k] * b[k];
    return result;
  }
} // namespace



TYPED_TEST(PlaceSums, AreThoseOfAPlainLoop)
{
  constexpr int       lanes    = TestFixture::lanes;
  const auto          of_nodes = this->vectors(this->n_nodes);
  std::vector<double> expected(this->n_places * lanes),
    found(expected.size(), 7.); // what is there does not matter
  for (std::size_t p = 0; p < this->n_places; ++p)
    if (this->takes_part[p])
      for (std::size_t k = this->shares.begin[p]; k < this->shares.begin[p + 1];
           ++k)
        for (int d = 0; d < lanes; ++d)
          expected[p * lanes + d] +=
            this->shares.all[k].value *
            of_nodes[this->shares.all[k].node * lanes + d];
  sum_at_places<TestFixture::dim>(this->shares,
                                  this->takes_part,
                                  of_nodes.data(),
                                  found.data());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-14)
      << "place " << k / lanes << ", lane " << k % lanes;
}



TYPED_TEST(PlaceSums, NodesGetWhatAPlainLoopGives)
{
  constexpr int lanes    = TestFixture::lanes;
  const auto    given    = this->vectors(this->n_places);
  auto          found    = this->vectors(this->n_nodes);
  auto          expected = found;
  for (std::size_t p = 0; p < this->n_places; ++p)
    if (this->takes_part[p])
      for (std::size_t k = this->shares.begin[p]; k < this->shares.begin[p + 1];
           ++k)
        for (int d = 0; d < lanes; ++d)
          expected[this->shares.all[k].node * lanes + d] +=
            this->shares.all[k].value * given[p * lanes + d];
  give_to_nodes<TestFixture::dim>(this->shares,
                                  this->takes_part,
                                  given.data(),
                                  found.data());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-14)
      << "node " << k / lanes << ", lane " << k % lanes;
}



// So the power of impulses at places is that of what nodes get.
TYPED_TEST(PlaceSums, GivingIsTheTransposeOfSumming)
{
  const auto of_nodes = this->vectors(this->n_nodes),
             given    = this->vectors(this->n_places);
  std::vector<double> sums(given.size()), got(of_nodes.size());
  sum_at_places<TestFixture::dim>(this->shares,
                                  this->takes_part,
                                  of_nodes.data(),
                                  sums.data());
  give_to_nodes<TestFixture::dim>(this->shares,
                                  this->takes_part,
                                  given.data(),
                                  got.data());
  const double power = dot(given, sums);
  EXPECT_GT(std::abs(power), 0.1);
  EXPECT_NEAR(dot(of_nodes, got), power, 1e-13);
}



// As of a place that sees two bodies: shares with the sum 1 of one, -1 of the
// other.
TYPED_TEST(PlaceSums, MomentumIsKept)
{
  constexpr int       lanes  = TestFixture::lanes;
  auto               &shares = this->shares;
  std::vector<double> inverse_mass(this->n_nodes);
  for (double &x : inverse_mass)
    x = this->random(0.1, 10);
  inverse_mass.back() = 0; // a node without mass keeps its velocity
  std::vector<char> all(this->n_places, 1);
  for (std::size_t p = 0; p < this->n_places; ++p)
    {
      double sum = 0;
      for (std::size_t k = shares.begin[p]; k < shares.begin[p + 1]; ++k)
        {
          shares.all[k].node %= this->n_nodes - 1;
          if (k + 1 == shares.begin[p + 1])
            shares.all[k].value = -sum;
          sum += shares.all[k].value;
        }
    }
  const auto          impulses = this->vectors(this->n_places);
  const auto          before   = this->vectors(this->n_nodes);
  auto                velocity = before;
  std::vector<double> given(velocity.size());
  give_to_nodes<TestFixture::dim>(shares, all, impulses.data(), given.data());
  const auto momentum = given;
  take_given<TestFixture::dim>(this->n_nodes,
                               inverse_mass.data(),
                               given.data(),
                               velocity.data());
  std::array<double, lanes> sum{};
  double                    size = 0;
  for (std::size_t i = 0; i < this->n_nodes; ++i)
    for (int d = 0; d < lanes; ++d)
      {
        const std::size_t k = i * lanes + d;
        EXPECT_NEAR(velocity[k],
                    before[k] + inverse_mass[i] * momentum[k],
                    1e-14 * (1 + std::abs(velocity[k])));
        EXPECT_EQ(given[k], 0);
        if (inverse_mass[i] == 0)
          continue;
        sum[d] += (velocity[k] - before[k]) / inverse_mass[i];
        size += std::abs(momentum[k]);
      }
  EXPECT_GT(size, 1);
  for (int d = 0; d < lanes; ++d)
    EXPECT_NEAR(sum[d], 0, 1e-13 * size);
}
