// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <support/scene_run.h>

/**
 * @file Semi-implicit steps: the pressure of a liquid is found together with
 * the velocity that it leaves (ImplicitPressure).
 */

using namespace limber;

namespace
{
  // Water in a vessel, on cells of 1 m
  const std::string vessel = R"(
    set Bodies = water
    subsection Body water
      subsection Box
        set Upper corner = 4, 4
      end
      set Points per cell edge = 3
      set Placement = cut
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 1e15
      end
      set Locking treatment = cell
    end
    subsection Grid
      set Upper corner = 4, 6
      set Cells = 4, 6
    end
    subsection Boundaries
      set left = slip
      set right = slip
      set bottom = slip
      set top = slip
    end
    subsection Method
      set Time integration = semi-implicit
    end)";

  const std::string gravity = "Loads/Gravity=0, -10";



  double
  kinetic_energy(SceneRun<2> &run)
  {
    double sum = 0;
    for (std::size_t p = 0; p < run.points().size; ++p)
      sum += 0.5 * run.points().mass[p] * run.velocity(p).norm_square();
    return sum;
  }



  /** Kinetic, and K (J - 1 - ln J) of each volume of points of this K; J. */
  double
  energy(SceneRun<2> &run, const double bulk_modulus)
  {
    std::vector<double> J(run.points().size);
    run.bodies[0]->stress->volume_ratio(run.points(), J.data());
    double sum = kinetic_energy(run);
    for (std::size_t p = 0; p < J.size(); ++p)
      sum += run.points().mass[p] / 1000 * bulk_modulus *
             (J[p] - 1 - std::log(J[p]));
    return sum;
  }
} // namespace



// From no pressure to that of rest in one step, wherever the surface cuts its
// cells and however stiff the liquid is: rho g z at the middle of full cells,
// half of it at the bottom of cells that are filled in part.
TEST(ImplicitPressure, IsHydrostaticAfterOneStep)
{
  for (unsigned int cut = 1; cut <= 20; ++cut)
    for (const std::string modulus : {"1e15", "2e9"})
      {
        const double height = 2 + 0.05 * cut;
        SCOPED_TRACE(modulus + ", " + std::to_string(height));
        SceneRun<2>         run(vessel,
                        {gravity,
                                 "Body water/Box/Upper corner=4, " + digits(height),
                                 "Body water/Newtonian fluid/Bulk modulus=" + modulus});
        std::vector<double> places;
        for (const auto &place : run.positions())
          places.push_back(place[1]);
        run.advance(0.05);
        // sound: the liquid gives way by rho g z / K in the step
        const double tolerance = modulus == "1e15" ? 1e-8 : 1e-3;
        // The placement counts what the surface cuts off by samples.
        const auto   points = run.points();
        const double top    = std::ceil(height) - 1;
        double       volume = 0, in_top = 0, centre = 0;
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double of_point = points.mass[p] / 1000;
            volume += of_point;
            if (places[run.bodies[0]->points.id(p)] > top)
              {
                in_top += of_point;
                centre +=
                  of_point * (places[run.bodies[0]->points.id(p)] - top);
              }
          }
        for (std::size_t p = 0; p < points.size; ++p)
          {
            const double bottom =
              std::floor(places[run.bodies[0]->points.id(p)]);
            const double depth =
              bottom < top ? volume / 4 - bottom - 0.5 : centre / in_top;
            ASSERT_NEAR(points.pressure[p],
                        1e4 * depth,
                        1e4 * tolerance * height);
            ASSERT_NEAR(points.velocity[1][p], 0, 10 * 0.05 * tolerance);
          }
      }
}



