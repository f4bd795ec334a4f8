// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/linear.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class Dimension>
  class LinearFunctions : public testing::Test
  {
  public:
    static constexpr int dim     = Dimension::value;
    static constexpr int n_nodes = 1 << dim;
    using Kernel                 = Linear<dim>;

    /** N_i at natural coordinates, as the textbook has it. */
    static double
    shape(const int i, const Vector<dim> &xi)
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result *= (i >> d & 1) ? xi[d] : 1 - xi[d];
      return result;
    }

    Vector<dim>
    place()
    {
      Vector<dim> xi;
      for (double &x : xi)
        x = random(0, 1);
      return xi;
    }

    Random random;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(LinearFunctions, Dimensions);
} // namespace



TYPED_TEST(LinearFunctions, WeightsAreTheShapeFunctionsAndSumToOne)
{
  constexpr int dim = TestFixture::dim;
  using Kernel      = Linear<dim>;
  for (int k = 0; k < 100; ++k)
    {
      const auto xi = this->place();
      auto       w  = Kernel::weights(0, xi[0]);
      for (int d = 1; d < dim; ++d)
        w *= Kernel::weights(d, xi[d]);
      for (int i = 0; i < Kernel::n_nodes; ++i)
        EXPECT_NEAR(w[i], this->shape(i, xi), 1e-16);
      EXPECT_NEAR(sum(w), 1., 1e-15);
    }
}



TYPED_TEST(LinearFunctions, SignsTellTheEnds)
{
  constexpr int dim = TestFixture::dim;
  for (int d = 0; d < dim; ++d)
    for (int i = 0; i < 1 << dim; ++i)
      EXPECT_EQ(Linear<dim>::sign(d)[i], (i >> d) % 2 ? 1. : -1.);
}



TYPED_TEST(LinearFunctions, AcrossExchangesTheEndsOfEdges)
{
  constexpr int dim = TestFixture::dim;
  using Kernel      = Linear<dim>;
  typename Kernel::Nodes a;
  for (int i = 0; i < Kernel::n_nodes; ++i)
    a[i] = i;
  for (int d = 0; d < dim; ++d)
    {
      const auto b = Kernel::across(a, d);
      const auto c = Kernel::across(b, d);
      for (int i = 0; i < Kernel::n_nodes; ++i)
        {
          EXPECT_EQ(b[i], i ^ (1 << d));
          EXPECT_EQ(c[i], i);
        }
    }
}



TYPED_TEST(LinearFunctions, MonomialsGiveValuesAndGradients)
{
  constexpr int dim = TestFixture::dim;
  using Kernel      = Linear<dim>;
  for (int k = 0; k < 100; ++k)
    {
      std::array<double, Kernel::n_nodes> nodal, a;
      for (double &value : nodal)
        value = this->random();
      a = nodal;
      Kernel::to_monomials(a);
      const auto coefficient = [&](const int i) { return a[i]; };

      const auto xi       = this->place();
      double     expected = 0;
      for (int i = 0; i < Kernel::n_nodes; ++i)
        expected += nodal[i] * this->shape(i, xi);
      EXPECT_NEAR(Kernel::template value<double>(coefficient, xi),
                  expected,
                  1e-14);

      const auto gradient = Kernel::template gradient<double>(coefficient, xi);
      for (int d = 0; d < dim; ++d)
        {
          // linear along each coordinate: the difference of the ends
          auto lower = xi, upper = xi;
          lower[d]          = 0;
          upper[d]          = 1;
          double difference = 0;
          for (int i = 0; i < Kernel::n_nodes; ++i)
            difference +=
              nodal[i] * (this->shape(i, upper) - this->shape(i, lower));
          EXPECT_NEAR(gradient[d], difference, 1e-14);
        }
    }
}



