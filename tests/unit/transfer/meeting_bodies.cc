// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/transfer/surface_points.h>

#include <gtest/gtest.h>
#include <support/small_grid.h>

using namespace limber;
using namespace limber::testing_support;

namespace
{
  constexpr double inverse_density = 0.01;   // points far smaller than cells
  constexpr double nowhere         = -1e300; // of extents that nothing has



  /** Points of one body; every other cell has corners at meetings, any k. */
  template <int dim, KernelKind kernel>
  struct Meetings
  {
    using Grid = SmallGrid<dim, kernel>;

    static constexpr std::uint32_t n = 12; // meetings

    Meetings()
      : points(random_points<dim>(grid, random, true, 0, -1, true))
    {
      for_each_batch(points.view(), [&](const CellBatch &batch) {
        if (random.below(2) == 0)
          return;
        const auto        first = static_cast<std::uint32_t>(corners.size());
        const std::size_t side  = random.below(2); // first or second body
        for (std::uint32_t k = 0; k < Grid::n_in_cell; ++k)
          if (random.below(2) == 0)
            corners.push_back(
              {static_cast<std::uint32_t>(2 * random.below(n - 1) + side),
               k,
               random.below(2) == 0 ? 1 : random(0.1, 1)});
        if (corners.size() > first)
          batches.push_back(
            {batch, 0, first, static_cast<std::uint32_t>(corners.size())});
      });
    }

    MeetingBatches
    all() const
    {
      return {batches.data(),
              batches.data() + batches.size(),
              corners.data(),
              inverse_density};
    }

    /** Call work(point, corner, batch) with all that belong together. */
    template <class Work>
    void
    for_each_pair(const Work &work) const
    {
      for (const MeetingBatch &some : batches)
        for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
          for (std::uint32_t c = some.first; c < some.last; ++c)
            work(p, corners[c], some);
    }

    double
    volume(const std::size_t p)
    {
      return points.view().mass[p] * inverse_density;
    }

    double
    half_edge(const std::size_t p)
    {
      return 0.5 * std::pow(volume(p), 1. / dim);
    }

    Random                     random;
    Grid                       grid;
    SmallPoints<dim>           points;
    std::vector<MeetingCorner> corners;
    std::vector<MeetingBatch>  batches;
  };



  template <int dim>
  double
  product(const Vector<dim> &a, const double *const b)
  {
    double result = 0;
    for (int d = 0; d < dim; ++d)
      result += a[d] * b[d];
    return result;
  }



  template <int dimension, KernelKind kernel_kind>
  struct MeetingCase
  {
    static constexpr int        dim    = dimension;
    static constexpr KernelKind kernel = kernel_kind;
  };

  template <class Case>
  class MeetingBodies : public testing::Test
  {
  public:
    static constexpr int        dim    = Case::dim;
    static constexpr KernelKind kernel = Case::kernel;
    using Grid                         = SmallGrid<dim, kernel>;
    Meetings<dim, kernel> meetings;
  };

  using MeetingCases = testing::Types<MeetingCase<2, KernelKind::linear>,
                                      MeetingCase<3, KernelKind::linear>,
                                      MeetingCase<2, KernelKind::quadratic>,
                                      MeetingCase<3, KernelKind::quadratic>,
                                      MeetingCase<2, KernelKind::cubic>,
                                      MeetingCase<3, KernelKind::cubic>>;
  TYPED_TEST_SUITE(MeetingBodies, MeetingCases);
} // namespace



TYPED_TEST(MeetingBodies, GradientsOfVolumeAreThoseOfAPlainLoop)
{
  constexpr int       dim = TestFixture::dim;
  auto               &m   = this->meetings;
  std::vector<double> expected(2 * m.n * dim, 0.25), found = expected;
  m.for_each_pair([&](const std::size_t    p,
                      const MeetingCorner &corner,
                      const MeetingBatch  &some) {
    const auto gradient = m.grid.gradient(some.batch.cell,
                                          static_cast<int>(corner.k),
                                          m.points.position(p));
    for (int d = 0; d < dim; ++d)
      expected[corner.slot * dim + d] +=
        corner.share * m.volume(p) * gradient[d];
  });
  add_volume_gradients<dim>(m.points.view(),
                            m.grid.view(),
                            m.all(),
                            found.data());
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-11 * (1 + std::abs(expected[k])))
      << "slot " << k / dim << ", direction " << k % dim;
}