// The same on cells of two sizes, one above the other or beside each other:
// hanging nodes follow their masters, to which pressures give just their
// weight.
TEST(ImplicitPressure, IsHydrostaticOverLevels)
{
  for (const std::string part : {"4, 1", "4, 2", "2, 6", "2, 3"})
    {
      SCOPED_TRACE(part);
      SceneRun<2> run(vessel,
                      {gravity,
                       "Grid/Levels=1",
                       "Grid/Refine=part",
                       "Grid/Refine part/Upper corner=" + part});
      ASSERT_GT(run.nodes.table.hanging.size(), 0u);
      run.advance(0.05);
      for (std::size_t p = 0; p < run.points().size; ++p)
        {
          const auto  &cell   = run.grid.geometry[run.points().cell[p]];
          const double height = cell.origin[1] + 0.5 / cell.inverse_edge[1];
          ASSERT_NEAR(run.points().pressure[p], 1e4 * (4 - height), 4e-4);
          ASSERT_NEAR(run.velocity(p).norm(), 0, 2e-8);
        }
    }
}



// What is viscous is strained by the re-mapped velocity, but pressure works
// along the new one.
TEST(ImplicitPressure, AccountsForViscousWaves)
{
  for (const std::string viscosity : {"0.4", "4"})
    {
      SCOPED_TRACE(viscosity);
      SceneRun<2> run(vessel,
                      {"Loads/Gravity=0, -9.81",
                       "Grid/Upper corner=1, 1.2",
                       "Grid/Cells=20, 24",
                       "Body water/Shape=formula",
                       "Body water/Formula/Inside=1+0.02*cos(pi*x)-y",
                       "Body water/Formula/Upper corner=1, 1.1",
                       "Body water/Initial pressure=hydrostatic",
                       "Body water/Newtonian fluid/Bulk modulus=2e9",
                       "Body water/Newtonian fluid/Viscosity=" + viscosity});
      run.advance_to(2);
      EXPECT_NEAR(run.totals().energy_drift, 0, 0.01);
    }
}



// Stirred water in a full box under gravity does not part from the lid; its
// centre would sink by 12 mm without density control.
TEST(ImplicitPressure, KeepsAFullBoxFull)
{
  SceneRun<2> run(vessel,
                  {"Loads/Gravity=0, -9.81",
                   "Grid/Upper corner=1, 1",
                   "Grid/Cells=32, 32",
                   "Body water/Box/Upper corner=1, 1",
                   "Body water/Newtonian fluid/Bulk modulus=2e9",
                   "Body water/Initial velocity=0.5*sin(2*pi*x)*cos(2*pi*y); "
                   "-0.5*cos(2*pi*x)*sin(2*pi*y)"});
  run.advance_to(1);
  double sum = 0;
  for (const auto &place : run.positions())
    sum += place[1];
  EXPECT_NEAR(sum / run.positions().size(), 0.5, 0.002);
}



// What kinetic energy and the work of compression lose is on record but for the
// residual of the solver.
TEST(ImplicitPressure, AccountsForTheEnergyThatItTakes)
{
  for (const std::string gamma : {"0", "0.1", "1"})
    {
      SCOPED_TRACE(gamma);
      SceneRun<2>  run(vessel,
                      {"Body water/Box/Lower corner=1.1, 1.1",
                        "Body water/Box/Upper corner=2.9, 3.6",
                        "Body water/Newtonian fluid/Bulk modulus=1e5",
                        "Body water/Checkerboard control=" + gamma,
                        "Body water/Initial velocity=sin(2*x)*y; cos(3*y)*x"});
      const double before = kinetic_energy(run);
      run.advance(0.05);
      EXPECT_NEAR(energy(run, 1e5) + run.ledger.viscous, before, 1e-9 * before);
      EXPECT_GT(energy(run, 1e5) - kinetic_energy(run), 0.01 * before);
      EXPECT_LT(kinetic_energy(run), 0.9 * before);
    }
}



// The volume that the control of checkerboards moves between cells, and that
// which the motion takes, sum up to what crosses the surface: J of all points
// together follows the divergence of the nodes.
TEST(ImplicitPressure, ChangesVolumeAsMuchAsPressure)
{
  SceneRun<2> run(vessel,
                  {gravity,
                   "Body water/Box/Upper corner=3.3, 3.6",
                   "Body water/Newtonian fluid/Bulk modulus=1e6",
                   "Body water/Initial velocity=sin(x); 0"});
  for (unsigned int n = 0; n < 20; ++n)
    {
      run.advance(0.02);
      // where all points of a cell have met the same motions, J p = K (1 - J)
      if (n == 0)
        {
          std::vector<double> J(run.bodies[0]->points.size());
          run.bodies[0]->stress->volume_ratio(run.points(), J.data());
          for (std::size_t p = 0; p < J.size(); ++p)
            ASSERT_NEAR(run.points().pressure[p], 1e6 * (1 - J[p]), 1e-2);
        }
    }
  EXPECT_EQ(run.ledger.lost_points, 0u);
}



