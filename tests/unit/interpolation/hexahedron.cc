// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_motion.h>
#include <limber/transfer/convected_transfer.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <class Case>
  class Hexahedra : public testing::Test
  {
  public:
    static constexpr int dim = Case::value;
    using Shape              = Hexahedron<dim, double>;
    using Layout             = NodeLayout<dim>;

    /** Not far from a square or cube. */
    Shape
    random_shape(const double twist)
    {
      Shape shape;
      for (int d = 0; d < dim; ++d)
        {
          for (int k = 0; k < dim; ++k)
            shape.edges[d][k] = (d == k) + 0.2 * random();
          for (int t = 0; t < Shape::n_twists; ++t)
            shape.twists[t][d] = twist * random();
        }
      return shape;
    }

    /** M_c and its derivatives at natural coordinates. */
    static double
    interpolation(const int c, const int k, const Vector<dim> &xi)
    {
      double result = 1;
      for (int d = 0; d < dim; ++d)
        result *= d == k ? 0.5 * Shape::sign(c, d) :
                           0.5 * (1 + Shape::sign(c, d) * xi[d]);
      return result;
    }

    Random random;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(Hexahedra, Dimensions);
} // namespace



// From the corners alone, with five Gauss points along each direction.
TYPED_TEST(Hexahedra, HaveTheIntegralsOfTheirMap)
{
  constexpr int dim      = TestFixture::dim;
  using Shape            = typename TestFixture::Shape;
  const double a         = std::sqrt(5 - 2 * std::sqrt(10. / 7)) / 3;
  const double b         = std::sqrt(5 + 2 * std::sqrt(10. / 7)) / 3;
  const double places[]  = {-b, -a, 0, a, b};
  const double near_zero = (322 + 13 * std::sqrt(70.)) / 900;
  const double far       = (322 - 13 * std::sqrt(70.)) / 900;
  const double weights[] = {far, near_zero, 128. / 225, near_zero, far};
  for (int repetition = 0; repetition < 20; ++repetition)
    {
      Shape shape = this->random_shape(0.15);
      shape.integrate();
      const auto                               &corners = shape.offsets;
      double                                    volume  = 0;
      Vector<dim>                               centroid{};
      std::array<double, Shape::n_corners>      shares{};
      std::array<Vector<dim>, Shape::n_corners> slopes{};
      for (int q = 0; q < (dim == 2 ? 25 : 125); ++q)
        {
          Vector<dim> xi;
          double      weight = 1;
          for (int d = 0, rest = q; d < dim; ++d, rest /= 5)
            {
              xi[d] = places[rest % 5];
              weight *= weights[rest % 5];
            }
          SmallMatrix<dim, double> map{};
          Vector<dim>              x{};
          for (int c = 0; c < Shape::n_corners; ++c)
            for (int d = 0; d < dim; ++d)
              {
                x[d] += this->interpolation(c, -1, xi) * corners[c][d];
                for (int k = 0; k < dim; ++k)
                  map[d][k] += this->interpolation(c, k, xi) * corners[c][d];
              }
          const double J   = determinant<dim>(map);
          const auto   cof = cofactor<dim>(map);
          volume += weight * J;
          for (int d = 0; d < dim; ++d)
            centroid[d] += weight * J * x[d];
          for (int c = 0; c < Shape::n_corners; ++c)
            {
              shares[c] += weight * J * this->interpolation(c, -1, xi);
              for (int d = 0; d < dim; ++d)
                for (int k = 0; k < dim; ++k)
                  slopes[c][d] +=
                    weight * cof[d][k] * this->interpolation(c, k, xi);
            }
        }
      EXPECT_NEAR(shape.volume, volume, 1e-13);
      double sum = 0;
      for (int d = 0; d < dim; ++d)
        EXPECT_NEAR(centroid[d], 0, 1e-13);
      for (int c = 0; c < Shape::n_corners; ++c)
        {
          sum += shape.shares[c];
          EXPECT_NEAR(shape.shares[c], shares[c] / volume, 1e-14);
          EXPECT_GT(shape.shares[c], 0);
          for (int k = 0; k < dim; ++k)
            {
              double along = 0;
              for (int d = 0; d < dim; ++d)
                along += slopes[c][d] / volume * shape.edges[d][k];
              EXPECT_NEAR(shape.along[k][c], along, 1e-14);
            }
        }
      EXPECT_NEAR(sum, 1, 1e-14);
    }
}