// Functions have the sum 1 everywhere: what all nodes of a cell get is zero.
TYPED_TEST(MeetingBodies, GradientsOfAllNodesCancel)
{
  constexpr int              dim = TestFixture::dim;
  auto                      &m   = this->meetings;
  std::vector<MeetingCorner> corners;
  for (std::uint32_t k = 0; k < m.grid.n_in_cell; ++k)
    corners.push_back({k, k, 1});
  std::vector<MeetingBatch> batches;
  for_each_batch(m.points.view(), [&](const CellBatch &batch) {
    batches.push_back(
      {batch, 0, 0, static_cast<std::uint32_t>(corners.size())});
  });
  std::vector<double> gradients(corners.size() * dim);
  add_volume_gradients<dim>(m.points.view(),
                            m.grid.view(),
                            {batches.data(),
                             batches.data() + batches.size(),
                             corners.data(),
                             inverse_density},
                            gradients.data());
  for (int d = 0; d < dim; ++d)
    {
      double sum = 0, size = 0;
      for (std::size_t k = 0; k < corners.size(); ++k)
        {
          sum += gradients[k * dim + d];
          size += std::abs(gradients[k * dim + d]);
        }
      EXPECT_GT(size, 0.1);
      EXPECT_NEAR(sum, 0, 1e-14 * size * m.points.size);
    }
}



TYPED_TEST(MeetingBodies, ExtentsAreTheLargestOfAPlainLoop)
{
  constexpr int       dim = TestFixture::dim;
  auto               &m   = this->meetings;
  std::vector<double> directions(m.n * n_separations * dim);
  for (double &x : directions)
    x = m.random();
  std::vector<double> expected(2 * m.n * n_separations, nowhere);
  m.for_each_pair([&](const std::size_t    p,
                      const MeetingCorner &corner,
                      const MeetingBatch &) {
    for (int k = 0; k < n_separations; ++k)
      {
        const double along = product<dim>(
          m.points.position(p),
          &directions[(corner.slot / 2 * n_separations + k) * dim]);
        double &largest = expected[corner.slot * n_separations + k];
        largest =
          std::max(largest,
                   (corner.slot % 2 == 0 ? along : -along) + m.half_edge(p));
      }
  });
  Extents<dim> extents;
  extents.clear(2 * m.n);
  extents.add(m.points.view(), m.all(), directions.data());
  extents.find_largest();
  unsigned int n_found = 0;
  for (std::uint32_t slot = 0; slot < 2 * m.n; ++slot)
    for (int k = 0; k < n_separations; ++k)
      {
        const double found   = extents.largest[slot * n_separations + k];
        const double of_loop = expected[slot * n_separations + k];
        n_found += of_loop > nowhere;
        EXPECT_NEAR(found, of_loop, 1e-14 * (1 + std::abs(of_loop)))
          << "slot " << slot << ", direction " << k;
      }
  EXPECT_GT(n_found, 0u);
  EXPECT_LT(n_found, 2 * m.n * n_separations); // the last meeting has none
}



