// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>

#include <gtest/gtest.h>
#include <support/touching_bodies.h>

/**
 * @file Bodies on rigid obstacles: against closed formulas of sliding, rolling,
 * weight and work, and where the grid lies between them.
 */

using namespace limber;
using namespace limber::touching;

namespace
{
  // 1 m x 0.5 m upon a slope of 30 degrees across the grid
  const std::string block_on_slope = soft_block + free_sides + R"(
    set Bodies = block
    set Obstacles = slope
    subsection Body block
      set Shape = block
      set Placement = fitted
      subsection Block
        set Corners = 0.6, 2.4; 1.466025403784439, 1.9; 1.716025403784439, 2.333012701892219; 0.85, 2.833012701892219
      end
    end
    subsection Obstacle slope
      set Shape = half-space
      set Law = friction
      set Friction coefficient = 0.3
      set Centre = 0.6, 2.4
      subsection Half-space
        set Point = 0.6, 2.4
        set Normal = 0.5, 0.866025403784439
      end
    end
    subsection Grid
      set Upper corner = 3, 3
      set Cells = 48, 48
    end
    subsection Loads
      set Gravity = 0, -9.81
    end
    subsection Method
      set Blend time = 0.01
    end)";

  // 1 m x 0.5 m above a floor
  const std::string block_alone = soft_block + free_sides + R"(
    set Bodies = block
    subsection Body block
      subsection Box
        set Lower corner = 0.5, 0.5
        set Upper corner = 1.5, 1
      end
    end
    subsection Grid
      set Upper corner = 2, 1.5
      set Cells = 16, 12
    end)";

  const std::string block_over_floor = block_alone + R"(
    set Obstacles = floor
    subsection Obstacle floor
      set Shape = half-space
      subsection Half-space
        set Point = 0, 0.5
      end
    end)";

  // 10 cells of radius on the same slope
  const std::string disc_on_slope = free_sides + R"(
    set Bodies = disc
    set Obstacles = slope
    subsection Body disc
      set Shape = ball
      subsection Ball
        set Centre = 0.75, 2.25
        set Radius = 0.5
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e7
        set Poisson's ratio = 0.3
      end
    end
    subsection Obstacle slope
      set Shape = half-space
      set Law = friction
      set Friction coefficient = 0.3
      subsection Half-space
        set Point = 0.5, 1.816987298107781
        set Normal = 0.5, 0.866025403784439
      end
    end
    subsection Grid
      set Upper corner = 3, 3
      set Cells = 60, 60
    end
    subsection Loads
      set Gravity = 0, -9.81
    end)";



  dealii::Tensor<1, 2>
  down_the_slope()
  {
    return dealii::Point<2>(std::cos(slope), -std::sin(slope));
  }



  dealii::Tensor<1, 2>
  off_the_slope()
  {
    return dealii::Point<2>(std::sin(slope), std::cos(slope));
  }



  /** About the centre of mass, kg m^2/s. */
  double
  spin_of(SceneRun<2> &run)
  {
    const auto totals = run.totals();
    const auto points = run.points();
    const auto centre = totals.centre_of_mass;
    double     result = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      {
        const auto arm = run.position(p) - centre;
        const auto v   = run.velocity(p);
        result += points.mass[p] * (arm[0] * v[1] - arm[1] * v[0]);
      }
    return result;
  }



  // a = g (sin - mu cos), whatever the directions of the cells; while the block
  // swings up and down, mu m g cos is mu (m g cos + dp_n / dt).
  void
  expect_sliding(const double friction, const std::vector<std::string> &variant)
  {
    SceneRun<2> run(block_on_slope, variant);
    run.advance_to(0.1); // what follows on the sudden start
    const auto start = run.totals();
    run.advance_to(0.4);
    const auto   end  = run.totals();
    const auto   gain = (end.all.momentum - start.all.momentum) / 500;
    const double a    = sliding_acceleration(friction);
    EXPECT_NEAR(
      (gain * down_the_slope() + friction * (gain * off_the_slope())) / 0.3,
      a,
      0.02 * a);
    EXPECT_NEAR(end.energy_drift, 0, 0.002);
    EXPECT_LT(end.momentum_error, 1e-12);
  }
} // namespace



