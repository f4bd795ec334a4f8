// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file A rubber disk of ten cells over its radius flies through a hundred
 * cells and turns once on its way. With quadratic splines and 3 x 3 points its
 * shape, its energy and its angular momentum stay within one percent.
 */

using namespace limber;

namespace
{
  constexpr double disk_spin   = 0.05; // rad/s; radius 1 m, E = 1 Pa
  constexpr double disk_flight = 2 * dealii::numbers::PI / disk_spin; // s

  const std::string rubber_disk = R"(
    set Bodies = disk
    subsection Body disk
      set Shape = ball
      subsection Ball
        set Centre = 1.5, 1.53
        set Radius = 1
      end
      set Points per cell edge = 3
      set Constants = w = 0.05
      set Initial velocity = w*(10/(2*pi) - y + 1.53); w*(0.3/(2*pi) + x - 1.5)
)" + rubber("1", "0.45") + R"(
      set Frame = current
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 13, 3.4
      set Cells = 130, 34
    end
)" + free_sides + R"(    subsection Method
      set Kernel = quadratic
      set Transfer = flip
      set Stress update = usavg
    end)";



  struct SpinningBody
  {
    dealii::Point<2>     centre;
    dealii::Tensor<1, 2> velocity;
    double               energy           = 0; // J, in all
    double               angular_momentum = 0; // about the centre
  };



  SpinningBody
  observe(SceneRun<2> &run)
  {
    const auto   totals = run.totals();
    SpinningBody result;
    result.centre             = dealii::Point<2>(totals.centre_of_mass);
    result.velocity           = totals.all.momentum / totals.all.mass;
    result.energy             = totals.all.total_energy();
    const PointView<2> points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const auto r = run.position(p) - result.centre;
        const auto v = run.velocity(p) - result.velocity;
        result.angular_momentum += points.mass[p] * (r[0] * v[1] - r[1] * v[0]);
      }
    return result;
  }



  /**
   * The largest distance of a point from where it would be, had the body as it
   * was at first only moved and turned by the angle that suits best.
   */
  double
  largest_deviation(const std::vector<dealii::Point<2>> &before,
                    const dealii::Point<2>              &old_centre,
                    const std::vector<dealii::Point<2>> &after,
                    const dealii::Point<2>              &centre)
  {
    double cosine = 0, sine = 0;
    for (std::size_t p = 0; p < before.size(); ++p)
      {
        const auto X = before[p] - old_centre, x = after[p] - centre;
        cosine += X * x;
        sine += X[0] * x[1] - X[1] * x[0];
      }
    const double norm = std::hypot(cosine, sine);
    cosine /= norm;
    sine /= norm;
    double result = 0;
    for (std::size_t p = 0; p < before.size(); ++p)
      {
        const auto                 X = before[p] - old_centre;
        const dealii::Tensor<1, 2> turned(
          {cosine * X[0] - sine * X[1], sine * X[0] + cosine * X[1]});
        result = std::max(result, (after[p] - centre - turned).norm());
      }
    return result;
  }
} // namespace



TEST(RubberDisk, KeepsShapeEnergyAndAngularMomentumThroughAHundredCells)
{
  SceneRun<2> run(rubber_disk);
  const auto  places = run.positions();
  const auto  start  = observe(run);
  run.advance_to(disk_flight);
  const auto end = observe(run);
  EXPECT_LT((end.centre - start.centre - disk_flight * start.velocity).norm(),
            1e-9);

  const double rotation = 0.5 * start.angular_momentum * disk_spin; // J
  const double moved =
    largest_deviation(places, start.centre, run.positions(), end.centre);
  std::printf("deviation %.5f of the radius, energy %+.5f of that of the "
              "rotation, angular momentum %+.5f\n",
              moved,
              (end.energy - start.energy) / rotation,
              end.angular_momentum / start.angular_momentum - 1);
  EXPECT_LT(moved, 0.01);
  EXPECT_NEAR(end.energy, start.energy, 0.01 * rotation);
  EXPECT_NEAR(end.angular_momentum,
              start.angular_momentum,
              0.01 * start.angular_momentum);
}
