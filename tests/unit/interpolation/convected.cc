// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/convected_fields.h>
#include <limber/interpolation/domain_means.h>
#include <limber/state/cell_averages.h>
#include <limber/transfer/convected_transfer.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

#include <cmath>
#include <numeric>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  template <int dimension, DomainForm domain_form>
  struct DomainCase
  {
    static constexpr int        dim  = dimension;
    static constexpr DomainForm form = domain_form;
  };



  /** Random points with random domains on a small grid. */
  template <class Case>
  class ConvectedDomains : public testing::Test
  {
  public:
    static constexpr int        dim  = Case::dim;
    static constexpr DomainForm form = Case::form;
    static constexpr bool       boxes =
      form == DomainForm::box || form == DomainForm::stretched_box;
    static constexpr bool has_twists = form == DomainForm::hexahedron;
    using Layout                     = NodeLayout<dim>;
    using Domain                     = ConvectedDomain<dim>;
    using Window                     = RecordWindow<dim, Layout::velocity, dim>;
    using Fields                     = FieldsOnDomain<dim, Window>;

    /** Half edges up to @p size of those of a cell, not flat. */
    SmallPoints<dim>
    points_with_domains(const double size)
    {
      auto       own    = random_points<dim>(grid, random, true, 0, -1, false);
      const auto points = own.view();
      for (auto &edges : domains)
        edges.assign(points.size + 8, 0.);
      for (std::size_t p = 0; p < points.size; ++p)
        for (int d = 0; d < dim; ++d)
          for (int k = 0; k < dim; ++k)
            domains[d * dim + k][p] =
              size * grid.edge[d] * (d == k ? 0.5 : 0.2 * random());
      if (has_twists)
        for (std::size_t k = dim * dim; k < domains.size(); ++k)
          for (std::size_t p = 0; p < points.size; ++p)
            domains[k][p] = 0.1 * size * grid.edge[k % dim] * random();
      return own;
    }

    PointView<dim>
    view(SmallPoints<dim> &own)
    {
      PointView<dim> points = own.view();
      points.domain_form    = form;
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          if (d == k || form != DomainForm::box)
            points.domain[d * dim + k] = domains[d * dim + k].data();
      for (std::size_t k = dim * dim; k < domains.size(); ++k)
        if (has_twists)
          points.domain[k] = domains[k].data();
      return points;
    }

    void
    set_velocity(const Vector<dim> &a, const Matrix<dim> &A)
    {
      for (std::size_t n = 0; n < grid.n_nodes; ++n)
        for (int d = 0; d < dim; ++d)
          {
            double &v = velocity(n, d);
            v         = a[d];
            for (int e = 0; e < dim; ++e)
              v += A[d][e] * grid.place(n)[e];
          }
    }

    double &
    velocity(const std::size_t node, const int d)
    {
      return grid.nodes[node * Layout::stride + Layout::velocity + d];
    }

    void
    set_twists_to_zero()
    {
      for (std::size_t k = dim * dim; k < domains.size(); ++k)
        std::fill(domains[k].begin(), domains[k].end(), 0.);
    }

    /** Away from the sides by more than a cell. */
    bool
    is_inside(const SmallPoints<dim> &own, const std::size_t p) const
    {
      for (int d = 0; d < dim; ++d)
        {
          const double at = (own.position(p)[d] - grid.lower[d]) / grid.edge[d];
          if (at < 1 || at > grid.bins.n[d] - 1)
            return false;
        }
      return true;
    }

    Random         random;
    SmallGrid<dim> grid;
    std::array<std::vector<double>,
               n_domain_components(DomainForm::hexahedron, dim)>
      domains;
  };

  using Cases = testing::Types<DomainCase<2, DomainForm::parallelepiped>,
                               DomainCase<3, DomainForm::parallelepiped>,
                               DomainCase<2, DomainForm::box>,
                               DomainCase<3, DomainForm::box>,
                               DomainCase<2, DomainForm::stretched_box>,
                               DomainCase<3, DomainForm::stretched_box>,
                               DomainCase<2, DomainForm::hexahedron>,
                               DomainCase<3, DomainForm::hexahedron>>;
  TYPED_TEST_SUITE(ConvectedDomains, Cases);
} // namespace