// With short steps it gives what explicit ones give, but for what both do
// within a cell (means of points that have clumped, the way of points through
// the cell), which goes with its size.
TEST(ImplicitPressure, TendsToExplicitSteps)
{
  const auto height = [&](const std::string &integration,
                          const unsigned int n) {
    const double step = 1e-3 / n;
    SceneRun<2>  run(vessel,
                    {gravity,
                      "Grid/Cells=" + std::to_string(4 * n) + ", " +
                        std::to_string(6 * n),
                      "Body water/Box/Upper corner=2, 3",
                      "Body water/Newtonian fluid/Bulk modulus=1e6",
                      "Body water/Hourglass control=0",
                      "Body water/Checkerboard control=0",
                      "Body water/Particle shifting=0",
                      "Body water/Density control=0",
                      "Body water/Initial pressure=hydrostatic",
                      // of a node that is hardly filled usl makes too much
                      std::string("Method/Stress update=") +
                        (integration == "explicit" ? "musl" : "usl"),
                      "Method/Time integration=" + integration});
    run.advance(step, static_cast<unsigned int>(std::lround(0.2 / step)));
    double sum = 0;
    for (const auto &place : run.positions())
      sum += place[1];
    return sum / run.bodies[0]->points.size();
  };
  double former = 4e-3; // of the height of 1.5 m
  for (const unsigned int n : {1, 2, 4})
    {
      const double distance =
        std::abs(height("semi-implicit", n) - height("explicit", n));
      EXPECT_LT(distance, 0.6 * former) << n;
      former = distance;
    }
}



// Two liquids at rest, the lower one three times as heavy: nodes between them
// hold as much as there is room for, and nothing moves. Where they overlap by a
// fifth of a cell the cells on either side hold 0.09 too much, by their nodes,
// of which all but 0.02 is pushed apart.
TEST(ImplicitPressure, MakesRoomForSeveralLiquids)
{
  struct Result
  {
    // What the nodes of the cells below and above y = 2 hold on average, of
    // their room
    std::array<double, 2> before, after;
    double                shift; // the largest of a point, m
  };
  const auto run_with = [](const std::string &lower_end_of_oil) {
    SceneRun<2> run(vessel,
                    {gravity,
                     "Bodies=water, oil",
                     "Body water/Newtonian fluid/Density=3000",
                     "Body water/Box/Upper corner=4, 2",
                     "Body oil/Box/Lower corner=0, " + lower_end_of_oil,
                     "Body oil/Box/Upper corner=4, 4",
                     "Body oil/Points per cell edge=3",
                     "Body oil/Placement=cut",
                     "Body oil/Material=newtonian fluid",
                     "Body oil/Newtonian fluid/Density=1000",
                     "Body oil/Newtonian fluid/Bulk modulus=1e15",
                     "Body oil/Locking treatment=cell",
                     "Body oil/Frame=current"});
    const auto  held = [&](const double middle) {
      double sum = 0;
      for (const auto &body : run.bodies)
        {
          const PointView<2> points = body->points.view();
          for (std::size_t p = 0; p < points.size; ++p)
            for (const double y : {middle - 0.5, middle + 0.5})
              sum += 0.5 * points.mass[p] / body->stress->density() *
                     std::max(0., 1 - std::abs(points.position[0][p] - 2)) *
                     std::max(0., 1 - std::abs(points.position[1][p] - y));
        }
      return sum;
    };
    const auto heights = [&]() {
      std::vector<double> result;
      for (const auto &body : run.bodies)
        {
          const PointView<2> points = body->points.view();
          for (std::size_t p = 0; p < points.size; ++p)
            result.push_back(points.position[1][p]);
        }
      std::sort(result.begin(), result.end());
      return result;
    };
    Result result{};
    result.before   = {{held(1.5), held(2.5)}};
    const auto from = heights();
    run.advance(0.06, 60);
    result.after  = {{held(1.5), held(2.5)}};
    const auto to = heights();
    for (std::size_t k = 0; k < from.size(); ++k)
      result.shift = std::max(result.shift, std::abs(to[k] - from[k]));
    return result;
  };
  const Result without = run_with("2"), with = run_with("1.8");
  EXPECT_LT(without.shift, 1e-9);
  for (const unsigned int k : {0, 1})
    {
      EXPECT_NEAR(without.before[k], 1, 1e-12);
      EXPECT_GT(with.before[k], 1.08);
      EXPECT_LT(with.after[k], 1.025);
      EXPECT_GT(with.after[k], 0.975);
    }
}



