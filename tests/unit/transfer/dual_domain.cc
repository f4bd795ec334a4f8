// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/domain_means.h>
#include <limber/interpolation/dual_domain.h>
#include <limber/stress/dual_domain_sweep.h>
#include <limber/transfer/convected_transfer.h>
#include <limber/transfer/dual_domain_transfer.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  /** A law that only writes down by what it is strained. */
  template <int dim>
  class MotionRecorder : public PackStrain<dim>
  {
  public:
    using Motion = typename PackStrain<dim>::Motion;

    explicit MotionRecorder(const std::size_t n)
      : gradient(n)
      , volumetric(n)
    {}

    PointPack<dim>
    strain_pack(const PointView<dim> &,
                const BatchLanes<dim, true> &lanes,
                const Motion                &motion,
                const HistoryChange &,
                PackFindings<dim> &) const override
    {
      return note(lanes, motion);
    }

    PointPack<dim>
    strain_pack(const PointView<dim> &,
                const BatchLanes<dim, false> &lanes,
                const Motion                 &motion,
                const HistoryChange &,
                PackFindings<dim> &) const override
    {
      return note(lanes, motion);
    }

    mutable std::vector<Matrix<dim>> gradient;
    mutable std::vector<double>      volumetric;

  private:
    template <class Lanes>
    PointPack<dim>
    note(const Lanes &lanes, const Motion &motion) const
    {
      for (int k = 0; k < lanes.n; ++k)
        {
          volumetric[lanes.first + k] = motion.volumetric[k];
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              gradient[lanes.first + k][d][e] = motion.gradient[d][e][k];
        }
      return motion.volumetric;
    }
  };



  /** What DualDomain does at the nodes of a grid, on the small one. */
  template <class Dimension>
  class DualDomainTransfer : public testing::Test
  {
  public:
    static constexpr int dim = Dimension::value;
    using Layout             = DualDomainLayout<dim>;
    using Nodes              = NodeLayout<dim>;

    DualDomainTransfer()
      : records(grid.n_nodes * Layout::stride)
      , weight(grid.n_cells)
    {}

    GridView<dim>
    view()
    {
      GridView<dim> result = grid.view();
      result.dual_domain   = records.data();
      return result;
    }

    double &
    value(const std::size_t node, const unsigned int slot)
    {
      return records[node * Layout::stride + slot];
    }

    /** Weights of cells by the masses of points, and volumes around nodes. */
    void
    find_volumes(const PointView<dim> &points)
    {
      grid.clear();
      P2GOptions what;
      what.force = false;
      points_to_grid<dim>(points, grid.view(), what, nullptr);
      std::fill(weight.begin(), weight.end(), 0.);
      for (std::size_t p = 0; p < points.size; ++p)
        weight[points.cell[p]] =
          weight_of_cell<dim>(grid.nodes.data(), grid.cells[points.cell[p]]);
      set_volumes();
    }

    void
    set_volumes()
    {
      std::fill(records.begin(), records.end(), 0.);
      for (std::size_t c = 0; c < grid.n_cells; ++c)
        DualDomainCell<dim>(grid.cells[c], weight[c])
          .add_volumes(records.data());
    }

    void
    divide()
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            value(n, Layout::tensor(d, e)) *=
              value(n, Layout::volume) > 0 ? 1 / value(n, Layout::volume) : 0;
    }

    void
    clear_tensors()
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            value(n, Layout::tensor(d, e)) = 0;
    }

    void
    average_gradients(const unsigned int slot)
    {
      clear_tensors();
      for (std::size_t c = 0; c < grid.n_cells; ++c)
        DualDomainCell<dim>(grid.cells[c], weight[c])
          .add_mean_gradients(grid.nodes.data(), slot, records.data());
      divide();
    }

    /** Nodal velocities a + A x in both fields. */
    void
    linear_motion(const Vector<dim> &a, const Matrix<dim> &A)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          {
            double v = a[d];
            for (int e = 0; e < dim; ++e)
              v += A[d][e] * grid.place(n)[e];
            for (const unsigned int slot : {Nodes::velocity, Nodes::remapped})
              grid.nodes[n * Nodes::stride + slot + d] = v;
          }
    }

    /** What strains the points, with a step of one second. */
    MotionRecorder<dim>
    strain(const PointView<dim> &points,
           const bool            remapped,
           const Treatment       kind = Treatment::none,
           const double *const   mean = nullptr)
    {
      MotionRecorder<dim> result(points.size);
      StressSweep         what;
      what.step                 = 1;
      what.remapped             = remapped;
      what.projected_divergence = mean;
      PackFindings<dim> found;
      strain_by_dual_domain<dim>(
        points, view(), nullptr, what, {kind}, result, found);
      return result;
    }

    /** The internal forces of stress, in the records of the grid. */
    void
    give_forces(const PointView<dim> &points, const P2GOptions &what)
    {
      clear_tensors();
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          grid.nodes[n * Nodes::stride + Nodes::force + d] =
            value(n, Layout::force + d) = 0;
      stress_to_dual_domain<dim>(points, view(), what);
      divide();
      for (std::size_t c = 0; c < grid.n_cells; ++c)
        DualDomainCell<dim>(grid.cells[c], weight[c])
          .add_forces_of_stress(records.data());
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          grid.nodes[n * Nodes::stride + Nodes::force + d] +=
            value(n, Layout::force + d);
    }

    /** The means of a quantity of the points, by cells or around nodes. */
    template <class Sum>
    const double *
    means(const Treatment kind, const Sum &sum)
    {
      mean.assign(std::max(grid.n_cells, grid.n_vertices) *
                    NodalMeanLayout::stride,
                  0.);
      sum(kind == Treatment::cell, mean.data());
      for (std::size_t k = 0; k < mean.size(); k += NodalMeanLayout::stride)
        if (mean[k + NodalMeanLayout::mass] > 0)
          mean[k + NodalMeanLayout::value] /= mean[k + NodalMeanLayout::mass];
      return mean.data();
    }

    Random              random;
    SmallGrid<dim>      grid;
    std::vector<double> records, weight, mean;
  };

  using Dimensions = testing::Types<std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(DualDomainTransfer, Dimensions);
} // namespace



