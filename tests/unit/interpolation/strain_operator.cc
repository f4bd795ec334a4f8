// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/strain_operator.h>
#include <limber/transfer/points_to_grid.h>
#include <limber/transfer/project_on_nodes.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>
#include <support/treatments.h>

#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int        dimension,
            Treatment  treatment_kind,
            KernelKind kernel_kind = KernelKind::linear>
  struct Case
  {
    static constexpr int        dim    = dimension;
    static constexpr Treatment  kind   = treatment_kind;
    static constexpr KernelKind kernel = kernel_kind;
  };



  template <class Case>
  class Strain : public testing::Test
  {
  public:
    static constexpr int       dim  = Case::dim;
    static constexpr Treatment kind = Case::kind;
    using Layout                    = NodeLayout<dim>;
    using Grid                      = SmallGrid<dim, Case::kernel>;
    using Basis                     = typename Grid::Basis;

    /** B v at every point, from the velocities in the records of the nodes. */
    std::vector<MotionIncrement<dim, double>>
    strain(const SmallPoints<dim> &own, const PointView<dim> &points)
    {
      std::vector<MotionIncrement<dim, double>> result(points.size);
      const auto                                sums = grid.cell_sums();
      const double *const                       divergence =
        grid.nodal_means([&](double *const records) {
          sum_divergence<dim>(points, grid.view(), false, records);
        });
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const auto &cell = grid.cells[points.cell[p]];
          const NodalCoefficients<Basis, Layout::velocity, dim> velocities(
            grid.view(), points.cell[p]);
          const auto                 velocity = velocities.field(0);
          const NodalMean<dim, kind> nodal(divergence, cell);
          const StrainOperator<Basis, kind, std::decay_t<decltype(velocity)>> B(
            velocity,
            cell,
            CellMeans<Basis>(&sums, points.cell[p]),
            nodal,
            strain_treatment_of(kind),
            1.);
          const auto              x = own.position(p);
          std::array<double, dim> xi;
          for (int d = 0; d < dim; ++d)
            xi[d] = (x[d] - cell.origin[d]) * cell.inverse_edge[d];
          B.template evaluate<double>(xi, result[p]);
        }
      return result;
    }

    void
    set_velocities()
    {
      for (double &value : grid.nodes)
        value = random();
    }

    Random random;
    Grid   grid;
  };

  constexpr KernelKind quadratic = KernelKind::quadratic;
  constexpr KernelKind cubic     = KernelKind::cubic;

  using Cases = testing::Types<Case<2, Treatment::none>,
                               Case<2, Treatment::cell>,
                               Case<2, Treatment::cell_shear>,
                               Case<2, Treatment::cell_full>,
                               Case<2, Treatment::assumed_strain>,
                               Case<2, Treatment::node>,
                               Case<2, Treatment::hybrid>,
                               Case<3, Treatment::none>,
                               Case<3, Treatment::cell>,
                               Case<3, Treatment::cell_shear>,
                               Case<3, Treatment::cell_full>,
                               Case<3, Treatment::assumed_strain>,
                               Case<3, Treatment::node>,
                               Case<3, Treatment::hybrid>,
                               Case<2, Treatment::none, quadratic>,
                               Case<2, Treatment::cell, quadratic>,
                               Case<2, Treatment::cell_shear, quadratic>,
                               Case<2, Treatment::cell_full, quadratic>,
                               Case<2, Treatment::node, quadratic>,
                               Case<2, Treatment::hybrid, quadratic>,
                               Case<3, Treatment::none, quadratic>,
                               Case<3, Treatment::cell, quadratic>,
                               Case<3, Treatment::cell_shear, quadratic>,
                               Case<3, Treatment::cell_full, quadratic>,
                               Case<3, Treatment::node, quadratic>,
                               Case<3, Treatment::hybrid, quadratic>,
                               Case<2, Treatment::none, cubic>,
                               Case<2, Treatment::cell, cubic>,
                               Case<2, Treatment::cell_shear, cubic>,
                               Case<2, Treatment::cell_full, cubic>,
                               Case<2, Treatment::node, cubic>,
                               Case<2, Treatment::hybrid, cubic>,
                               Case<3, Treatment::none, cubic>,
                               Case<3, Treatment::cell, cubic>,
                               Case<3, Treatment::cell_shear, cubic>,
                               Case<3, Treatment::cell_full, cubic>,
                               Case<3, Treatment::node, cubic>,
                               Case<3, Treatment::hybrid, cubic>>;
  TYPED_TEST_SUITE(Strain, Cases);
} // namespace