TEST(ObstacleContact, ABlockSlidesAcrossTheGrid)
{
  for (const std::string order : {"musl", "usavg"})
    for (const double friction : {0.1, 0.3})
      {
        SCOPED_TRACE(order + " " + digits(friction));
        expect_sliding(friction,
                       {"Method/Stress update=" + order,
                        "Obstacle slope/Friction coefficient=" +
                          digits(friction)});
      }
}



// The same with the other kernels, whose nodes lie elsewhere and reach further.
TEST(ObstacleContact, ABlockSlidesWithAnyKernel)
{
  for (const std::string kernel :
       {"quadratic", "cubic", "gimp", "cpgimp", "cpdi", "cpdi2", "ddmp"})
    {
      SCOPED_TRACE(kernel);
      expect_sliding(0.3, {"Method/Kernel=" + kernel});
    }
}



// The same where the velocities that it takes are filtered (FMPM and XPIC), in
// steps that are short enough for the corners that the grid cuts off.
TEST(ObstacleContact, ABlockSlidesWithAFilter)
{
  for (const std::string transfer : {"fmpm", "xpic"})
    {
      SCOPED_TRACE(transfer);
      expect_sliding(0.3,
                     {"Method/Transfer=" + transfer,
                      "Method/Blend time=0",
                      "Method/Courant number=0.2",
                      "Method/Kernel=quadratic"});
    }
}



// With more friction than tan 30 degrees it stays where it is, once it does not
// bounce any more; with 4 % more, here.
TEST(ObstacleContact, ABlockRestsOnASlope)
{
  SceneRun<2> run(block_on_slope,
                  {"Obstacle slope/Friction coefficient=0.6",
                   "Method/Damping rate=20"});
  run.advance_to(0.6);
  const auto start = run.totals();
  run.advance_to(0.8);
  const auto   end = run.totals();
  const double way =
                 (end.centre_of_mass - start.centre_of_mass) * down_the_slope(),
               free = 0.5 * 9.81 * std::sin(slope) * 0.04;
  EXPECT_LT(std::abs(way), 1e-3 * free);
}



// Friction of 0.6 holds on 30 degrees (0.577), while the weight comes on and
// with a margin of four per cent afterwards. The sheared block is 2.4 mm
// further down (with sticking contact 1.4 mm: friction does not hold its ends
// at first). Impulses that are not converged let a block with splines slide.
TEST(ObstacleContact, ABlockWithSplinesStaysOnASlope)
{
  SceneRun<2>  run(R"(
    set Bodies = block
    set Obstacles = floor
    subsection Body block
      subsection Box
        set Lower corner = 0.5, 0.5
        set Upper corner = 1.5, 1
      end
      set Material = linear elastic
    end
    subsection Obstacle floor
      set Shape = half-space
      subsection Half-space
        set Point  = 0, 0.5
        set Normal = 0, 1
      end
      set Law = friction
      set Friction coefficient = 0.6
    end
    subsection Grid
      set Upper corner = 4, 1.5
      set Cells = 64, 24
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end
    subsection Loads
      set Body force = 4.905*0.5*(1 - cos(pi*min(t, 1))); -8.495709*0.5*(1 - cos(pi*min(t, 1)))
    end
    subsection Method
      set Kernel = quadratic
    end
    )");
  const double start = run.totals().centre_of_mass[0];
  run.advance_to(1.5);
  const auto end = run.totals();
  EXPECT_NEAR(end.centre_of_mass[0] - start, 2.4e-3, 0.2e-3);
  EXPECT_LT(end.all.kinetic_energy, 0.01); // J
}



