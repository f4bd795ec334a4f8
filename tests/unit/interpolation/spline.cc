// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/batch_lanes.h>
#include <limber/interpolation/spline.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dimension, KernelKind kernel_kind>
  struct Case
  {
    static constexpr int        dim    = dimension;
    static constexpr KernelKind kernel = kernel_kind;
  };



  template <class Case>
  class Splines : public testing::Test
  {
  public:
    static constexpr int dim = Case::dim;
    using Grid               = SmallGrid<dim, Case::kernel>;
    using Basis              = typename Grid::Basis;

    /** Of all nodes of a cell at natural coordinates: N_i, dN_i / dxi_d. */
    struct AtPlace
    {
      std::array<double, Basis::n_nodes>                  value;
      std::array<std::array<double, Basis::n_nodes>, dim> gradient;
    };

    AtPlace
    products(const typename Basis::Cell &cell, const Vector<dim> &xi) const
    {
      AtPlace result;
      for (int i = 0; i < Basis::n_nodes; ++i)
        {
          result.value[i] = 1;
          for (int d = 0; d < dim; ++d)
            result.gradient[d][i] = 1;
          for (int e = 0; e < dim; ++e)
            {
              const auto w = Basis::weights(cell, e, xi[e]);
              const int  k = Basis::power(i, e);
              result.value[i] *= w.value[k];
              for (int d = 0; d < dim; ++d)
                result.gradient[d][i] *= d == e ? w.slope[k] : w.value[k];
            }
        }
      return result;
    }

    Random random;
  };

  using Cases = testing::Types<Case<2, KernelKind::quadratic>,
                               Case<3, KernelKind::quadratic>,
                               Case<2, KernelKind::cubic>,
                               Case<3, KernelKind::cubic>>;
  TYPED_TEST_SUITE(Splines, Cases);
} // namespace



// In the middle of the grid, at its sides, and in a grid of one cell.
TYPED_TEST(Splines, AreBSplinesAlsoAtTheSides)
{
  constexpr int dim = TestFixture::dim;
  for (const int n : {1, 2, 5})
    {
      const typename TestFixture::Grid grid(n);
      for (std::uint32_t c = 0; c < grid.n_cells; ++c)
        {
          Vector<dim> xi, x;
          for (int d = 0; d < dim; ++d)
            {
              xi[d] = this->random(0, 1);
              x[d]  = grid.cells[c].origin[d] + xi[d] * grid.edge[d];
            }
          const auto at = this->products(grid.splines[c], xi);
          for (int i = 0; i < grid.n_in_cell; ++i)
            {
              EXPECT_NEAR(at.value[i], grid.shape(c, i, x), 1e-14);
              EXPECT_GE(at.value[i], 0);
              for (int d = 0; d < dim; ++d)
                EXPECT_NEAR(at.gradient[d][i] / grid.edge[d],
                            grid.gradient(c, i, x)[d],
                            1e-13);
            }
        }
    }
}



TYPED_TEST(Splines, HaveConstantsAndLinearFieldsExactly)
{
  constexpr int dim = TestFixture::dim;
  for (const int n : {1, 2, 5})
    {
      const typename TestFixture::Grid grid(n);
      for (std::uint32_t c = 0; c < grid.n_cells; ++c)
        {
          Vector<dim> xi;
          for (double &x : xi)
            x = this->random(0, 1);
          const auto  at  = this->products(grid.splines[c], xi);
          double      sum = 0;
          Vector<dim> place{}, sum_of_gradients{};
          Matrix<dim> slope{};
          for (int i = 0; i < grid.n_in_cell; ++i)
            {
              sum += at.value[i];
              for (int d = 0; d < dim; ++d)
                {
                  const double x_i = grid.place(grid.node_number(c, i))[d];
                  place[d] += at.value[i] * x_i;
                  sum_of_gradients[d] += at.gradient[d][i];
                  for (int e = 0; e < dim; ++e)
                    slope[d][e] += at.gradient[e][i] / grid.edge[e] * x_i;
                }
            }
          EXPECT_NEAR(sum, 1., 1e-13);
          for (int d = 0; d < dim; ++d)
            {
              EXPECT_NEAR(place[d],
                          grid.cells[c].origin[d] + xi[d] * grid.edge[d],
                          1e-13);
              EXPECT_NEAR(sum_of_gradients[d], 0., 1e-13);
              for (int e = 0; e < dim; ++e)
                EXPECT_NEAR(slope[d][e], d == e ? 1. : 0., 1e-13);
            }
        }
    }
}