// sum f_i v_i = - sum V (dev tau : D - p tr D): what is projected in the strain
// is projected in the stress, by the same operator with the same weights.
TYPED_TEST(Strain, StressActsThroughTheTransposeOfTheStrainOperator)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  for (int variant = 0; variant < 8; ++variant)
    {
      auto       own    = random_points<dim>(this->grid,
                                    this->random,
                                    /*deviator=*/variant & 1,
                                    0,
                                    -1,
                                    /*shuffled=*/variant & 2);
      const auto points = own.view();
      this->grid.gather(points);
      this->set_velocities();
      const auto strain = this->strain(own, points);

      double on_points = 0, size = 0;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          auto stress = kirchhoff_stress(points, p);
          for (int d = 0; d < 3; ++d)
            stress[d][d] += points.pressure[p];
          double power = -points.pressure[p] * strain[p].volumetric;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              power += stress[d][e] * strain[p].gradient[d][e];
          on_points += 0.8 * points.mass[p] * power;
          size += std::abs(0.8 * points.mass[p] * power);
        }

      const auto velocities = this->grid.nodes;
      P2GOptions what;
      what.momentum        = variant & 4;
      what.inverse_density = 0.8;
      what.treatment       = strain_treatment_of(TestFixture::kind);
      this->grid.clear();
      what.projected_pressure =
        this->grid.nodal_means([&](double *const records) {
          sum_pressure<dim>(points, this->grid.view(), records);
        });
      const auto sums = this->grid.cell_sums();
      points_to_grid<dim>(points, this->grid.view(), what, &sums);
      double on_grid = 0;
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          on_grid += this->grid.nodes[n * Layout::stride + Layout::force + d] *
                     velocities[n * Layout::stride + Layout::velocity + d];
      EXPECT_NEAR(on_grid, -on_points, 1e-13 * size);
    }
}



// Rigid motion and homogeneous deformation pass through unchanged.
TYPED_TEST(Strain, LinearFieldsAreReproduced)
{
  constexpr int dim   = TestFixture::dim;
  using Layout        = typename TestFixture::Layout;
  auto       own      = random_points<dim>(this->grid, this->random);
  const auto points   = own.view();
  const auto constant = this->random.template vector<dim>();
  const auto gradient = this->random.template matrix<dim>(2.);
  this->grid.gather(points);
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    for (int d = 0; d < dim; ++d)
      {
        double v = constant[d];
        for (int e = 0; e < dim; ++e)
          v += gradient[d][e] * this->grid.place(n)[e];
        this->grid.nodes[n * Layout::stride + Layout::velocity + d] = v;
      }
  for (const auto &motion : this->strain(own, points))
    {
      double trace = 0;
      for (int d = 0; d < dim; ++d)
        {
          trace += gradient[d][d];
          for (int e = 0; e < dim; ++e)
            EXPECT_NEAR(motion.gradient[d][e], gradient[d][e], 1e-12);
        }
      EXPECT_NEAR(motion.volumetric, trace, 1e-12);
    }
}



// The mean of the strain over the points of a cell is that of the gradient,
// whatever the treatment does to its deviation from the mean. Averages around
// nodes keep that of the volumetric part over the whole body.
TYPED_TEST(Strain, MeansAreThoseOfTheGradient)
{
  constexpr int dim    = TestFixture::dim;
  auto          own    = random_points<dim>(this->grid, this->random);
  const auto    points = own.view();
  this->grid.gather(points);
  this->set_velocities();
  const auto strain = this->strain(own, points);

  struct Sums
  {
    Matrix<dim> projected{}, plain{};
    double      volumetric = 0, trace = 0;
  };
  std::vector<Sums> sums(this->grid.n_cells);
  for (std::size_t p = 0; p < points.size; ++p)
    {
      Sums       &sum   = sums[points.cell[p]];
      const auto &nodes = this->grid.nodes_of(points.cell[p]);
      Matrix<dim> L{};
      for (int i = 0; i < TestFixture::Grid::n_in_cell; ++i)
        {
          const auto G =
            this->grid.gradient(points.cell[p], i, own.position(p));
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              L[d][e] +=
                G[e] *
                this->grid.nodes[nodes.node[i] + NodeLayout<dim>::velocity + d];
        }
      for (int d = 0; d < dim; ++d)
        {
          for (int e = 0; e < dim; ++e)
            {
              sum.plain[d][e] += points.mass[p] * (L[d][e] + L[e][d]);
              sum.projected[d][e] +=
                points.mass[p] *
                (strain[p].gradient[d][e] + strain[p].gradient[e][d]);
            }
          sum.trace += points.mass[p] * L[d][d];
        }
      sum.volumetric += points.mass[p] * strain[p].volumetric;
    }
  double volumetric = 0, trace = 0;
  for (const Sums &sum : sums)
    {
      volumetric += sum.volumetric;
      trace += sum.trace;
      if (!averages_around_nodes(TestFixture::kind))
        {
          EXPECT_NEAR(sum.volumetric, sum.trace, 1e-12);
        }
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          EXPECT_NEAR(sum.projected[d][e], sum.plain[d][e], 1e-12);
    }
  EXPECT_NEAR(volumetric, trace, 1e-10);
}