// The sums of cells are integrals: two points of Gauss along each edge are
// exact for N_j grad v.
TYPED_TEST(DualDomainTransfer, MeanGradientsAreIntegrals)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  auto &grid        = this->grid;
  for (double &w : this->weight)
    w = this->random(0.1, 1);
  for (double &v : grid.nodes)
    v = this->random();
  this->set_volumes();
  const unsigned int slot = NodeLayout<dim>::remapped;

  std::vector<double>      volume(grid.n_nodes);
  std::vector<Matrix<dim>> integral(grid.n_nodes, Matrix<dim>{});
  for (std::uint32_t c = 0; c < grid.n_cells; ++c)
    for (int q = 0; q < 1 << dim; ++q)
      {
        Vector<dim> x;
        double      dV = this->weight[c];
        for (int d = 0; d < dim; ++d)
          {
            const double gauss = 0.5 + (q >> d & 1 ? 0.5 : -0.5) / std::sqrt(3);
            x[d]               = grid.cells[c].origin[d] + grid.edge[d] * gauss;
            dV *= 0.5 * grid.edge[d];
          }
        Matrix<dim> slope{};
        for (int i = 0; i < 1 << dim; ++i)
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              slope[d][e] += grid.nodes[grid.cells[c].node[i] + slot + d] *
                             grid.gradient(c, i, x)[e];
        for (int j = 0; j < 1 << dim; ++j)
          {
            const double NdV = dV * grid.shape(c, j, x);
            const auto   n   = grid.node_number(c, j);
            volume[n] += NdV;
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                integral[n][d][e] += NdV * slope[d][e];
          }
      }

  this->average_gradients(slot);
  for (std::size_t n = 0; n < grid.n_nodes; ++n)
    {
      EXPECT_NEAR(this->value(n, Layout::volume), volume[n], 1e-14);
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          EXPECT_NEAR(this->value(n, Layout::tensor(d, e)),
                      integral[n][d][e] / volume[n],
                      1e-12);
    }
}



