// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>
#include <limber/adaptation/joining.h>

#include <gtest/gtest.h>
#include <support/scene_run.h>

#include <random>

/** @file Points that become one: what stays, and the energy that goes. */

using namespace limber;

namespace
{
  /** A block of which a strip is fine until t = 1; see FollowsARegion... */
  template <int dim>
  std::string
  block_once_fine()
  {
    const auto all = [](const std::string &value) {
      return dim == 2 ? value + ", " + value :
                        value + ", " + value + ", " + value;
    };
    return "set Dimension = " + std::to_string(dim) +
           "\nset Bodies = block\nsubsection Body block\n"
           "subsection Box\nset Lower corner = " +
           all("0.5") + "\nset Upper corner = " + all("3.5") +
           "\nend\nsubsection Linear elastic\nset Density = 2\n"
           "set Young's modulus = 1\nend\nend\n"
           "subsection Grid\nset Upper corner = " +
           all("4") + "\nset Cells = " + all("8") +
           "\nset Levels = 2\nset Join points = true\nset Refine = part\n"
           "subsection Refine part\nset Where = 1 - t + 0*x\nend\nend\n"
           "subsection Loads\nset Gravity = 0, 0" +
           (dim == 3 ? ", 0" : "") + "\nend\n";
  }



  template <int dim>
  struct Sums
  {
    double                 mass = 0, kinetic = 0, strain = 0;
    dealii::Tensor<1, dim> momentum, first;
  };

  template <int dim>
  Sums<dim>
  sums_of(SceneRun<dim> &run)
  {
    Sums<dim>            result;
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        result.mass += points.mass[p];
        result.kinetic += 0.5 * points.mass[p] * run.velocity(p).norm_square();
        result.momentum += points.mass[p] * run.velocity(p);
        result.first +=
          points.mass[p] * dealii::Tensor<1, dim>(run.position(p));
      }
    result.strain = run.bodies[0]->stress->summarize(points).strain_energy;
    return result;
  }



  /** Velocity with a gradient and noise, by the speed of sound. */
  template <int dim>
  void
  move_points(SceneRun<dim> &run, const double noise)
  {
    std::mt19937         random(5);
    const auto           draw   = [&]() { return random() / 2147483648. - 1; };
    const PointView<dim> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        for (int d = 0; d < dim; ++d)
          points.velocity[d][p] =
            0.2 + 0.1 * points.position[0][p] * (d == 1) + noise * draw();
        points.pressure[p] = 0.1 + 0.3 * noise * draw();
      }
  }



  // All fine, then nothing is: as often as it takes.
  template <int dim>
  void
  expect_closed_balance()
  {
    SCOPED_TRACE(dim);
    SceneRun<dim>   run(block_once_fine<dim>(), {"Body block/Frame=current"});
    Adaptation<dim> adaptation(run.problem, run.grid, run.bodies);
    const typename Adaptation<dim>::KeptPoints kept = {
      {run.bodies[0]->points.id(7)}};
    const std::size_t n_fine = run.points().size;
    move_points(run, 1e-4);
    const Sums<dim> before  = sums_of(run);
    double          removed = 0;
    for (unsigned int k = 0; k < 8; ++k)
      {
        if (adaptation.adapt(2, kept))
          run.integrator.reinit();
        EXPECT_GE(adaptation.energy_removed(), -1e-15 * before.kinetic);
        removed += adaptation.energy_removed();
      }
    const Sums<dim>   after   = sums_of(run);
    const std::size_t n_after = run.points().size;
    EXPECT_LT(n_after, n_fine / 2);
    EXPECT_EQ(n_after, n_fine - adaptation.state().points_joined);
    EXPECT_NEAR(after.mass, before.mass, 1e-13 * before.mass);
    EXPECT_LT((after.momentum - before.momentum).norm(),
              1e-13 * before.momentum.norm());
    EXPECT_LT((after.first - before.first).norm(), 1e-13 * before.first.norm());
    const double all = before.kinetic + before.strain;
    EXPECT_NEAR(after.kinetic + after.strain + removed, all, 1e-12 * all);
    EXPECT_GT(removed, 1e-9 * all);
    // The kept one is still there and as fine as it was.
    bool found = false;
    for (std::size_t p = 0; p < n_after; ++p)
      if (kept[0].count(run.bodies[0]->points.id(p)) > 0)
        {
          found = true;
          EXPECT_EQ(run.bodies[0]->points.size_class(p), 2u);
        }
    EXPECT_TRUE(found);
    // Numbers are their own.
    std::vector<std::uint64_t> ids = run.bodies[0]->points.all_ids();
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
  }
} // namespace



