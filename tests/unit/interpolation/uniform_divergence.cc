// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/uniform_divergence.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <algorithm>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  /** A velocity of random corner values in a cell with unlike edges, of which
   * material lies at places with this mean. */
  template <class Dimension>
  class UniformDivergence : public testing::Test
  {
  public:
    static constexpr int dim     = Dimension::value;
    static constexpr int n_nodes = 1 << dim;
    using Number                 = PointPack<dim>;
    using Place                  = std::array<double, dim>;

    UniformDivergence()
    {
      for (int d = 0; d < dim; ++d)
        {
          cell.inverse_edge[d] = random(0.5, 2);
          for (double &c : coefficients[d])
            c = random(-1, 1);
        }
    }

    /** Component d of the velocity that points follow. */
    double
    followed(const Place &xi, const int d, const Place &mean) const
    {
      std::array<Number, dim> places;
      for (int e = 0; e < dim; ++e)
        places[e] = broadcast<Number>(xi[e]);
      std::array<double, n_nodes> means;
      for (int k = 0; k < n_nodes; ++k)
        means[k] = monomial(k, mean);
      const auto component = [this](const int e) {
        return [this, e](const int k) { return coefficients[e][k]; };
      };
      const auto beyond =
        beyond_uniform_divergence<dim, Number>(component, cell, means, places);
      return corner_value(xi, d) - beyond[d][0];
    }

    double
    corner_value(const Place &xi, const int d) const
    {
      double result = 0;
      for (int k = 0; k < n_nodes; ++k)
        result += coefficients[d][k] * monomial(k, xi);
      return result;
    }

    /** By central differences, which are exact for squares. */
    template <class Velocity>
    double
    divergence(const Velocity &velocity, const Place &xi) const
    {
      double result = 0;
      for (int d = 0; d < dim; ++d)
        {
          Place before = xi, behind = xi;
          before[d] -= 0.01;
          behind[d] += 0.01;
          result += (velocity(behind, d) - velocity(before, d)) / 0.02 *
                    cell.inverse_edge[d];
        }
      return result;
    }

    Place
    place()
    {
      Place result;
      for (double &x : result)
        x = random(0, 1);
      return result;
    }

    /** Within what lies around a mean, away from its ends. */
    Place
    place_around(const Place &mean)
    {
      Place result = place();
      for (int d = 0; d < dim; ++d)
        {
          const double half = std::min(mean[d], 1 - mean[d]);
          result[d]         = mean[d] + (2 * result[d] - 1) * (half - 0.01);
        }
      return result;
    }

    void
    expect_uniform(const Place &mean)
    {
      const double expected =
        divergence([&](const Place &xi,
                       const int    d) { return corner_value(xi, d); },
                   mean);
      for (int k = 0; k < 20; ++k)
        {
          const Place xi = place_around(mean);
          EXPECT_NEAR(
            divergence([&](const Place &x,
                           const int    d) { return followed(x, d, mean); },
                       xi),
            expected,
            1e-12);
        }
    }

    Random                                       random;
    CellGeometry<dim>                            cell{};
    std::array<std::array<double, n_nodes>, dim> coefficients;

  private:
    static double
    monomial(const int k, const Place &xi)
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        if (k >> d & 1)
          result *= xi[d];
      return result;
    }
  };

  using BothDimensions = testing::Types<std::integral_constant<int, 2>,
                                        std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(UniformDivergence, BothDimensions);
} // namespace



TYPED_TEST(UniformDivergence, IsThatOfTheMeanPlace)
{
  typename TestFixture::Place middle;
  middle.fill(0.5);
  this->expect_uniform(middle);
  for (int k = 0; k < 5; ++k)
    {
      auto mean = this->place();
      for (double &m : mean)
        m = 0.1 + 0.8 * m;
      this->expect_uniform(mean);
    }
}



// What leaves a cell enters the next one, and nothing goes through a side,
// wherever in the cell the material lies.
TYPED_TEST(UniformDivergence, KeepsWhatGoesThroughFaces)
{
  typename TestFixture::Place middle;
  middle.fill(0.5);
  for (const auto &mean : {middle, this->place(), this->place()})
    for (int d = 0; d < TestFixture::dim; ++d)
      for (const double end : {0., 1.})
        {
          auto xi = this->place();
          xi[d]   = end;
          EXPECT_NEAR(this->followed(xi, d, mean),
                      this->corner_value(xi, d),
                      1e-15);
        }
}