TYPED_TEST(DualDomainTransfer, LinearMotionHasItsGradientEverywhere)
{
  constexpr int dim    = TestFixture::dim;
  auto          own    = random_points<dim>(this->grid, this->random);
  const auto    points = own.view();
  const auto    A      = this->random.template matrix<dim>();
  this->find_volumes(points);
  this->linear_motion(this->random.template vector<dim>(), A);
  for (const bool remapped : {false, true})
    {
      this->average_gradients(remapped ? NodeLayout<dim>::remapped :
                                         NodeLayout<dim>::velocity);
      const auto found = this->strain(points, remapped);
      for (std::size_t p = 0; p < points.size; ++p)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            ASSERT_NEAR(found.gradient[p][d][e], A[d][e], 1e-12);
    }
}



// At the centre of a cell a point has its own gradient, on faces that of the
// nodes, which is the same from both sides.
TYPED_TEST(DualDomainTransfer, GradientsAreContinuousAcrossFaces)
{
  constexpr int dim  = TestFixture::dim;
  auto         &grid = this->grid;
  std::fill(this->weight.begin(), this->weight.end(), 1.);
  this->set_volumes();
  for (double &v : grid.nodes)
    v = this->random();
  this->average_gradients(NodeLayout<dim>::velocity);

  // points 2k and 2k + 1 at the same place in the face between two cells
  const std::uint32_t n_along_x = 5;
  SmallPoints<dim>    own(2 * (n_along_x - 1), true, 0, -1);
  const auto          points = own.view();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const std::uint32_t cell = p / 2, side = p % 2;
      points.cell[p]        = cell + side;
      points.mass[p]        = 1;
      points.position[0][p] = grid.cells[cell + 1].origin[0];
      for (int d = 1; d < dim; ++d)
        points.position[d][p] =
          grid.cells[cell].origin[d] + 0.3 * d * grid.edge[d];
    }
  const auto found = this->strain(points, false);
  for (std::size_t p = 0; p < points.size; p += 2)
    {
      double jump_of_linear = 0;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e)
          {
            EXPECT_NEAR(found.gradient[p][d][e],
                        found.gradient[p + 1][d][e],
                        1e-12);
            double jump = 0;
            for (const std::size_t q : {p, p + 1})
              for (int i = 0; i < 1 << dim; ++i)
                jump += (q == p ? 1 : -1) *
                        grid.nodes[grid.cells[points.cell[q]].node[i] +
                                   NodeLayout<dim>::velocity + d] *
                        grid.gradient(points.cell[q], i, own.position(q))[e];
            jump_of_linear = std::max(jump_of_linear, std::abs(jump));
          }
      EXPECT_GT(jump_of_linear, 0.1);
    }
}