TEST(Joining, LosesWhatItSays)
{
  expect_closed_balance<2>();
  expect_closed_balance<3>();
}



// Four points by hand: mass, momentum and centre of mass stay, and the energy
// that goes is 1/2 sum m |v - V|^2.
TEST(Joining, OfFourPointsLosesTheirRelativeMotion)
{
  SceneRun<2>        run(block_once_fine<2>(), {"Body block/Frame=current"});
  auto              &body   = *run.bodies[0];
  const PointView<2> points = run.points();
  std::vector<std::size_t> set;
  for (std::size_t p = 0; p < points.size && set.size() < 4; ++p)
    if (points.cell[p] == points.cell[0])
      set.push_back(p);
  ASSERT_EQ(set.size(), 4u);
  const double u[4] = {1, -2, 3, 0.5}, m[4] = {1, 2, 3, 4};
  double       mass = 0, momentum = 0, first = 0, energy = 0;
  for (unsigned int i = 0; i < 4; ++i)
    {
      points.velocity[0][set[i]] = u[i];
      points.velocity[1][set[i]] = 0;
      points.mass[set[i]]        = m[i];
      mass += m[i];
      momentum += m[i] * u[i];
      first += m[i] * points.position[1][set[i]];
    }
  for (unsigned int i = 0; i < 4; ++i)
    energy += 0.5 * m[i] * std::pow(u[i] - momentum / mass, 2);
  const std::uint64_t id = body.points.id(set[0]);
  EXPECT_NEAR(join({set}, body), energy, 1e-12 * energy);
  for (std::size_t p = 0; p < run.points().size; ++p)
    if (body.points.id(p) == id)
      {
        EXPECT_EQ(body.points.size_class(p), 1u);
        EXPECT_DOUBLE_EQ(run.points().mass[p], mass);
        EXPECT_NEAR(run.velocity(p)[0], momentum / mass, 1e-15);
        EXPECT_NEAR(run.position(p)[1], first / mass, 1e-15);
      }
}



// Uneven motion, uneven stress, a surface and another body forbid it.
TEST(Joining, IsRefusedWhereItWouldChangeMuch)
{
  const auto joined_with = [](const double noise, const double stress) {
    SceneRun<2>   run(block_once_fine<2>(), {"Body block/Frame=current"});
    Adaptation<2> adaptation(run.problem, run.grid, run.bodies);
    move_points(run, noise);
    const PointView<2> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      if (p % 2 == 0)
        points.pressure[p] *= 1 + stress;
    for (unsigned int k = 0; k < 4; ++k)
      if (adaptation.adapt(2, {{}}))
        run.integrator.reinit();
    // None at the surface, whatever the motion
    std::size_t fine_at_surface = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      if (run.position(p)[0] < 0.74)
        {
          ++fine_at_surface;
          EXPECT_GT(run.bodies[0]->points.size_class(p), 0u);
        }
    EXPECT_GT(fine_at_surface, 0u);
    return adaptation.state().points_joined;
  };
  EXPECT_GT(joined_with(1e-4, 0), 0u);
  EXPECT_EQ(joined_with(1e-2, 0), 0u);
  EXPECT_EQ(joined_with(1e-4, 0.2), 0u);
}