TYPED_TEST(ConvectedDomains, ReproduceLinearFields)
{
  constexpr int dim  = TestFixture::dim;
  using Layout       = typename TestFixture::Layout;
  const auto  a      = this->random.template vector<dim>();
  const auto  A      = this->random.template matrix<dim>();
  std::size_t inside = 0;
  this->set_velocity(a, A);
  // Within a cell, over several, and longer than what counts.
  for (const double size : {0.2, 0.9, 1.9, 4.})
    {
      auto       own    = this->points_with_domains(size);
      const auto points = this->view(own);
      for (std::size_t p = 0; p < points.size; ++p)
        if (this->is_inside(own, p))
          {
            ++inside;
            const typename TestFixture::Domain domain(points,
                                                      this->grid.view(),
                                                      points.cell[p],
                                                      p);
            const typename TestFixture::Fields fields(domain,
                                                      this->grid.view());
            for (int d = 0; d < dim; ++d)
              {
                double v = a[d];
                for (int e = 0; e < dim; ++e)
                  v += A[d][e] * own.position(p)[e];
                ASSERT_NEAR(fields.value(Layout::velocity + d), v, 1e-13);
                for (int e = 0; e < dim; ++e)
                  ASSERT_NEAR(fields.slope(domain.inverse(),
                                           Layout::velocity + d,
                                           e),
                              A[d][e],
                              1e-12);
              }
          }
    }
  EXPECT_GT(inside, 20u);
}



// Whatever the shape of the domain and wherever its corners are.
TYPED_TEST(ConvectedDomains, AreMeansOfTheFieldAtTheirCorners)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  if (TestFixture::boxes || TestFixture::has_twists)
    return;
  for (double &value : this->grid.nodes)
    value = this->random();
  auto       own    = this->points_with_domains(1.5);
  const auto points = this->view(own);
  for (std::size_t p = 0; p < points.size; ++p)
    {
      const typename TestFixture::Domain domain(points,
                                                this->grid.view(),
                                                points.cell[p],
                                                p);
      const typename TestFixture::Fields fields(domain, this->grid.view());
      double                             mean     = 0;
      bool                               at_sides = false;
      for (int c = 0; c < 1 << dim; ++c)
        {
          Vector<dim> x = own.position(p);
          for (int d = 0; d < dim; ++d)
            {
              double extent = 0;
              for (int k = 0; k < dim; ++k)
                extent += std::abs(points.domain[d * dim + k][p]);
              const double counts = std::min(1., this->grid.edge[d] / extent);
              for (int k = 0; k < dim; ++k)
                x[d] += (c >> k & 1 ? 1 : -1) * counts *
                        points.domain[d * dim + k][p];
              const double upper = this->grid.bins.upper(d);
              at_sides = at_sides || x[d] < this->grid.lower[d] || x[d] > upper;
              x[d]     = std::clamp(x[d], this->grid.lower[d], upper);
            }
          const std::uint32_t cell = this->grid.bins.nearest_cell(x);
          for (int i = 0; i < 1 << dim; ++i)
            mean += this->grid.shape(cell, i, x) *
                    this->velocity(this->grid.node_number(cell, i), 0) /
                    (1 << dim);
        }
      ASSERT_NEAR(fields.value(Layout::velocity), mean, 1e-13) << at_sides;
    }
}