// Where nodes inside hold too little, what is around them draws together, and
// no further than to 0.98 of their room.
TEST(ImplicitPressure, DrawsTogetherWhatIsInside)
{
  SceneRun<2> run(vessel,
                  {gravity,
                   "Body water/Box/Upper corner=4, 4",
                   "Body water/Points per cell edge=3"});
  // A tenth away from the middle of the vessel on both sides
  PointView<2> points = run.bodies[0]->points.view();
  for (std::size_t p = 0; p < points.size; ++p)
    if (std::abs(points.position[1][p] - 2) < 1)
      points.mass[p] *= 0.9;
  const auto held = [&]() {
    double sum = 0;
    for (std::size_t p = 0; p < points.size; ++p)
      sum += points.mass[p] / run.bodies[0]->stress->density() *
             std::max(0., 1 - std::abs(points.position[0][p] - 2)) *
             std::max(0., 1 - std::abs(points.position[1][p] - 2));
    return sum;
  };
  const double before = held();
  run.advance(0.06, 60);
  points             = run.bodies[0]->points.view();
  const double after = held();
  EXPECT_LT(before, 0.91);
  EXPECT_GT(after, 0.97);
  EXPECT_LT(after, 1.02);
}



// Points that stand too close go apart and keep velocity, pressure and volume:
// were the way a part of the velocity, the pressure of the next step would have
// to stop it. Their weight is lifted on the way, which is on record.
TEST(ImplicitPressure, MakesRoomWithoutForce)
{
  const auto run_with = [](const std::string &control) {
    auto run = std::make_unique<SceneRun<2>>(
      vessel,
      std::vector<std::string>{gravity,
                               "Body water/Particle shifting=0",
                               "Body water/Density control=" + control});
    const PointView<2> points = run->points();
    for (std::size_t p = 0; p < points.size; ++p)
      if (std::abs(points.position[1][p] - 2) < 1)
        points.mass[p] *= 1.1;
    run->advance(0.02);
    return run;
  };
  const auto   without = run_with("0"), with = run_with("0.2");
  const auto   points = with->points();
  const double K      = 1e15;
  double       way = 0, work = 0;
  for (std::size_t p = 0; p < points.size; ++p)
    {
      EXPECT_LT((with->velocity(p) - without->velocity(p)).norm(), 1e-9);
      EXPECT_NEAR(points.pressure[p] / without->points().pressure[p], 1, 1e-9);
      const auto shift = with->position(p) - without->position(p);
      way              = std::max(way, shift.norm());
      work += points.mass[p] * 10 * shift[1];
    }
  EXPECT_GT(way, 0.005);
  EXPECT_LT(way, 0.1);
  EXPECT_GT(work, 0);
  // almost all of it as history: the points of a cell spread evenly, by v - w
  const double history = with->ledger.history - without->ledger.history;
  const double viscous = with->ledger.viscous - without->ledger.viscous;
  EXPECT_NEAR(history / -work, 1, 2e-3);
  EXPECT_NEAR((history + viscous) / -work, 1, 1e-6);
  EXPECT_NEAR(energy(*with, K), energy(*without, K), 1e-6 * work);
}