// What jumps at the face of a cell makes points creep that cross it.
TYPED_TEST(Splines, HaveNoJumpInTheGradientBetweenCells)
{
  constexpr int              dim = TestFixture::dim;
  typename TestFixture::Grid grid(4);
  for (double &value : grid.nodes)
    value = this->random();
  using Basis  = typename TestFixture::Basis;
  using Layout = NodeLayout<dim>;
  for (std::uint32_t c = 0; c < grid.n_cells; ++c)
    for (int d = 0; d < dim; ++d)
      {
        Vector<dim> x, below, above;
        for (int e = 0; e < dim; ++e)
          {
            above[e] = below[e] = this->random(0, 1);
            x[e]                = grid.cells[c].origin[e] +
                   (below[e] + (e == d ? 1 : 0)) * grid.edge[e];
          }
        x[d]                     = grid.cells[c].origin[d] + 1.5 * grid.edge[d];
        const std::uint32_t next = grid.bins.cell_at(x);
        if (next == invalid_cell)
          continue;
        below[d] = 1;
        above[d] = 0;
        const NodalCoefficients<Basis, Layout::velocity, dim> here(grid.view(),
                                                                   c),
          there(grid.view(), next);
        for (int k = 0; k < dim; ++k)
          {
            const auto one = here.component(k), two = there.component(k);
            EXPECT_NEAR((Basis::template value<double>(one, below)),
                        (Basis::template value<double>(two, above)),
                        1e-14);
            const auto a = Basis::template gradient<double>(one, below);
            const auto b = Basis::template gradient<double>(two, above);
            for (int e = 0; e < dim; ++e)
              EXPECT_NEAR(a[e], b[e], 1e-13);
          }
      }
}



TYPED_TEST(Splines, MonomialsHaveTheValuesOfTheProducts)
{
  constexpr int dim = TestFixture::dim;
  using Basis       = typename TestFixture::Basis;
  for (const int n : {1, 2, 5})
    {
      typename TestFixture::Grid grid(n);
      for (double &value : grid.nodes)
        value = this->random();
      for (std::uint32_t c = 0; c < grid.n_cells; ++c)
        {
          Vector<dim> xi;
          for (double &x : xi)
            x = this->random(0, 1);
          const auto at = this->products(grid.splines[c], xi);
          const NodalCoefficients<Basis, NodeLayout<dim>::increment, 2 * dim>
            nodal(grid.view(), c);
          for (int k = 0; k < 2 * dim; ++k)
            {
              double      value = 0;
              Vector<dim> gradient{};
              for (int i = 0; i < grid.n_in_cell; ++i)
                {
                  const double v = grid.nodes[grid.splines[c].node[i] +
                                              NodeLayout<dim>::increment + k];
                  value += at.value[i] * v;
                  for (int d = 0; d < dim; ++d)
                    gradient[d] += at.gradient[d][i] * v;
                }
              EXPECT_NEAR((Basis::template value<double>(nodal.component(k),
                                                         xi)),
                          value,
                          1e-14);
              const auto found =
                Basis::template gradient<double>(nodal.component(k), xi);
              for (int d = 0; d < dim; ++d)
                EXPECT_NEAR(found[d], gradient[d], 1e-13);
            }
        }
    }
}



// sum_i b_i a_i is the same whether a are nodal values or coefficients.
TYPED_TEST(Splines, ToNodesIsTheTransposeOfToMonomials)
{
  using Basis = typename TestFixture::Basis;
  for (const int n : {1, 2, 5})
    {
      const typename TestFixture::Grid grid(n);
      for (const auto &cell : grid.splines)
        {
          std::array<double, Basis::n_nodes> a, b;
          for (double &value : a)
            value = this->random();
          for (double &value : b)
            value = this->random();
          auto coefficients = a, on_nodes = b;
          Basis::to_monomials(coefficients, cell);
          Basis::to_nodes(on_nodes, cell);
          double one = 0, two = 0;
          for (int i = 0; i < Basis::n_nodes; ++i)
            {
              one += b[i] * coefficients[i];
              two += on_nodes[i] * a[i];
            }
          EXPECT_NEAR(one, two, 1e-13);
        }
    }
}