TYPED_TEST(LinearFunctions, LinearFieldsHaveConstantGradients)
{
  constexpr int dim = TestFixture::dim;
  using Kernel      = Linear<dim>;
  const auto slope  = this->random.template vector<dim>();

  std::array<double, Kernel::n_nodes> a;
  for (int i = 0; i < Kernel::n_nodes; ++i)
    {
      a[i] = 0.7;
      for (int d = 0; d < dim; ++d)
        a[i] += slope[d] * (i >> d & 1);
    }
  Kernel::to_monomials(a);
  const auto coefficient = [&](const int i) { return a[i]; };
  for (int k = 0; k < 20; ++k)
    {
      const auto gradient =
        Kernel::template gradient<double>(coefficient, this->place());
      for (int d = 0; d < dim; ++d)
        EXPECT_NEAR(gradient[d], slope[d], 1e-15);
    }
}



TYPED_TEST(LinearFunctions, FormsOnCoefficientsBecomeFormsOnNodes)
{
  constexpr int dim = TestFixture::dim;
  using Kernel      = Linear<dim>;
  std::array<double, Kernel::n_nodes> values, on_coefficients;
  for (int i = 0; i < Kernel::n_nodes; ++i)
    {
      values[i]          = this->random();
      on_coefficients[i] = this->random();
    }
  const auto on_nodes =
    Kernel::to_nodes(load<typename Kernel::Nodes>(on_coefficients.data()));
  double expected = 0, computed = 0;
  for (int i = 0; i < Kernel::n_nodes; ++i)
    computed += on_nodes[i] * values[i];
  Kernel::to_monomials(values);
  for (int i = 0; i < Kernel::n_nodes; ++i)
    expected += on_coefficients[i] * values[i];
  EXPECT_NEAR(computed, expected, 1e-14);
}



TYPED_TEST(LinearFunctions, CoefficientsAreThoseOfTheSlotsAskedFor)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = NodeLayout<dim>;
  SmallGrid<dim> grid(2);
  for (double &value : grid.nodes)
    value = this->random();

  const std::uint32_t number = grid.n_cells - 1;
  const auto         &cell   = grid.cells[number];
  const auto check = [&](const auto &nodal, const unsigned int slot, int c) {
    std::array<double, 1 << dim> a;
    for (int i = 0; i < 1 << dim; ++i)
      a[i] = grid.nodes[cell.node[i] + slot];
    Linear<dim>::to_monomials(a);
    for (int k = 0; k < 1 << dim; ++k)
      EXPECT_EQ(nodal.component(c)(k), a[k]);
  };
  using Kernel = Linear<dim>;
  const NodalCoefficients<Kernel, Layout::velocity, 2 * dim>  late(grid.view(),
                                                                  number);
  const NodalCoefficients<Kernel, Layout::increment, 2 * dim> early(grid.view(),
                                                                    number);
  const NodalCoefficients<Kernel, Layout::remapped, dim>      last(grid.view(),
                                                              number);
  for (int c = 0; c < 2 * dim; ++c)
    {
      check(late, Layout::velocity + c, c);
      check(early, Layout::increment + c, c);
    }
  for (int c = 0; c < dim; ++c)
    check(last, Layout::remapped + c, c);
}



TYPED_TEST(LinearFunctions, LanesBeyondABatchKeepWhatIsStored)
{
  constexpr int dim   = TestFixture::dim;
  constexpr int width = 1 << dim;
  for (std::size_t n = 1; n <= 2 * width; ++n)
    {
      std::vector<double> array(3 * width);
      for (std::size_t p = 0; p < array.size(); ++p)
        array[p] = p;
      const CellBatch batch{0, 2, 2 + n};
      double          total = 0;
      for_each_pack<dim>(batch, [&](const auto &lanes) {
        total += sum(lanes.only_active(broadcast<PointPack<dim>>(1.)));
        lanes.store(lanes.load(array.data()) + 100., array.data());
      });
      EXPECT_EQ(total, n);
      for (std::size_t p = 0; p < array.size(); ++p)
        EXPECT_EQ(array[p], p + (p >= 2 && p < 2 + n ? 100. : 0.));
    }
}