// A turning drop keeps its size: points follow curves, not tangents.
TEST(ImplicitPressure, LetsAVortexTurn)
{
  SceneRun<2> run(vessel,
                  {"Grid/Upper corner=2, 2",
                   "Grid/Cells=16, 16",
                   "Body water/Shape=ball",
                   "Body water/Ball/Centre=1, 1",
                   "Body water/Ball/Radius=0.6",
                   "Body water/Newtonian fluid/Bulk modulus=2e9",
                   "Body water/Initial velocity=-(y-1); x-1",
                   "Boundaries/left=free",
                   "Boundaries/right=free",
                   "Boundaries/bottom=free",
                   "Boundaries/top=free"});
  const auto  radius_squared = [&]() {
    double sum = 0;
    for (std::size_t p = 0; p < run.bodies[0]->points.size(); ++p)
      sum += (run.position(p) - dealii::Point<2>(1, 1)).norm_square();
    return sum / run.bodies[0]->points.size();
  };
  const double before = radius_squared();
  run.advance(0.04, 40);
  EXPECT_NEAR(radius_squared() / before, 1, 0.02);
}



namespace
{
  // A drop in free space whose upper half rises and whose lower half sinks
  std::vector<std::string>
  pulled_drop(const bool cut)
  {
    return {"Grid/Upper corner=4, 8",
            "Grid/Cells=4, 8",
            "Body water/Box/Lower corner=1, 3",
            "Body water/Box/Upper corner=3, 5",
            "Body water/Newtonian fluid/Bulk modulus=2e9",
            "Body water/Hourglass control=0",
            "Body water/Initial velocity=0; y-4",
            std::string("Body water/Newtonian fluid/Tension cutoff=") +
              (cut ? "true" : "false")};
  }
} // namespace



// What is pulled apart flies on as it was thrown where tension is cut off: no
// point changes its velocity. Without cut-off tension stops it, as nothing
// flows in from the sides.
TEST(ImplicitPressure, LetsLiquidsPartWhereTensionIsCutOff)
{
  SceneRun<2>         run(vessel, pulled_drop(true));
  const auto          places = run.positions();
  std::vector<double> speeds(places.size());
  for (std::size_t p = 0; p < places.size(); ++p)
    speeds[run.bodies[0]->points.id(p)] = run.velocity(p)[1];
  const double before = kinetic_energy(run);
  run.advance(0.05, 10);
  for (std::size_t p = 0; p < places.size(); ++p)
    {
      ASSERT_EQ(run.points().pressure[p], 0);
      ASSERT_NEAR(run.velocity(p)[0], 0, 1e-12);
      ASSERT_NEAR(run.velocity(p)[1],
                  speeds[run.bodies[0]->points.id(p)],
                  1e-12);
      // with the velocity of nodes, which are means of points around them
      ASSERT_NEAR(run.position(p)[0],
                  places[run.bodies[0]->points.id(p)][0],
                  1e-12);
    }
  EXPECT_NEAR(kinetic_energy(run), before, 1e-12 * before);
  EXPECT_NEAR(run.ledger.viscous, 0, 1e-12 * before);

  SceneRun<2> held(vessel, pulled_drop(false));
  held.advance(0.05);
  double least = 0;
  for (std::size_t p = 0; p < places.size(); ++p)
    least = std::min(least, held.points().pressure[p]);
  EXPECT_LT(least, -1000);
  EXPECT_LT(kinetic_energy(held), 0.8 * before);
}