// Nor does it need a damping rate where its weight comes on slowly, with 13 %
// more friction than it needs.
TEST(ObstacleContact, ABlockRestsUnderAWeightThatGrows)
{
  for (const std::string kernel : {"linear", "quadratic"})
    {
      SCOPED_TRACE(kernel);
      SceneRun<2> run(block_on_slope,
                      {"Method/Kernel=" + kernel,
                       "Obstacle slope/Friction coefficient=0.65",
                       "Loads/Gravity=0, 0",
                       "Loads/Body force=0; -9.81*min(1, t/0.4)"});
      run.advance_to(0.6);
      const auto start = run.totals();
      run.advance_to(0.8);
      const auto   end = run.totals();
      const double way = (end.centre_of_mass - start.centre_of_mass) *
                         down_the_slope(),
                   free = 0.5 * 9.81 * std::sin(slope) * 0.04;
      EXPECT_LT(std::abs(way), 1e-3 * free);
    }
}



// What the floor bears is the weight, and it bears it below the middle.
TEST(ObstacleContact, TheFloorBearsTheWeight)
{
  SceneRun<2> run(block_over_floor,
                  {"Loads/Gravity=0, -1",
                   "Obstacle floor/Law=stick",
                   "Method/Damping rate=20"});
  run.advance_to(1.5);
  const auto before = run.totals();
  run.advance_to(2);
  const auto now = run.totals();
  EXPECT_NEAR((now.obstacles[0].impulse - before.obstacles[0].impulse)[1] / 0.5,
              500,
              0.5);
  EXPECT_NEAR((now.obstacles[0].impulse - before.obstacles[0].impulse)[0] / 0.5,
              0,
              1);
  // about the corner of the grid
  EXPECT_NEAR((now.obstacles[0].moment - before.obstacles[0].moment)[2] / 0.5,
              500,
              2);
}



// Wherever its surface lies within a cell and whatever points it has, the block
// comes to rest with this surface on the floor.
TEST(ObstacleContact, NoGapIsLeft)
{
  for (const std::string frame_and_kernel : {"current linear",
                                             "current quadratic",
                                             "current cubic",
                                             "initial linear",
                                             "initial quadratic"})
    for (const double shift : {0., 0.25, 0.5, 0.75})
      {
        SCOPED_TRACE(frame_and_kernel + " " + digits(shift));
        const auto frame  = frame_and_kernel.substr(0, 7),
                   kernel = frame_and_kernel.substr(8);
        const double h = 0.125, face = 0.5 + shift * h;
        SceneRun<2>  run(
          block_over_floor,
          {"Method/Kernel=" + kernel,
            "Body block/Frame=" + frame,
            "Body block/Points per cell edge=2",
            "Body block/Box/Lower corner=0.5, " + digits(face + 0.3 * h),
            "Body block/Box/Upper corner=1.5, " + digits(face + 0.3 * h + 0.5),
            "Obstacle floor/Half-space/Point=0, " + digits(face),
            "Method/Damping rate=10",
            "Loads/Gravity=0, -1"});
        const double depth = lowest(run, 0, 1) - (face + 0.3 * h);
        run.advance_to(2);
        EXPECT_NEAR((lowest(run, 0, 1) - face - depth) / h, 0, 0.005);
      }
}



// Water stands in a basin around a step whose faces are faces of cells. Its
// corners, where three quarters of the cells around hold water, bear the
// pressure as its faces do: without that it pours into them, 60 J of 4844 J.
TEST(ObstacleContact, WaterRestsAroundAStep)
{
  for (const std::string points : {"2", "3", "5"})
    {
      SCOPED_TRACE(points + " points along an edge");
      SceneRun<2> run(R"(
        set Bodies = water
        set Obstacles = step
        subsection Body water
          set Shape = formula
          subsection Formula
            set Inside = min(1 - y, max(abs(x - 0.5) - 0.125, y - 0.25))
            set Upper corner = 1, 1
          end
          set Initial pressure = hydrostatic
          set Material = newtonian fluid
          subsection Newtonian fluid
            set Density = 1000
            set Bulk modulus = 1e6
          end
        end
        subsection Obstacle step
          set Shape = box
          subsection Box
            set Lower corner = 0.375, -1
            set Upper corner = 0.625, 0.25
          end
        end
        subsection Grid
          set Upper corner = 1, 1.5
          set Cells = 8, 12
        end
        subsection Loads
          set Gravity = 0, -9.81
        end)",
                      {"Body water/Points per cell edge=" + points});
      double      largest = 0;
      run.advance_to(1, [&]() {
        largest = std::max(largest, run.totals().all.kinetic_energy);
      });
      EXPECT_LT(largest, 0.1);
      // the weight of the water over the step, but for the corners
      const auto before = run.totals();
      run.advance_to(1.5);
      EXPECT_NEAR((run.totals().obstacles[0].impulse -
                   before.obstacles[0].impulse)[1] /
                    0.5,
                  1000 * 9.81 * 0.75 * 0.25,
                  0.02 * 1000 * 9.81 * 0.75 * 0.25);
    }
}