TYPED_TEST(MeetingBodies, PointsNearAFaceAreThoseOfAPlainLoop)
{
  constexpr int           dim = TestFixture::dim;
  auto                   &m   = this->meetings;
  std::vector<Faces<dim>> faces(m.n);
  // A plane through the middle of the grid, not quite the same at all nodes.
  const auto  first_normal = m.random.template vector<dim>();
  Vector<dim> middle;
  for (int d = 0; d < dim; ++d)
    middle[d] = m.grid.lower[d] + 2.5 * m.grid.edge[d];
  for (auto &face : faces)
    {
      double square = 0;
      for (int d = 0; d < dim; ++d)
        {
          face.normal[d] = first_normal[d] + 0.02 * m.random();
          square += face.normal[d] * face.normal[d];
        }
      for (double &x : face.normal)
        x /= std::sqrt(square);
      const double along = product<dim>(middle, face.normal.data());
      face.furthest = {{along + 0.02 * m.random(), -along + 0.02 * m.random()}};
    }
  std::vector<double> reach(m.points.size);
  for (std::size_t p = 0; p < reach.size(); ++p)
    reach[p] = m.half_edge(p) * m.random(0.2, 1.5);
  const double stretch = 1.2, largest_reach = 0.05;
  std::size_t  n_near = 0, n_all = 0;
  for (const bool with_reach : {false, true})
    {
      auto points = m.points.view();
      if (with_reach)
        points.reach = reach.data();
      for (const MeetingBatch &some : m.batches)
        {
          const auto face = [&](const std::uint32_t c) -> const auto &
          {
            return faces[m.corners[c].slot / 2];
          };
          double turned = 0;
          for (std::uint32_t c = some.first; c < some.last; ++c)
            {
              double square = 0;
              for (int d = 0; d < dim; ++d)
                square +=
                  std::pow(face(c).normal[d] - face(some.first).normal[d], 2);
              turned = std::max(turned, 4 * std::sqrt(square));
            }
          std::vector<std::uint32_t> expected, near;
          for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
            {
              double depth = 1e300; // to the face of the other body
              for (std::uint32_t c = some.first; c < some.last; ++c)
                {
                  const int    side = m.corners[c].slot % 2;
                  const double along =
                    product<dim>(m.points.position(p), face(c).normal.data());
                  depth = std::min(depth,
                                   -face(c).furthest[1 - side] -
                                     (side == 0 ? along : -along));
                }
              const double half_edge = m.half_edge(p);
              if (depth <= stretch * (2 * (with_reach ? reach[p] : half_edge) +
                                      largest_reach) +
                             (turned - 0.5) * half_edge)
                expected.push_back(static_cast<std::uint32_t>(p));
            }
          list_near_points<dim>(points,
                                some,
                                m.corners.data(),
                                inverse_density,
                                faces.data(),
                                stretch,
                                largest_reach,
                                near);
          EXPECT_EQ(near, expected);
          n_near += near.size();
          n_all += some.batch.end - some.batch.begin;
        }
    }
  EXPECT_GT(n_near, 0u);
  EXPECT_LT(n_near, n_all);
}