// A drop whose parts fly together and apart: no cell has tension, some have no
// pressure and others one. What the cutoff takes is on record with all else
// that is lost, on the way and when parts land on walls.
TEST(ImplicitPressure, CutsTensionAloneOff)
{
  for (const bool cut : {false, true})
    {
      SceneRun<2>  run(vessel,
                      {"Body water/Box/Lower corner=1.1, 1.1",
                        "Body water/Box/Upper corner=2.9, 3.6",
                        "Body water/Newtonian fluid/Bulk modulus=1e7",
                        std::string("Body water/Newtonian fluid/Tension "
                                    "cutoff=") +
                          (cut ? "true" : "false"),
                        "Body water/Initial velocity=sin(2*x)*y; cos(3*y)*x"});
      double       least  = 0;
      const double before = energy(run, 1e7);
      for (unsigned int n = 0; n < 20; ++n)
        {
          run.advance(0.02);
          std::size_t without = 0;
          for (std::size_t p = 0; p < run.points().size; ++p)
            {
              least = std::min(least, run.points().pressure[p]);
              without += run.points().pressure[p] == 0;
            }
          if (n == 0 && cut)
            {
              EXPECT_GT(without, run.points().size / 10);
              EXPECT_LT(without, run.points().size * 9 / 10);
            }
          ASSERT_NEAR(energy(run, 1e7) + run.ledger.viscous +
                        run.ledger.history + run.ledger.contact,
                      before,
                      1e-11 * before); // the solver's residual times P
        }
      EXPECT_EQ(run.ledger.history > 0, cut);
      EXPECT_GT(run.ledger.contact, 0); // it has met the walls
      if (cut)
        EXPECT_EQ(least, 0);
      else
        EXPECT_LT(least, -100);
    }
}



// The same for nearly incompressible solids: the pressure that holds their
// weight is there after one step, however long sound would take, and stays.
TEST(ImplicitPressure, HoldsSolidsAsItHoldsLiquids)
{
  for (const std::string law : {"Linear elastic", "Neo hookean"})
    {
      SCOPED_TRACE(law);
      SceneRun<2> run(vessel,
                      {gravity,
                       "Body water/Box/Upper corner=4, 3",
                       "Body water/Material=" +
                         std::string(law == "Neo hookean" ? "neo hookean" :
                                                            "linear elastic"),
                       "Body water/" + law + "/Density=1000",
                       "Body water/" + law + "/Young's modulus=1e5",
                       "Body water/" + law + "/Poisson's ratio=0.4999999"});
      ASSERT_TRUE(run.problem.bodies[0].implicit_pressure);
      std::vector<double> depths;
      for (const auto &place : run.positions())
        depths.push_back(2.5 - std::floor(place[1]));
      const auto expect_hydrostatic = [&](const double tolerance) {
        for (std::size_t p = 0; p < run.points().size; ++p)
          ASSERT_NEAR(run.points().pressure[p],
                      1e4 * depths[run.bodies[0]->points.id(p)],
                      tolerance * 3e4);
      };
      run.advance(0.03);
      expect_hydrostatic(1e-4);
      run.advance(0.03, 20); // shear waves cross three cells
      expect_hydrostatic(1e-3);
    }
}



// Water of 2.2 GPa that collapses between sides that let go and rub: it is held
// where it presses, goes the less far the more it is rubbed, and the balance of
// energy closes.
TEST(ImplicitPressure, FindsWhatPressesOnSides)
{
  struct Result
  {
    double front, drift, heat;
  };
  const auto run_with = [](const std::string &word, const double friction) {
    std::string sides;
    for (const std::string side : {"left", "right", "bottom"})
      {
        sides += "set " + side + " = " + word + "\n";
        if (friction > 0)
          sides += "subsection Side " + side +
                   "\nset Friction coefficient = " + digits(friction) +
                   "\nend\n";
      }
    const std::size_t first = vessel.find("set left"),
                      last  = vessel.find("set top");
    SceneRun<2> run(vessel.substr(0, first) + sides + vessel.substr(last),
                    {gravity,
                     "Grid/Upper corner=8, 6",
                     "Grid/Cells=16, 12",
                     "Body water/Box/Upper corner=3, 4",
                     "Body water/Points per cell edge=2",
                     "Body water/Newtonian fluid/Bulk modulus=2.2e9"});
    run.advance(0.02, 40);
    Result     result{0, run.totals().energy_drift, run.totals().friction_heat};
    const auto points = run.points();
    for (std::size_t p = 0; p < points.size; ++p)
      result.front = std::max(result.front, points.position[0][p]);
    return result;
  };
  const Result slip       = run_with("slip", 0),
               separating = run_with("separating", 0),
               rough      = run_with("friction", 0.1),
               rougher    = run_with("friction", 0.3);
  for (const Result &result : {slip, separating, rough, rougher})
    EXPECT_NEAR(result.drift, 0, 1e-5);
  EXPECT_NEAR(separating.front, slip.front, 0.02 * slip.front);
  EXPECT_LT(rough.front, 0.99 * slip.front);
  EXPECT_LT(rougher.front, 0.97 * rough.front);
  EXPECT_GT(rough.heat, 1000);
  EXPECT_GT(rougher.heat, rough.heat);
}