// In the initial frame the disc rolls as well, with a law for large rotation;
// nothing crosses cells and the energy stays.
TEST(ObstacleContact, ADiscRollsInItsInitialFrame)
{
  const double a = 2. / 3 * 9.81 * std::sin(slope);
  for (const std::string kernel : {"linear", "quadratic"})
    {
      SCOPED_TRACE(kernel);
      SceneRun<2> run(disc_on_slope,
                      {"Method/Kernel=" + kernel,
                       "Body disc/Frame=initial",
                       "Body disc/Material=neo hookean",
                       "Body disc/Neo hookean/Density=1000",
                       "Body disc/Neo hookean/Young's modulus=1e7",
                       "Body disc/Neo hookean/Poisson's ratio=0.3"});
      run.advance_to(0.1);
      const auto start = run.totals();
      run.advance_to(0.7);
      const auto   end    = run.totals();
      const double rolled = (end.all.momentum - start.all.momentum) /
                            end.all.mass * down_the_slope() / 0.6;
      RecordProperty("rolled with " + kernel, digits(rolled / a));
      EXPECT_NEAR(rolled, a, 0.05 * a);
      EXPECT_NEAR(end.energy_drift, 0, 1e-4);
      EXPECT_LT(end.momentum_error, 1e-12);
    }
}



// It rolls where friction suffices, as fast as it turns, with 2/3 g sin, less
// a resistance that cells of a tenth of its radius have. A blend time would
// brake the turning as well.
TEST(ObstacleContact, ADiscRolls)
{
  const double radius = 0.5, a = 2. / 3 * 9.81 * std::sin(slope);
  for (const std::string kernel : {"linear", "quadratic", "cubic"})
    {
      SCOPED_TRACE(kernel);
      SceneRun<2> run(disc_on_slope, {"Method/Kernel=" + kernel});
      run.advance_to(0.1);
      const auto   start = run.totals();
      const double spun  = spin_of(run);
      run.advance_to(0.7);
      const auto   end    = run.totals();
      const double mass   = end.all.mass;
      const double rolled = (end.all.momentum - start.all.momentum) / mass *
                            down_the_slope() / 0.6,
                   turned = (spun - spin_of(run)) / (0.5 * mass * radius) / 0.6;
      RecordProperty("rolled with " + kernel, digits(rolled / a));
      EXPECT_NEAR(rolled, a, 0.1 * a);
      EXPECT_NEAR(rolled, turned, 0.1 * rolled);
    }
}



// A block that has been taken along by a wall has the wall's velocity and
// energy, which is the work of the wall; some is lost in the impact.
TEST(ObstacleContact, AWallTakesABlockAlong)
{
  SceneRun<2> run(block_over_floor,
                  {"Obstacle floor/Half-space/Point=0.49, 0",
                   "Obstacle floor/Half-space/Normal=1, 0",
                   "Obstacle floor/Displacement=0.5*t; 0",
                   "Method/Blend time=0.01"});
  run.advance_to(0.9);
  const auto totals = run.totals();
  EXPECT_GT(totals.all.momentum[0], 0.499 * 500);
  EXPECT_NEAR(totals.boundary_work,
              totals.obstacles[0].impulse[0] * 0.5,
              1e-9 * totals.boundary_work);
  EXPECT_NEAR(totals.energy_drift, 0, 0.002);
  EXPECT_LT(totals.momentum_error, 1e-12);
}