// - sum f_i v_i = sum V sigma : grad v, with any mean of the pressure.
TYPED_TEST(DualDomainTransfer, ForcesAreTheTransposeOfTheStrain)
{
  constexpr int dim = TestFixture::dim;
  using Nodes       = NodeLayout<dim>;
  for (const Treatment kind :
       {Treatment::none, Treatment::cell, Treatment::node})
    for (int variant = 0; variant < 8; ++variant)
      {
        const bool remapped = variant & 1;
        auto       own      = random_points<dim>(
          this->grid, this->random, variant & 2, 0, -1, variant & 4);
        const auto points = own.view();
        this->find_volumes(points);

        P2GOptions what;
        what.momentum        = false;
        what.inverse_density = 0.8;
        what.treatment.kind  = kind;
        what.projected_pressure =
          this->means(kind, [&](const bool by_cells, double *const records) {
            if (by_cells)
              sum_pressure_over_cells<dim>(points, records);
            else
              for (std::size_t p = 0; p < points.size; ++p)
                {
                  const auto    &cell = this->grid.cells[points.cell[p]];
                  NodalSums<dim> sums;
                  sums.add(natural_place(points, cell, p),
                           points.mass[p],
                           points.pressure[p]);
                  sums.add_to_nodes(cell, records);
                }
          });
        this->give_forces(points, what);

        std::vector<double> force(this->grid.n_nodes * dim);
        Vector<dim>         total{};
        Matrix<dim>         moment{};
        for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
          for (int d = 0; d < dim; ++d)
            {
              force[n * dim + d] =
                this->grid.nodes[n * Nodes::stride + Nodes::force + d];
              total[d] += force[n * dim + d];
              for (int e = 0; e < dim; ++e)
                {
                  const double m = this->grid.place(n)[e] * force[n * dim + d];
                  moment[d][e] += m;
                  moment[e][d] -= m;
                }
            }
        for (int d = 0; d < dim; ++d)
          {
            EXPECT_NEAR(total[d], 0, 1e-11);
            for (int e = 0; e < dim; ++e)
              EXPECT_NEAR(moment[d][e], 0, 1e-11);
          }

        // velocities now, as masses are not needed any more
        for (double &v : this->grid.nodes)
          v = this->random();
        const unsigned int slot = remapped ? Nodes::remapped : Nodes::velocity;
        this->average_gradients(slot);
        const double *const divergence =
          this->means(kind, [&](const bool by_cells, double *const records) {
            if (by_cells)
              sum_divergence_of_dual_domain<CellMeanSums<dim>>(points,
                                                               this->view(),
                                                               remapped,
                                                               records);
            else
              sum_divergence_of_dual_domain<NodalMeanSums<dim>>(points,
                                                                this->view(),
                                                                remapped,
                                                                records);
          });
        const auto found = this->strain(points, remapped, kind, divergence);

        double power = 0, size = 0, of_forces = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double V = what.inverse_density * points.mass[p];
            auto         t = kirchhoff_stress<dim>(points, p);
            for (int d = 0; d < 3; ++d)
              t[d][d] += points.pressure[p];
            double of_point = -points.pressure[p] * found.volumetric[p];
            for (int d = 0; d < dim; ++d)
              for (int e = 0; e < dim; ++e)
                of_point += t[d][e] * found.gradient[p][d][e];
            power += V * of_point;
            size += std::abs(V * of_point);
          }
        for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
          for (int d = 0; d < dim; ++d)
            of_forces -= force[n * dim + d] *
                         this->grid.nodes[n * Nodes::stride + slot + d];
        EXPECT_GT(std::abs(power), 1e-4 * size);
        EXPECT_NEAR(of_forces, power, 1e-13 * size) << int(kind);
      }
}



TYPED_TEST(DualDomainTransfer, CellsCountByTheirEmptiestNode)
{
  constexpr int       dim  = TestFixture::dim;
  const auto         &cell = this->grid.cells[0];
  std::vector<double> nodes(this->grid.nodes.size());
  const auto          weight = [&](const double least) {
    for (int i = 0; i < 1 << dim; ++i)
      nodes[cell.node[i]] = i == 1 ? least : 2;
    return weight_of_cell<dim>(nodes.data(), cell);
  };
  EXPECT_EQ(weight(2), 1);
  EXPECT_EQ(weight(2. / (1 << dim)), 1);
  EXPECT_DOUBLE_EQ(weight(1. / (1 << dim)), 0.5);
  EXPECT_EQ(weight(0), 0);
  std::fill(nodes.begin(), nodes.end(), 0.);
  EXPECT_EQ(weight_of_cell<dim>(nodes.data(), cell), 0);
}