// Boxes: the integrals of Bardenhagen and Kober, by Gauss points in each of the
// cells that a box is in.
TYPED_TEST(ConvectedDomains, AreMeansOfTheFieldOverBoxes)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  if (!TestFixture::boxes)
    return;
  for (double &value : this->grid.nodes)
    value = this->random();
  for (const double size : {0.4, 0.97, 1.8})
    {
      auto       own    = this->points_with_domains(size);
      const auto points = this->view(own);
      for (std::size_t p = 0; p < points.size; ++p)
        {
          if (!this->is_inside(own, p))
            continue;
          // places along each direction, with their shares
          std::array<std::vector<std::pair<double, double>>, dim> places;
          for (int d = 0; d < dim; ++d)
            {
              double half = 0;
              for (int k = 0; k < dim; ++k)
                if (const double *const edge = points.domain[d * dim + k])
                  half += edge[p] * edge[p];
              half = std::min(std::sqrt(half), 0.5 * this->grid.edge[d]);
              std::vector<double> ends  = {own.position(p)[d] - half};
              const double        upper = own.position(p)[d] + half;
              for (int i = 0; i <= int(this->grid.bins.n[d]); ++i)
                if (const double face =
                      this->grid.lower[d] + i * this->grid.edge[d];
                    face > ends.front() && face < upper)
                  ends.push_back(face);
              ends.push_back(upper);
              for (std::size_t i = 0; i + 1 < ends.size(); ++i)
                for (const double s : {-1., 1.})
                  places[d].push_back(
                    {0.5 * (ends[i] + ends[i + 1]) +
                       s * (ends[i + 1] - ends[i]) / std::sqrt(12.),
                     (ends[i + 1] - ends[i]) / (4 * half)});
            }
          double      mean = 0;
          Vector<dim> slope{};
          std::size_t n_places = 1;
          for (const auto &along : places)
            n_places *= along.size();
          for (std::size_t i = 0; i < n_places; ++i)
            {
              Vector<dim> x;
              double      share = 1;
              for (std::size_t d = 0, rest = i; d < dim; ++d)
                {
                  const auto &place = places[d][rest % places[d].size()];
                  rest /= places[d].size();
                  x[d] = place.first;
                  share *= place.second;
                }
              const std::uint32_t cell = this->grid.bins.nearest_cell(x);
              for (int k = 0; k < 1 << dim; ++k)
                {
                  const double v =
                    share * this->velocity(this->grid.node_number(cell, k), 0);
                  const auto gradient = this->grid.gradient(cell, k, x);
                  mean += v * this->grid.shape(cell, k, x);
                  for (int d = 0; d < dim; ++d)
                    slope[d] += v * gradient[d];
                }
            }
          const typename TestFixture::Domain domain(points,
                                                    this->grid.view(),
                                                    points.cell[p],
                                                    p);
          const typename TestFixture::Fields fields(domain, this->grid.view());
          ASSERT_NEAR(fields.value(Layout::velocity), mean, 1e-13);
          for (int d = 0; d < dim; ++d)
            ASSERT_NEAR(fields.slope(domain.inverse(), Layout::velocity, d),
                        slope[d],
                        1e-11);
        }
    }
}



TYPED_TEST(ConvectedDomains, CountAsTheBoxAroundThemIfFlat)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  if (TestFixture::boxes)
    return;
  auto       own    = this->points_with_domains(0.3);
  const auto points = this->view(own);
  for (double &value : this->grid.nodes)
    value = this->random();
  for (std::size_t p = 0; p < points.size; ++p)
    {
      // the second edge along the first, or the domain inside out
      const double sign = p % 2 ? 1 : -1;
      for (int d = 0; d < dim; ++d)
        points.domain[d * dim + 1][p] =
          p % 2 ? points.domain[d * dim][p] : -points.domain[d * dim + 1][p];
      const auto at = [&]() {
        return typename TestFixture::Domain(points,
                                            this->grid.view(),
                                            points.cell[p],
                                            p);
      };
      const auto                         flat = at();
      const typename TestFixture::Fields of_flat(flat, this->grid.view());
      for (int d = 0; d < dim; ++d)
        {
          double extent = 0;
          for (int k = 0; k < dim; ++k)
            extent += std::abs(points.domain[d * dim + k][p]);
          for (int k = 0; k < dim; ++k)
            points.domain[d * dim + k][p] = d == k ? extent : 0;
        }
      for (std::size_t k = dim * dim; k < this->domains.size(); ++k)
        this->domains[k][p] = 0;
      const auto                         box = at();
      const typename TestFixture::Fields of_box(box, this->grid.view());
      for (int e = 0; e < dim; ++e)
        ASSERT_NEAR(of_flat.slope(flat.inverse(), Layout::velocity, e),
                    of_box.slope(box.inverse(), Layout::velocity, e),
                    1e-12)
          << sign;
    }
}