// What the filter of FMPM and XPIC would give back of the approach is an
// impulse of the wall as well, and does work.
TEST(ObstacleContact, AWallTakesAFilteredBlockAlong)
{
  for (const std::string transfer : {"fmpm", "xpic"})
    {
      SCOPED_TRACE(transfer);
      SceneRun<2> run(block_over_floor,
                      {"Obstacle floor/Half-space/Point=0.49, 0",
                       "Obstacle floor/Half-space/Normal=1, 0",
                       "Obstacle floor/Displacement=0.5*t; 0",
                       "Method/Transfer=" + transfer,
                       "Method/Kernel=quadratic"});
      run.advance_to(0.3);
      const auto totals = run.totals();
      EXPECT_GT(totals.all.momentum[0], 0.45 * 500);
      EXPECT_NEAR(totals.all.momentum[0],
                  totals.obstacles[0].impulse[0],
                  1e-9 * totals.all.momentum[0]);
      EXPECT_NEAR(totals.boundary_work,
                  totals.obstacles[0].impulse[0] * 0.5,
                  1e-9 * totals.boundary_work);
      EXPECT_NEAR(totals.energy_drift, 0, 0.005);
      EXPECT_LT(totals.momentum_error, 1e-12);
    }
}



// A bar that flies at it, or an obstacle that flies at the bar: the same,
// seen from another place, where both meet the grid alike.
TEST(ObstacleContact, OnlyRelativeMotionCounts)
{
  const auto run_with = [](const std::vector<std::string> &more) {
    std::vector<std::string> all = {"Obstacle floor/Half-space/Point=0.49, 0",
                                    "Obstacle floor/Half-space/Normal=1, 0",
                                    "Method/Time step=1e-4"};
    all.insert(all.end(), more.begin(), more.end());
    return std::make_unique<SceneRun<2>>(block_over_floor, all);
  };
  const auto flies  = run_with({"Body block/Initial velocity=-0.5; 0"});
  const auto pushed = run_with({"Obstacle floor/Displacement=0.5*t; 0"});
  flies->advance(1e-4, 600);
  pushed->advance(1e-4, 600);
  const double rebound = flies->totals().all.momentum[0] + 250,
               push    = pushed->totals().all.momentum[0];
  EXPECT_GT(rebound, 100);
  EXPECT_NEAR(push, rebound, 0.03 * rebound);
}



// Nothing of the run is different with an obstacle that nobody touches.
TEST(ObstacleContact, OneThatIsFarDoesNothing)
{
  for (const std::string order : {"musl", "usavg"})
    {
      const std::vector<std::string> alone = {
        "Method/Stress update=" + order,
        "Body block/Initial velocity=0.1*y; 0.2*x"};
      auto with = alone;
      with.push_back("Obstacle floor/Half-space/Point=0, 0.1");
      SceneRun<2> one(block_over_floor, with), other(block_alone, alone);
      one.advance(1e-3, 50);
      other.advance(1e-3, 50);
      const auto p = one.positions(), q = other.positions();
      for (std::size_t k = 0; k < p.size(); ++k)
        EXPECT_EQ(p[k], q[k]);
    }
}



namespace
{
  /** Fine cells in a part of the grid. */
  std::vector<std::string>
  fine_where(const std::string &formula)
  {
    return {"Grid/Levels=1",
            "Grid/Refine=part",
            "Grid/Refine part/Where=" + formula};
  }
} // namespace