// Sadeghirad, Brannon and Guilkey 2013, with corners counted around.
TEST(Hexahedra2D, HaveTheClosedFormulasOfThePaper)
{
  using Shape = Hexahedron<2, double>;
  Random random;
  for (int repetition = 0; repetition < 20; ++repetition)
    {
      Shape shape;
      shape.edges  = {{{{1, 0.3 * random()}}, {{0.3 * random(), 0.7}}}};
      shape.twists = {{{{0.2 * random(), 0.2 * random()}}}};
      shape.integrate();
      const int around[] = {0, 1, 3, 2};
      double    x[5], y[5];
      for (int c = 0; c < 4; ++c)
        {
          x[c + 1] = shape.offsets[around[c]][0];
          y[c + 1] = shape.offsets[around[c]][1];
        }
      const double V =
        0.5 * ((x[3] - x[1]) * (y[4] - y[2]) - (x[4] - x[2]) * (y[3] - y[1]));
      const double a =
        (x[4] - x[1]) * (y[2] - y[3]) - (x[2] - x[3]) * (y[4] - y[1]);
      const double b =
        (x[3] - x[4]) * (y[1] - y[2]) - (x[1] - x[2]) * (y[3] - y[4]);
      const double shares[]    = {6 * V - a - b,
                                  6 * V - a + b,
                                  6 * V + a + b,
                                  6 * V + a - b};
      const double slopes[][2] = {{y[2] - y[4], x[4] - x[2]},
                                  {y[3] - y[1], x[1] - x[3]},
                                  {y[4] - y[2], x[2] - x[4]},
                                  {y[1] - y[3], x[3] - x[1]}};
      EXPECT_NEAR(shape.volume, V, 1e-14);
      for (int c = 0; c < 4; ++c)
        {
          EXPECT_NEAR(shape.shares[around[c]], shares[c] / (24 * V), 1e-14);
          for (int k = 0; k < 2; ++k)
            EXPECT_NEAR(shape.along[k][around[c]],
                        (slopes[c][0] * shape.edges[0][k] +
                         slopes[c][1] * shape.edges[1][k]) /
                          (2 * V),
                        1e-14);
        }
    }
}



TYPED_TEST(Hexahedra, AreMadeOfTheirCorners)
{
  using Shape      = typename TestFixture::Shape;
  Shape      shape = this->random_shape(0.1);
  const auto x0    = shape.integrate();
  Shape      same;
  const auto middle = same.set_corners(shape.offsets);
  for (int d = 0; d < TestFixture::dim; ++d)
    {
      EXPECT_NEAR(middle[d], -x0[d], 1e-15);
      for (int k = 0; k < TestFixture::dim; ++k)
        EXPECT_NEAR(same.edges[d][k], shape.edges[d][k], 1e-15);
      for (int t = 0; t < Shape::n_twists; ++t)
        EXPECT_NEAR(same.twists[t][d], shape.twists[t][d], 1e-15);
    }
}