// Sum f_i v_i = - sum V (J sigma : grad v), for all velocities and stresses;
// with means over cells of pressure and divergence.
TYPED_TEST(ConvectedDomains, GiveForcesThatAreTheTransposeOfTheStrain)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  auto       own    = this->points_with_domains(1.2);
  const auto points = this->view(own);
  for (std::size_t p = 0; p < points.size; ++p)
    {
      points.pressure[p] = this->random();
      for (auto *const component : points.deviator)
        component[p] = this->random();
    }
  std::vector<std::uint32_t> cells(this->grid.n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  CellAverages pressure(cells.size()), divergence(cells.size());
  sum_pressure_over_cells<dim>(points, pressure.data());
  pressure.finish(cells);
  const auto former       = own.fields;
  const auto before_nodes = this->grid.nodes;
  for (const Treatment kind : {Treatment::none, Treatment::cell})
    {
      this->grid.nodes = before_nodes;
      P2GOptions what;
      what.inverse_density    = 0.7;
      what.treatment.kind     = kind;
      what.projected_pressure = pressure.data();
      domains_to_grid<dim>(points, this->grid.view(), what);
      EXPECT_EQ(own.fields, former);

      std::vector<double> given = this->grid.nodes;
      const auto slot = [&](const std::size_t node, const unsigned int s) {
        return given[node * Layout::stride + s];
      };
      double      mass = 0, work = 0, scale = 0;
      Vector<dim> momentum{};
      for (std::size_t p = 0; p < points.size; ++p)
        {
          mass -= points.mass[p];
          for (int d = 0; d < dim; ++d)
            momentum[d] -= points.mass[p] * points.velocity[d][p];
        }
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        {
          mass += slot(n, Layout::mass);
          for (int d = 0; d < dim; ++d)
            {
              momentum[d] += slot(n, Layout::momentum + d);
              this->velocity(n, d) = this->random();
              work += slot(n, Layout::force + d) * this->velocity(n, d);
            }
        }
      divergence.clear(cells);
      sum_divergence_of_domains<CellMeanSums<dim>>(points,
                                                   this->grid.view(),
                                                   false,
                                                   divergence.data());
      divergence.finish(cells);
      for (std::size_t p = 0; p < points.size; ++p)
        {
          const typename TestFixture::Domain domain(points,
                                                    this->grid.view(),
                                                    points.cell[p],
                                                    p);
          const typename TestFixture::Fields fields(domain, this->grid.view());
          const auto            t = kirchhoff_stress<dim>(points, p);
          const DomainMean<dim> mean_divergence(
            Treatment::cell,
            divergence.data(),
            this->grid.cells[points.cell[p]],
            points.cell[p]);
          const double mean = mean_divergence.value(std::array<double, dim>());
          double       own_divergence = 0;
          for (int d = 0; d < dim; ++d)
            own_divergence +=
              fields.slope(domain.inverse(), Layout::velocity + d, d);
          double power = 0;
          for (int d = 0; d < dim; ++d)
            for (int e = 0; e < dim; ++e)
              power += t[d][e] *
                       fields.slope(domain.inverse(), Layout::velocity + d, e);
          if (kind == Treatment::cell)
            power -= points.pressure[p] * (mean - own_divergence);
          work += 0.7 * points.mass[p] * power;
          scale += std::abs(0.7 * points.mass[p] * power);
        }
      EXPECT_NEAR(mass, 0, 1e-12);
      EXPECT_NEAR(work, 0, 1e-13 * scale);
      for (int d = 0; d < dim; ++d)
        EXPECT_NEAR(momentum[d], 0, 1e-12);
    }
}