// Nodes hang in the middle of what the floor bears: force, moment, momentum
// and energy are those of their masters.
TEST(ObstacleContact, TheFloorBearsTheWeightOnTwoSizesOfCells)
{
  auto settings = fine_where("0.9 - x");
  settings.insert(settings.end(),
                  {"Loads/Gravity=0, -1",
                   "Obstacle floor/Law=stick",
                   "Method/Damping rate=20"});
  SceneRun<2> run(block_over_floor, settings);
  EXPECT_FALSE(run.grid.vertices.hanging.empty());
  run.advance_to(1.5);
  const auto before = run.totals();
  run.advance_to(2);
  const auto now     = run.totals();
  const auto impulse = now.obstacles[0].impulse - before.obstacles[0].impulse;
  EXPECT_NEAR(impulse[1] / 0.5, 500, 0.5);
  EXPECT_NEAR(impulse[0] / 0.5, 0, 1);
  EXPECT_NEAR((now.obstacles[0].moment - before.obstacles[0].moment)[2] / 0.5,
              500,
              2);
  EXPECT_LT(now.momentum_error, 1e-12);
}



// The block slides from fine cells into coarse ones.
TEST(ObstacleContact, ABlockSlidesAcrossSizesOfCells)
{
  const double friction = 0.3;
  auto         settings = fine_where("1.3 - x");
  settings.push_back("Body block/Placement=cut");
  SceneRun<2> run(block_on_slope, settings);
  run.advance_to(0.1);
  const auto start = run.totals();
  run.advance_to(0.4);
  const auto   end  = run.totals();
  const auto   gain = (end.all.momentum - start.all.momentum) / 500;
  const double a    = sliding_acceleration(friction);
  const double found =
    (gain * down_the_slope() + friction * (gain * off_the_slope())) / 0.3;
  RecordProperty("of the exact acceleration", digits(found / a));
  EXPECT_NEAR(found, a, 0.02 * a);
  EXPECT_NEAR(end.energy_drift, 0, 0.002);
  EXPECT_LT(end.momentum_error, 1e-12);
}



// In space, where a face of a coarse cell has five nodes that hang; the moment
// is that of forces at the places of masters.
TEST(ObstacleContact, TheFloorBearsTheWeightOnTwoSizesOfCellsInSpace)
{
  const std::string block_in_space = R"(
    set Dimension = 3
    set Bodies = block
    set Obstacles = floor
    subsection Body block
      subsection Box
        set Lower corner = 0.5, 0.5, 0.5
        set Upper corner = 1.5, 1.5, 1
      end
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
    end
    subsection Obstacle floor
      set Shape = half-space
      set Law = stick
      subsection Half-space
        set Point = 0, 0, 0.5
        set Normal = 0, 0, 1
      end
    end
    subsection Grid
      set Upper corner = 2, 2, 1.5
      set Cells = 8, 8, 6
    end
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
      set back = free
      set front = free
    end
    subsection Loads
      set Gravity = 0, 0, -1
    end
    subsection Method
      set Damping rate = 20
    end)";
  SceneRun<3>       run(block_in_space, fine_where("0.9 - x"));
  EXPECT_FALSE(run.grid.vertices.hanging.empty());
  run.advance_to(1);
  const auto before = run.totals();
  run.advance_to(1.5);
  const auto now     = run.totals();
  const auto impulse = now.obstacles[0].impulse - before.obstacles[0].impulse,
             moment  = now.obstacles[0].moment - before.obstacles[0].moment;
  EXPECT_NEAR(impulse[2] / 0.5, 500, 0.5);
  // r x F of 500 N downwards at (1, 1) is -500, 500, 0; of the reaction the
  // other way round
  EXPECT_NEAR(moment[0] / 0.5, 500, 3);
  EXPECT_NEAR(moment[1] / 0.5, -500, 3);
  EXPECT_LT(now.momentum_error, 1e-12);
}



TEST(ObstacleContact, BadStartsAndJumpsAreRefused)
{
  EXPECT_THROW(SceneRun<2>(block_over_floor,
                           {"Obstacle floor/Half-space/Point=0, 0.6"}),
               InputError);
  SceneRun<2> run(block_over_floor,
                  {"Obstacle floor/Displacement=0; if(t > 0.01, 0.2, 0)"});
  EXPECT_THROW(run.advance(1e-3, 20), ComputationError);
}