// Water that meets a side spreads faster than it came: what would go further
// than a cell is done over a shorter time, and as if that had been asked for;
// also where the step is prescribed.
TEST(ImplicitPressure, TakesAShorterStepWhereNodesWouldGoTooFar)
{
  for (const std::string step : {"0", "0.12"})
    {
      const std::vector<std::string> thrown = {
        "Body water/Initial velocity=-1; 0",
        "Body water/Box/Upper corner=4, 2",
        "Body water/Newtonian fluid/Bulk modulus=2.2e9",
        "Method/Time step=" + step,
        "Grid/Cells=32, 48"};
      SceneRun<2> run(vessel, thrown), expected(vessel, thrown);
      run.advance(0.12);
      EXPECT_LT(run.last_step, 0.1);
      EXPECT_EQ(
        run.integrator.reason_for_shorter_step().find("nodes would move"), 0u);
      expected.advance(run.last_step);
      const auto places = run.positions(), others = expected.positions();
      for (std::size_t p = 0; p < places.size(); ++p)
        EXPECT_LT(places[p].distance(others[p]), 1e-13);
      EXPECT_EQ(run.ledger.viscous, expected.ledger.viscous);
      EXPECT_EQ(run.ledger.side_impulse[0], expected.ledger.side_impulse[0]);
    }
}



// An elastic block on water, under its weight from the start: it swings, with
// at most what the weight gives it, w^2 H/(6 M) = 6.2 J with the load w of
// 10 kPa, H = 0.5 m and M = 1.35 MPa, and nothing comes from nowhere.
TEST(ImplicitPressure, CarriesAnElasticBlock)
{
  const std::string scene = R"(
    set Bodies = water, block
    subsection Body water
      subsection Box
        set Upper corner = 1, 1
      end
      set Points per cell edge = 2
      set Material = newtonian fluid
      subsection Newtonian fluid
        set Density = 1000
        set Bulk modulus = 2.2e9
      end
      set Initial pressure = 10000 + 10000*(1 - y)
    end
    subsection Body block
      subsection Box
        set Lower corner = 0, 1
        set Upper corner = 1, 1.5
      end
      set Points per cell edge = 2
      set Material = neo hookean
      subsection Neo hookean
        set Density = 2000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
      set Locking treatment = none
    end
    subsection Grid
      set Upper corner = 1, 2
      set Cells = 10, 20
    end
    subsection Method
      set Time integration = semi-implicit
    end)";
  SceneRun<2>       run(scene, {gravity});
  double            largest = 0;
  run.advance_to(2, [&]() {
    largest = std::max(largest, run.totals().all.kinetic_energy);
  });
  EXPECT_LT(largest, 7.);
  EXPECT_GT(run.ledger.viscous, -0.01);
  EXPECT_NEAR(run.totals().energy_drift, 0, 1e-3);
}



// Water in the air, without gravity, under a body force A sin(w t): steps are
// short enough for it. They move points by the velocity at their ends, which is
// A dt / w t in all.
TEST(ImplicitPressure, ResolvesFormulasOfTime)
{
  SceneRun<2> run(vessel,
                  {"Body water/Box/Lower corner=1, 2",
                   "Body water/Box/Upper corner=2, 3",
                   "Body water/Newtonian fluid/Bulk modulus=2.2e9",
                   "Loads/Body force=0.2*sin(20*t); 0",
                   "End time=2"});
  const auto  before = run.positions();
  run.advance_to(2);
  const auto   after    = run.positions();
  const double expected = 0.2 * 2 / 20 - 0.2 * std::sin(40.) / 400;
  EXPECT_LT(run.last_step, 0.25 / 20 * 1.01);
  for (std::size_t p = 0; p < before.size(); ++p)
    EXPECT_NEAR(after[p][0] - before[p][0], expected, 0.1 * expected);
}