// What FLIP takes is what the nodes give: no momentum is lost, and domains
// follow a homogeneous motion.
TYPED_TEST(ConvectedDomains, TakeWhatNodesGive)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  auto       own    = this->points_with_domains(0.8);
  const auto points = this->view(own);
  P2GOptions what;
  what.force = false;
  domains_to_grid<dim>(points, this->grid.view(), what);
  double added = 0;
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    {
      double *const record      = &this->grid.nodes[n * Layout::stride];
      const double  dv          = this->random();
      record[Layout::increment] = dv;
      record[Layout::velocity]  = 0;
      added += record[Layout::mass] * dv;
    }
  double before = 0, after = 0;
  for (std::size_t p = 0; p < points.size; ++p)
    before += points.mass[p] * points.velocity[0][p];
  G2POptions take;
  take.remap = true;
  grid_to_domains<dim>(points, this->grid.view(), take);
  for (std::size_t p = 0; p < points.size; ++p)
    after += points.mass[p] * points.velocity[0][p];
  EXPECT_NEAR(after - before, added, 1e-12);
  double remapped = 0;
  for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
    remapped += this->grid.nodes[n * Layout::stride + Layout::remapped];
  EXPECT_NEAR(remapped, after, 1e-12);

  const auto A = this->random.template matrix<dim>();
  this->set_velocity({}, A);
  const auto former     = this->domains;
  take                  = {};
  take.move             = 1e-3;
  const auto was_inside = own;
  grid_to_domains<dim>(points, this->grid.view(), take);
  for (std::size_t p = 0; p < points.size; ++p)
    if (this->is_inside(was_inside, p))
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          {
            double wanted = former[d * dim + k][p];
            if (TestFixture::form == DomainForm::box)
              {
                ASSERT_EQ(this->domains[d * dim + k][p], wanted);
                continue;
              }
            for (int e = 0; e < dim; ++e)
              wanted += 1e-3 * A[d][e] * former[e * dim + k][p];
            ASSERT_NEAR(points.domain[d * dim + k][p], wanted, 1e-14);
          }
  if (TestFixture::has_twists)
    for (std::size_t p = 0; p < points.size; ++p)
      if (this->is_inside(was_inside, p))
        for (std::size_t k = dim * dim; k < this->domains.size(); ++k)
          {
            double wanted = former[k][p];
            for (int e = 0; e < dim; ++e)
              wanted += 1e-3 * A[k % dim][e] * former[k - k % dim + e][p];
            ASSERT_NEAR(this->domains[k][p], wanted, 1e-14);
          }
}