// Every third point is at the surface. The guesses of some nodes are unknown.
TYPED_TEST(MeetingBodies, FitsOfSurfacesAreThoseOfAPlainLoop)
{
  constexpr int                dim = TestFixture::dim;
  auto                        &m   = this->meetings;
  std::vector<SurfaceFit<dim>> expected;
  for (std::uint32_t slot = 0; slot < 2 * m.n; ++slot)
    expected.emplace_back(slot % 5 == 0 ? Vector<dim>() :
                                          m.random.template vector<dim>(),
                          0.3);
  auto                found = expected;
  std::vector<double> reach(m.points.size);
  for (std::size_t p = 0; p < reach.size(); p += 3)
    reach[p] = m.random(0.05, 0.2);
  auto points  = m.points.view();
  points.reach = reach.data();

  SurfacePoints<dim> surface;
  surface.find(points, m.all());
  surface.turn(points, m.grid.view(), m.corners.data(), found.data());
  for (std::size_t k = 0; k < surface.points.size(); ++k)
    surface.stretch[k] = 1 + surface.points[k] * 1e-3;
  surface.add_to_fits(points, m.grid.view(), m.corners.data(), found.data());

  std::size_t n_found = 0;
  for (const MeetingBatch &some : m.batches)
    for (std::size_t p = some.batch.begin; p < some.batch.end; ++p)
      {
        if (!(reach[p] > 0))
          continue;
        const auto value = [&](const std::uint32_t k) {
          return m.grid.shape(some.batch.cell,
                              static_cast<int>(k),
                              m.points.position(p));
        };
        Vector<dim> upwards{};
        double      square = 0;
        for (std::uint32_t c = some.first; c < some.last; ++c)
          for (int d = 0; d < dim; ++d)
            upwards[d] +=
              value(m.corners[c].k) * expected[m.corners[c].slot].guess()[d];
        for (const double component : upwards)
          square += component * component;
        ASSERT_LT(n_found, surface.points.size());
        EXPECT_EQ(surface.points[n_found], p);
        for (int d = 0; d < dim; ++d)
          EXPECT_NEAR(surface.upwards[d][n_found],
                      square > 0 ? upwards[d] / std::sqrt(square) : 0,
                      1e-13);
        ++n_found;
        if (!(square > 0))
          continue;
        const auto cell = m.grid.view().cells[some.batch.cell];
        const auto xi   = natural_place(points, cell, p);
        for (std::uint32_t c = some.first; c < some.last; ++c)
          {
            const MeetingCorner &corner = m.corners[c];
            if (corner.share < 1) // of a hanging node
              continue;
            Vector<dim> place;
            for (int d = 0; d < dim; ++d)
              place[d] =
                (xi[d] - TestFixture::Grid::Basis::power(corner.k, d)) /
                cell.inverse_edge[d];
            expected[corner.slot].add(place,
                                      reach[p] * (1 + p * 1e-3),
                                      value(corner.k));
          }
      }
  EXPECT_EQ(n_found, surface.points.size());
  EXPECT_GT(n_found, 5u);
  for (std::uint32_t slot = 0; slot < 2 * m.n; ++slot)
    for (int k = 0; k < SurfaceFit<dim>::n; ++k)
      EXPECT_NEAR(found[slot].sums[k],
                  expected[slot].sums[k],
                  1e-12 * (1 + std::abs(expected[slot].sums[0])))
        << "slot " << slot << ", sum " << k;
}



TEST(MeetingDirections, AreOfUnitLengthOrZero)
{
  Random              random;
  constexpr int       dim = 3;
  const std::size_t   n   = 4;
  std::vector<double> gradients(n * 2 * dim),
    directions(n * n_separations * dim);
  for (double &x : gradients)
    x = random();
  for (int d = 0; d < dim; ++d)
    {
      gradients[2 * dim + d]           = 0; // of a, at the second
      gradients[5 * dim + d]           = gradients[4 * dim + d]; // the third
      gradients[(2 * 3 + 1) * dim + d] = -2 * gradients[2 * 3 * dim + d];
    }
  find_directions<dim>(n, gradients.data(), directions.data());
  const auto length = [&](const std::size_t meeting, const int k) {
    double square = 0;
    for (int d = 0; d < dim; ++d)
      square +=
        std::pow(directions[(meeting * n_separations + k) * dim + d], 2);
    return std::sqrt(square);
  };
  for (std::size_t meeting = 0; meeting < n; ++meeting)
    for (int k = 0; k < n_separations; ++k)
      {
        // nothing of a; a and b in the same direction
        const bool is_zero =
          (meeting == 1 && k == 0) || (meeting == 2 && k == 2);
        EXPECT_NEAR(length(meeting, k), is_zero ? 0 : 1, 1e-15)
          << meeting << ", " << k;
      }
  for (int d = 0; d < dim; ++d)
    {
      const auto of = [&](const std::size_t meeting, const int k) {
        return directions[(meeting * n_separations + k) * dim + d];
      };
      EXPECT_GT(of(0, 0) * gradients[d], 0);       // along g_a
      EXPECT_LT(of(0, 1) * gradients[dim + d], 0); // against g_b
      // Opposite gradients of any size have one direction.
      EXPECT_NEAR(of(3, 1), of(3, 0), 1e-15);
      EXPECT_NEAR(of(3, 2), of(3, 0), 1e-15);
    }
}