// Two neighbours side by side: whatever the motion of the grid, what they share
// moves with it, and they go on sharing it; each stays the centroid of its
// domain, and the volume grows by the divergence that strains it.
TYPED_TEST(Hexahedra, LeaveNoGaps)
{
  constexpr int dim     = TestFixture::dim;
  using Shape           = typename TestFixture::Shape;
  using Layout          = typename TestFixture::Layout;
  constexpr double step = 1e-2;
  SmallGrid<dim>   grid;
  for (double &value : grid.nodes)
    value = this->random();
  auto own = random_points<dim>(grid, this->random, true, 0, -1, false);
  ASSERT_GE(own.view().size, 2u);
  std::vector<std::vector<double>> domains(
    n_domain_components(DomainForm::hexahedron, dim),
    std::vector<double>(own.view().size + 8, 0.));
  PointView<dim> points = own.view();
  points.domain_form    = DomainForm::hexahedron;
  for (std::size_t k = 0; k < domains.size(); ++k)
    points.domain[k] = domains[k].data();
  // corners of the first, and of its neighbour at larger x
  Vector<dim> centre;
  for (int d = 0; d < dim; ++d)
    centre[d] = grid.lower[d] + 1.4 * grid.edge[d];
  std::array<std::array<double, dim>, Shape::n_corners> corners[2];
  for (int c = 0; c < Shape::n_corners; ++c)
    for (int d = 0; d < dim; ++d)
      for (int q = 0; q < 2; ++q)
        {
          const double share =
            d == 0 && q == 1 ? 1 + Shape::sign(c, 0) : Shape::sign(c, d);
          corners[q][c][d] =
            centre[d] +
            grid.edge[d] * (0.25 * (share + (d == 0 && q == 1 ? 1 : 0)) +
                            0.05 * this->random());
        }
  for (int c = 0; c < Shape::n_corners; c += 2)
    corners[1][c] = corners[0][c + 1];
  double divergence[2], volume[2];
  for (int q = 0; q < 2; ++q)
    {
      Shape      shape;
      auto       place       = shape.set_corners(corners[q]);
      const auto from_middle = shape.integrate();
      volume[q]              = shape.volume;
      for (int d = 0; d < dim; ++d)
        {
          points.position[d][q] = place[d] + from_middle[d];
          for (int k = 0; k < dim; ++k)
            domains[d * dim + k][q] = shape.edges[d][k];
          for (int t = 0; t < Shape::n_twists; ++t)
            domains[dim * (dim + t) + d][q] = shape.twists[t][d];
        }
      const auto at  = own.position(q);
      points.cell[q] = grid.bins.nearest_cell(at);
      const ConvectedDomain<dim> domain(points, grid.view(), points.cell[q], q);
      ASSERT_TRUE(domain.is_hexahedron && domain.is_whole);
      for (int c = 0; c < Shape::n_corners; ++c)
        for (int d = 0; d < dim; ++d)
          ASSERT_NEAR(domain.corner(c)[d], corners[q][c][d], 1e-14);
      const FieldsOnDomain<dim, RecordWindow<dim, Layout::velocity, dim>>
        fields(domain, grid.view());
      divergence[q] = 0;
      for (int d = 0; d < dim; ++d)
        divergence[q] +=
          fields.slope(domain.inverse(), Layout::velocity + d, d);
    }
  const auto velocity = [&](const Vector<dim> &x) {
    Vector<dim>         v{};
    const std::uint32_t cell = grid.bins.nearest_cell(x);
    for (int i = 0; i < 1 << dim; ++i)
      for (int d = 0; d < dim; ++d)
        v[d] += grid.shape(cell, i, x) *
                grid.nodes[grid.node_number(cell, i) * Layout::stride +
                           Layout::velocity + d];
    return v;
  };
  for (int q = 0; q < 2; ++q)
    {
      const auto shift = carry_corners<dim>(
        points, grid.view(), points.cell[q], q, step * grid.edge[0]);
      for (int d = 0; d < dim; ++d)
        points.position[d][q] += shift[d];
      const DomainShape<dim> domain(points, grid.view(), points.cell[q], q);
      ASSERT_TRUE(domain.is_hexahedron && domain.is_whole);
      std::array<std::array<double, dim>, Shape::n_corners> now;
      for (int c = 0; c < Shape::n_corners; ++c)
        {
          now[c]       = domain.corner(c);
          const auto v = velocity(corners[q][c]);
          for (int d = 0; d < dim; ++d)
            ASSERT_NEAR(now[c][d],
                        corners[q][c][d] + step * grid.edge[0] * v[d],
                        1e-14);
        }
      Shape shape;
      shape.set_corners(now);
      shape.integrate();
      // to first order in the step
      EXPECT_NEAR(shape.volume / volume[q] - 1,
                  step * grid.edge[0] * divergence[q],
                  200 * step * step);
      EXPECT_GT(std::abs(step * grid.edge[0] * divergence[q]), 1e-4);
    }
}



// One that is inside out at a corner, but not at its Gauss points, gives no
// node a negative mass; one that is so there counts as a parallelepiped.
TYPED_TEST(Hexahedra, GiveNoNegativeMassWhereTwisted)
{
  constexpr int dim        = TestFixture::dim;
  using Shape              = typename TestFixture::Shape;
  unsigned int   hexahedra = 0, others = 0;
  SmallGrid<dim> grid;
  auto own = random_points<dim>(grid, this->random, true, 0, -1, false);
  std::vector<std::vector<double>> domains(
    n_domain_components(DomainForm::hexahedron, dim),
    std::vector<double>(own.view().size + 8, 0.));
  PointView<dim> points = own.view();
  points.domain_form    = DomainForm::hexahedron;
  for (std::size_t k = 0; k < domains.size(); ++k)
    points.domain[k] = domains[k].data();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const Shape shape = this->random_shape(dim == 2 ? 2 : 0.9);
      for (int d = 0; d < dim; ++d)
        {
          const double size = 0.2 * grid.edge[d];
          for (int k = 0; k < dim; ++k)
            domains[d * dim + k][p] = size * shape.edges[d][k];
          for (int t = 0; t < Shape::n_twists; ++t)
            domains[dim * (dim + t) + d][p] = size * shape.twists[t][d];
        }
      const ConvectedDomain<dim> domain(points, grid.view(), points.cell[p], p);
      ++(domain.is_hexahedron ? hexahedra : others);
      double sum = 0;
      for (int n = 0; n < domain.n_pieces; ++n)
        for (int i = 0; i < Linear<dim>::n_nodes; ++i)
          {
            ASSERT_GE(domain.pieces[n].weight[i], 0);
            sum += domain.pieces[n].weight[i];
          }
      ASSERT_NEAR(sum, 1, 1e-13);
    }
  EXPECT_GT(hexahedra, 3u);
  EXPECT_GT(others, 3u);
}