// A pack of domains in blocks of cells, whose nodes are read from the table or
// found by cells, and the same one by one, where the table knows no node.
TYPED_TEST(ConvectedDomains, GiveAndTakeTheSameInBlocksAsOneByOne)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  const auto own    = this->points_with_domains(0.5);
  const auto edges  = this->domains;
  const auto wanted = this->grid.nodes;
  P2GOptions what;
  G2POptions take;
  what.inverse_density = 0.7;
  take.remap           = true;
  take.move            = 1e-3;
  take.flip_share      = 0.9;
  std::vector<std::vector<double>> results;
  std::vector<std::uint32_t>       entered;
  const std::vector<std::uint32_t> no_nodes(this->grid.bin_nodes.size(),
                                            BinView<dim>::no_node);
  enum class Way
  {
    table,
    cells,
    one_by_one
  };
  for (const Way way : {Way::table, Way::cells, Way::one_by_one})
    {
      this->grid.bins.one_per_cell = way != Way::cells;
      this->grid.bins.nodes =
        way == Way::table ? this->grid.bin_nodes.data() : no_nodes.data();
      this->grid.nodes = wanted;
      std::fill(this->grid.occupied.begin(), this->grid.occupied.end(), 0);
      this->grid.entered.clear();
      this->domains     = edges;
      auto       copy   = own;
      const auto points = this->view(copy);
      domains_to_grid<dim>(points, this->grid.view(), what);
      for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
        this->grid.nodes[n * Layout::stride + Layout::remapped] = 0;
      grid_to_domains<dim>(points, this->grid.view(), take);
      std::vector<double> all = this->grid.nodes;
      for (std::size_t p = 0; p < points.size; ++p)
        {
          for (int d = 0; d < dim; ++d)
            {
              all.push_back(points.position[d][p]);
              all.push_back(points.velocity[d][p]);
            }
          for (const auto &component : this->domains)
            all.push_back(component[p]);
        }
      results.push_back(all);
      std::sort(this->grid.entered.begin(), this->grid.entered.end());
      if (way == Way::table)
        entered = this->grid.entered;
      else
        EXPECT_EQ(this->grid.entered, entered);
    }
  for (const auto &others : {results[1], results[2]})
    {
      ASSERT_EQ(results[0].size(), others.size());
      for (std::size_t k = 0; k < results[0].size(); ++k)
        ASSERT_NEAR(results[0][k],
                    others[k],
                    1e-12 + 1e-12 * std::abs(results[0][k]))
          << k;
    }
  EXPECT_GT(entered.size(), 5u);
}



// Corners in the faces of cells, but for round-off: nodes beyond get next to no
// mass, and never a negative one, and no force without mass. (With boxes mass
// vanishes as the square of what reaches beyond, force as this itself.)
TYPED_TEST(ConvectedDomains, GiveNoNegativeMass)
{
  constexpr int dim = TestFixture::dim;
  using Layout      = typename TestFixture::Layout;
  auto       own    = this->points_with_domains(0.5);
  const auto points = this->view(own);
  P2GOptions what;
  what.inverse_density = 1;
  this->set_twists_to_zero();
  std::vector<double> smallest(points.size, 1);
  for (std::size_t p = 0; p < points.size; ++p)
    {
      points.pressure[p] = 1;
      for (int d = 0; d < dim; ++d)
        for (int k = 0; k < dim; ++k)
          {
            const auto  &cell     = this->grid.cells[points.cell[p]];
            const double to_lower = points.position[d][p] - cell.origin[d];
            const double to_upper = 1 / cell.inverse_edge[d] - to_lower;
            const double half     = p % 2 ? to_lower : to_upper;
            this->domains[d * dim + k][p] =
              d != k ? 0 : half * (1 + 1e-16 * (double(p % 9) - 4));
            smallest[p] = std::min(smallest[p], half);
          }
    }
  const std::vector<std::uint32_t> no_nodes(this->grid.bin_nodes.size(),
                                            BinView<dim>::no_node);
  for (const bool in_blocks : {true, false})
    for (std::size_t alone = 0; alone < points.size;
         alone += TestFixture::has_twists ? 7 : 1) // which are slow one by one
      {
        this->grid.bins.nodes =
          in_blocks ? this->grid.bin_nodes.data() : no_nodes.data();
        std::fill(this->grid.nodes.begin(), this->grid.nodes.end(), 0.);
        for (std::size_t p = 0; p < points.size; ++p)
          points.mass[p] = p == alone ? 1 : 0;
        domains_to_grid<dim>(points, this->grid.view(), what);
        for (std::size_t n = 0; n < this->grid.n_nodes; ++n)
          {
            const double *const record = &this->grid.nodes[n * Layout::stride];
            const double        mass   = record[Layout::mass];
            ASSERT_GE(mass, 0) << in_blocks;
            for (int d = 0; d < dim; ++d)
              if (!TestFixture::boxes || mass == 0)
                {
                  ASSERT_LE(std::abs(record[Layout::force + d]),
                            5 * mass / smallest[alone])
                    << in_blocks;
                }
          }
      }
}
