// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/adaptation/adaptation.h>

#include <gtest/gtest.h>
#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <cmath>

/**
 * @file A free elastic disk turns once while it flies through ten cells, with
 * splines. What becomes of its angular momentum:
 *
 *  - APIC hands all of it over, there and back, in every step.
 *  - FLIP applies forces at the mean places of what the nodes hold, which at
 *    the surface are not those of the nodes: an error of second order in h.
 *  - AFLIP hands over what forces bring, and all of a rigid motion. It loses
 * the torque of points that move with the grid but have another velocity.
 *  - FMPM(k) loses <x, (1 - M_full D^-1)^k p> in each step, where the functions
 *    end at the surface: of second order in h too, but for each step, so that
 *    shorter steps lose more, as they do of waves.
 *  - `usavg` takes the stress of the middle of a step at the places of its
 *    beginning. That leaves a torque dt / 2 sum of m v x a, which for a rigid
 *    rotation w is a gain of pi w dt in a turn, whatever the transfer.
 *
 * And of its size, which the spin makes swing by some per cent: whoever strains
 * points by another motion than theirs adds pi w dt to it in a turn.
 */

using namespace limber;

namespace
{
  constexpr double turning = 0.2; // rad/s; the speed of sound is 1.16 m/s
  constexpr double turn    = 2 * dealii::numbers::PI / turning; // s

  std::string
  spinning_disk(const unsigned int cells_over_radius)
  {
    const std::string cells = std::to_string(4 * cells_over_radius);
    return R"(
    set Bodies = disk
    subsection Body disk
      set Shape = ball
      subsection Ball
        set Centre = 1.5, 1.5
        set Radius = 1
      end
      set Points per cell edge = 2
      set Initial velocity = -0.2*(y - 1.5) + 0.031; 0.2*(x - 1.5) + 0.029
)" + rubber("1", "0.3") +
           R"(
      set Frame = current
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 4, 4
      set Cells = )" +
           cells + ", " + cells + R"(
    end
)" + free_sides +
           R"(    subsection Method
      set Transfer order = 4
    end)";
  }



  /**
   * About the middle of the grid. The affine part of points is C D, where
   * D = h^2 / 4 for quadratic splines and h^2 / 3 for cubic ones wherever no
   * side is near.
   */
  double
  angular_momentum(SceneRun<2> &run)
  {
    const PointView<2> points = run.points();
    const double       share =
      run.grid.description.kernel == KernelKind::cubic ? 1. / 3 : 1. / 4;
    const double h      = run.grid.smallest_edge;
    double       result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const auto x = run.position(p) - dealii::Point<2>(2, 2);
        const auto v = run.velocity(p);
        double     L = x[0] * v[1] - x[1] * v[0];
        if (points.affine[0] != nullptr)
          L += share * h * h * (points.affine[2][p] - points.affine[1][p]);
        result += points.mass[p] * L;
      }
    return result;
  }



  /** About the centre of mass, m. */
  double
  radius_of_inertia(SceneRun<2> &run)
  {
    const PointView<2>   points = run.points();
    double               mass = 0, square = 0;
    dealii::Tensor<1, 2> moment;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        mass += points.mass[p];
        moment += points.mass[p] * run.position(p);
        square += points.mass[p] * run.position(p).square();
      }
    return std::sqrt(square / mass - (moment / mass).norm_square());
  }



  struct Turn
  {
    double lost         = 0; // of the angular momentum, in one turn
    double grown        = 0; // the radius
    double largest_step = 0; // the largest change in a step
    double step         = 0; // s

    Turn(const unsigned int cells_over_radius,
         const std::string &transfer,
         const std::string &order,
         const double       courant_number = 0.4,
         const std::string &kernel         = "quadratic")
    {
      SceneRun<2>        run(spinning_disk(cells_over_radius),
                      {"Method/Kernel=" + kernel,
                              "Method/Transfer=" + transfer,
                              "Method/Stress update=" + order});
      const double       start   = angular_momentum(run);
      const double       radius  = radius_of_inertia(run);
      const unsigned int n_steps = std::ceil(
        turn / (courant_number * run.grid.smallest_edge / (1.16 + 0.24)));
      step       = turn / n_steps;
      double now = start;
      for (unsigned int n = 0; n < n_steps; ++n)
        {
          run.advance(step);
          const double before = now;
          now                 = angular_momentum(run);
          largest_step = std::max(largest_step, std::abs(now - before) / start);
        }
      lost  = 1 - now / start;
      grown = radius_of_inertia(run) / radius - 1;
      std::printf("%s, %s, %u cells over the radius, %u steps: lost %.5f, "
                  "grown %.5f\n",
                  transfer.c_str(),
                  order.c_str(),
                  cells_over_radius,
                  n_steps,
                  lost,
                  grown);
    }
  };
} // namespace



TEST(SpinningDisk, ApicKeepsAngularMomentum)
{
  for (const std::string kernel : {"quadratic", "cubic"})
    for (const std::string order : {"usl", "musl"})
      {
        SCOPED_TRACE(kernel + ", " + order);
        const Turn one(10, "apic", order, 0.4, kernel);
        EXPECT_LT(one.largest_step, 1e-12);
        EXPECT_LT(std::abs(one.lost), 1e-12);
      }
}