// The mirror image of a motion has the mirror image of its strain: no corner
// of the cell is preferred.
TYPED_TEST(Strain, MirrorImagesAreStrainedAlike)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  using Basis       = typename TestFixture::Basis;
  constexpr int n   = Basis::n_nodes;
  for (int across = 0; across < dim; ++across)
    {
      const auto mirrored = [&](const int i) {
        const int last = Basis::stride(1) - 1; // of the nodes along an edge
        return i + (last - 2 * Basis::power(i, across)) * Basis::stride(across);
      };
      // one cell with a few points, and its mirror image
      CellGeometry<dim>                  cell;
      typename TestFixture::Grid::Spline spline;
      for (int d = 0; d < dim; ++d)
        {
          cell.origin[d]       = 0;
          cell.inverse_edge[d] = 1 + 0.5 * d;
          spline.lower[d] = spline.upper[d] = TestFixture::Grid::inner_factor();
        }
      for (int i = 0; i < 1 << dim; ++i)
        cell.node[i] = i * Layout::stride;
      for (int i = 0; i < int(spline.node.size()); ++i)
        spline.node[i] = i * Layout::stride;
      std::vector<double> nodes(n * Layout::stride);
      for (double &value : nodes)
        value = this->random();
      auto mirrored_nodes = nodes;
      for (int i = 0; i < n; ++i)
        for (int d = 0; d < dim; ++d)
          mirrored_nodes[mirrored(i) * Layout::stride + Layout::velocity + d] =
            (d == across ? -1 : 1) *
            nodes[i * Layout::stride + Layout::velocity + d];

      std::vector<std::array<double, dim>> places(5), mirrored_places;
      std::vector<double>                  sums(n), mirrored_sums(n);
      // means of the divergence around the nodes, of whatever neighbours do
      constexpr auto      stride = NodalMeanLayout::stride;
      std::vector<double> means(stride << dim), mirrored_means(means.size());
      for (int i = 0; i < 1 << dim; ++i)
        means[i * stride + NodalMeanLayout::value] =
          mirrored_means[(i ^ 1 << across) * stride + NodalMeanLayout::value] =
            this->random();
      for (auto &xi : places)
        {
          for (double &x : xi)
            x = this->random(0, 1);
          mirrored_places.push_back(xi);
          mirrored_places.back()[across] = 1 - xi[across];
          for (int k = 0; k < n - 1; ++k)
            {
              const auto monomial = [&](const std::array<double, dim> &at) {
                double result = 1;
                for (int d = 0; d < dim; ++d)
                  result *= std::pow(at[d], Basis::power(k, d));
                return result;
              };
              sums[k] += monomial(xi);
              mirrored_sums[k] += monomial(mirrored_places.back());
            }
        }

      const auto strain = [&](std::vector<double>           &records,
                              const std::vector<double>     &moments,
                              const std::vector<double>     &divergence,
                              const std::array<double, dim> &xi) {
        CellSums<dim> view;
        view.now = moments.data();
        GridView<dim> grid;
        grid.cells = &cell;
        if constexpr (TestFixture::Grid::degree == 2)
          grid.quadratics = &spline;
        if constexpr (TestFixture::Grid::degree == 3)
          grid.cubics = &spline;
        grid.nodes = records.data();
        const NodalCoefficients<Basis, Layout::velocity, dim> velocities(grid,
                                                                         0);
        const auto                              velocity = velocities.field(0);
        const NodalMean<dim, TestFixture::kind> nodal(divergence.data(), cell);
        const StrainOperator<Basis,
                             TestFixture::kind,
                             std::decay_t<decltype(velocity)>>
                                     B(velocity,
            cell,
            CellMeans<Basis>(&view, 0),
            nodal,
            strain_treatment_of(TestFixture::kind),
            1.);
        MotionIncrement<dim, double> result;
        B.template evaluate<double>(xi, result);
        return result;
      };
      for (std::size_t p = 0; p < places.size(); ++p)
        {
          const auto one = strain(nodes, sums, means, places[p]);
          const auto two = strain(mirrored_nodes,
                                  mirrored_sums,
                                  mirrored_means,
                                  mirrored_places[p]);
          EXPECT_NEAR(one.volumetric, two.volumetric, 1e-13);
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              EXPECT_NEAR(one.gradient[d][e],
                          ((d == across) != (e == across) ? -1 : 1) *
                            two.gradient[d][e],
                          1e-13);
        }
    }
}