// So the nodes turn as the disk does, however little of it they see, and the
// first step takes nothing from it. Without the slopes it is 4 %.
TEST(SpinningDisk, ApicStartsWithTheSlopesOfTheInitialVelocity)
{
  SceneRun<2> run(spinning_disk(5),
                  {"Method/Kernel=quadratic",
                   "Method/Transfer=apic",
                   "Method/Stress update=musl"});
  const auto  kinetic_energy = [&]() {
    const PointView<2> points = run.points();
    double             result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      result += 0.5 * points.mass[p] * run.velocity(p).norm_square();
    return result;
  };
  const PointView<2> points   = run.points();
  const double       slopes[] = {0, -turning, turning, 0};
  for (std::size_t p = 0; p < points.size; ++p)
    for (int k = 0; k < 4; ++k)
      ASSERT_NEAR(points.affine[k][p], slopes[k], 1e-12 * turning);

  const double before = kinetic_energy();
  run.advance(1e-6);
  EXPECT_NEAR(kinetic_energy(), before, 1e-9 * before);
}



TEST(SpinningDisk, AflipKeepsItInARigidStep)
{
  for (const std::string kernel : {"quadratic", "cubic"})
    for (const std::string order : {"usl", "musl"})
      {
        SCOPED_TRACE(kernel + ", " + order);
        SceneRun<2>  run(spinning_disk(5),
                        {"Method/Kernel=" + kernel,
                          "Method/Transfer=aflip",
                          "Method/Stress update=" + order});
        const double start = angular_momentum(run);
        run.advance(0.1);
        EXPECT_NEAR(angular_momentum(run), start, 1e-13 * start);
      }
}



TEST(SpinningDisk, AflipLosesATenthOfWhatFlipDoes)
{
  EXPECT_LT(std::abs(Turn(10, "aflip", "musl").lost),
            0.1 * std::abs(Turn(10, "flip", "musl").lost));
}



TEST(SpinningDisk, FlipLosesItToSecondOrder)
{
  std::vector<double> lost;
  for (const unsigned int n : {5u, 10u, 20u})
    lost.push_back(Turn(n, "flip", "musl").lost);
  EXPECT_GT(lost[0] / lost[1], 3);
  EXPECT_GT(lost[1] / lost[2], 3);
  EXPECT_LT(lost[1], 0.02);
}



TEST(SpinningDisk, FmpmLosesItToSecondOrderInEachStep)
{
  const double coarse = Turn(5, "fmpm", "usl").lost;
  const double fine   = Turn(10, "fmpm", "usl").lost;
  EXPECT_GT(coarse / fine, 3);
  const double short_steps = Turn(10, "fmpm", "usl", 0.2).lost;
  EXPECT_NEAR(short_steps / fine, 2, 0.2);
}



TEST(SpinningDisk, BothEndsGainItToFirstOrderInTime)
{
  for (const double courant_number : {0.4, 0.2})
    {
      const Turn   one(10, "apic", "usavg", courant_number);
      const double expected = dealii::numbers::PI * turning * one.step;
      EXPECT_NEAR(-one.lost, expected, 0.2 * expected);
    }
}



TEST(SpinningDisk, TheSizeDoesNotDependOnTheStep)
{
  for (const std::string order : {"usf", "usl", "musl"})
    {
      SCOPED_TRACE(order);
      const Turn   coarse(10, "flip", order), fine(10, "flip", order, 0.2);
      const double drift =
        dealii::numbers::PI * turning * (coarse.step - fine.step);
      EXPECT_LT(std::abs(coarse.grown - fine.grown), 0.1 * drift);
    }
}



// Across cells of two sizes as well: what hanging nodes have of the affine
// velocities belongs to the places of their masters. Stiff ones as well, whose
// points come into cells with a hanging node that is as light as its master.
namespace
{
  template <int dim>
  void
  expect_apic_turns_across_levels(const std::string &young,
                                  const double       turning,
                                  const double       end)
  {
    SCOPED_TRACE(std::to_string(dim) + "d, E = " + young);
    const std::string middle = dim == 2 ? "0.6, 0.6" : "0.6, 0.6, 0.3",
                      box    = dim == 2 ? "1.2, 1.2" : "1.2, 1.2, 0.6",
                      cells  = dim == 2 ? "24, 24" : "12, 12, 6",
                      third  = dim == 2 ? "" : "; 0";
    SceneRun<dim> run("set Dimension = " + std::to_string(dim) + R"(
    set Bodies = disk
    subsection Body disk
      set Shape = ball
      subsection Ball
        set Centre = )" +
                      middle +
                      R"(
        set Radius = 0.29
      end
      set Initial velocity = )" +
                      digits(turning) + "*(0.6 - y); " + digits(turning) +
                      "*(x - 0.6)" + third + "\n" + rubber(young, "0.3") + R"(
      set Frame = current
    end
    subsection Grid
      set Upper corner = )" +
                      box + "\n set Cells = " + cells + R"(
      set Levels = 1
      set Refine = half
      subsection Refine half
        set Where = 0.6 - x
      end
    end
)" + free_sides + R"(    subsection Method
      set Transfer = apic
    end)");
    ASSERT_FALSE(run.grid.vertices.hanging.empty());
    const double    start = run.totals().all.kinetic_energy;
    Adaptation<dim> adaptation(run.problem, run.grid, run.bodies);
    double          former = 0;
    run.advance_to(end, [&]() {
      const double way = turning * 0.29 * (run.time - former);
      former           = run.time;
      if (adaptation.is_due(way / run.grid.smallest_edge) &&
          adaptation.adapt(run.time, typename Adaptation<dim>::KeptPoints(1)))
        run.integrator.reinit();
    });
    EXPECT_NEAR(run.totals().all.kinetic_energy, start, 2e-3 * start);
    EXPECT_NEAR(run.totals().energy_drift, 0, 1e-3);
    EXPECT_LT(run.totals().momentum_error, 1e-12);
  }
} // namespace

TEST(SpinningDisk, ApicTurnsAcrossLevels)
{
  expect_apic_turns_across_levels<2>("1e5", 1, 0.3);
  expect_apic_turns_across_levels<3>("1e5", 1, 0.3);
  expect_apic_turns_across_levels<2>("1e4", 3, 0.7);
}
