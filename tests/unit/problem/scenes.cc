// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/body_at_sides.h>
#include <limber/problem/obstacle_way.h>
#include <limber/problem/read_problem.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

using namespace limber;
using dealii::Point;

namespace
{
  std::string
  prm_folder()
  {
    const std::filesystem::path here(__FILE__);
    return (here.parent_path() / "../../../prm/").lexically_normal().string();
  }



  SceneFile
  scene_of(const std::string              &text,
           const std::vector<std::string> &overrides = {},
           const FileFormat                format    = FileFormat::prm)
  {
    return SceneFile(ParameterText{text, format, "scene"}, overrides);
  }
} // namespace



TEST(Scenes, DamBreakReadsAsWritten)
{
  const SceneFile scene(prm_folder() + "dam_break.prm");
  ASSERT_EQ(scene.dimension(), 2u);
  const Problem<2> problem = read_problem<2>(scene);

  EXPECT_DOUBLE_EQ(problem.end_time, 0.68);
  ASSERT_EQ(problem.bodies.size(), 1u);
  const Body<2> &water = problem.bodies[0];
  EXPECT_EQ(water.name, "water");
  EXPECT_EQ(water.shape->bounding_box().second, Point<2>(1, 2));
  EXPECT_EQ(water.points_per_cell_edge[1], 5u);
  EXPECT_TRUE(water.initial_velocity.is_zero());
  EXPECT_TRUE(water.hydrostatic);
  EXPECT_EQ(water.law, "newtonian fluid");
  EXPECT_DOUBLE_EQ(water.density(), 997.5);
  EXPECT_DOUBLE_EQ(water.material.at(1), 2e9);
  EXPECT_DOUBLE_EQ(water.material.at(2), 1e-3);
  EXPECT_EQ(water.treatment, Treatment::cell);

  EXPECT_EQ(problem.grid.upper, Point<2>(5, 3));
  EXPECT_EQ(problem.grid.cells[1], 24u);
  EXPECT_EQ(problem.sides[3].held, HeldComponents::normal);
  EXPECT_DOUBLE_EQ(problem.loads.gravity[1], -9.81);
  EXPECT_FALSE(problem.loads.body_force);
  EXPECT_EQ(problem.method.integration, TimeIntegration::semi_implicit);
  EXPECT_EQ(problem.method.transfer, Transfer::flip);
  EXPECT_DOUBLE_EQ(problem.output.time_interval, 0.02);
  EXPECT_EQ(problem.output.fields,
            (std::vector<std::string>{"velocity", "pressure", "stress"}));
}



TEST(Scenes, DamBreakObservablesAndChecks)
{
  const Problem<2> problem =
    read_problem<2>(SceneFile(prm_folder() + "dam_break.prm"));
  ASSERT_EQ(problem.observables.size(), 2u);
  EXPECT_EQ(problem.observables[0].kind->word, "extreme coordinate");
  EXPECT_EQ(problem.observables[0].axis, 0u);
  EXPECT_TRUE(problem.observables[0].positive);
  EXPECT_FALSE(problem.observables[0].within);
  EXPECT_EQ(problem.observables[1].within->second, Point<2>(0.125, 3));

  ASSERT_EQ(problem.checks.size(), 2u);
  EXPECT_EQ(problem.checks[0].name, "front at T=3");
  EXPECT_EQ(problem.checks[0].observable, "front");
  EXPECT_DOUBLE_EQ(*problem.checks[0].at_time, 0.6773);
  EXPECT_DOUBLE_EQ(problem.checks[1].tolerance, 0.04);
}



TEST(Scenes, CantileverReadsAsWritten)
{
  const Problem<2> problem =
    read_problem<2>(SceneFile(prm_folder() + "cantilever.prm"));
  const Body<2> &beam = problem.bodies[0];
  EXPECT_EQ(beam.law, "neo hookean");
  EXPECT_DOUBLE_EQ(beam.material.at(2), 0.49);
  EXPECT_EQ(beam.treatment, Treatment::cell);

  // The first mode has the amplitude v0 at the tip.
  EXPECT_NEAR(beam.initial_velocity.value(Point<2>(8, 2), 0., 1), 0.01, 1e-5);
  EXPECT_NEAR(beam.initial_velocity.value(Point<2>(0, 2), 0., 1), 0, 1e-12);

  EXPECT_EQ(problem.sides[0].held, HeldComponents::all);
  EXPECT_EQ(problem.sides[1].held, HeldComponents::none);
  EXPECT_EQ(problem.observables[0].location, Point<2>(8, 2.5));
  EXPECT_EQ(problem.observables[1].kind->word, "frequency");
  EXPECT_EQ(problem.observables[1].observable, "tip");
  EXPECT_FALSE(problem.checks[0].at_time);
}



TEST(Scenes, PrintedScenesReadBackTheSame)
{
  const SceneFile scene(prm_folder() + "dam_break.prm",
                        {"Check front at T=3/Tolerance=0.25"});
  for (const auto &[style, format] :
       {std::pair(PrintStyle::prm, FileFormat::prm),
        std::pair(PrintStyle::json, FileFormat::json)})
    {
      std::ostringstream printed, again;
      print_parameters(printed, style, &scene);
      const SceneFile copy = scene_of(printed.str(), {}, format);
      EXPECT_TRUE(copy.warnings().empty());
      const Problem<2> problem = read_problem<2>(copy);
      EXPECT_DOUBLE_EQ(problem.checks[0].tolerance, 0.25);
      EXPECT_EQ(problem.grid.cells[0], 40u);

      print_parameters(again, PrintStyle::json, &copy);
      std::ostringstream json;
      print_parameters(json, PrintStyle::json, &scene);
      EXPECT_EQ(again.str(), json.str());
    }
}



TEST(Scenes, TemplateIsAScene)
{
  std::ostringstream printed, table;
  print_parameters(printed, PrintStyle::prm);
  const Problem<2> problem = read_problem<2>(scene_of(printed.str()));
  EXPECT_EQ(problem.bodies.size(), 1u);
  EXPECT_EQ(problem.loads.faces.size(), 1u);
  EXPECT_EQ(problem.loads.faces[0].face, 3u);
  EXPECT_EQ(problem.checks.size(), 1u);

  print_parameters(table, PrintStyle::markdown);
  EXPECT_NE(table.str().find("## Body block/Neo hookean"), std::string::npos);
}



TEST(Scenes, AutomaticBulkModulusKeepsTheMachNumber)
{
  const Problem<2> problem =
    read_problem<2>(SceneFile(prm_folder() + "dam_break.prm",
                              {"Method/Time integration=explicit",
                               "Method/Stress update=musl",
                               "Body water/Newtonian fluid/Bulk modulus=auto",
                               "Body water/Initial velocity = 3; 0"}));
  const double speed = std::sqrt(2 * 9.81 * 2) + 3;
  EXPECT_NEAR(problem.bodies[0].material.at(1),
              997.5 * 100 * speed * speed,
              1e-6 * 997.5 * 100 * speed * speed);
  ASSERT_EQ(problem.notes.size(), 1u);
  EXPECT_NE(problem.notes[0].find("'water'"), std::string::npos);
}



// Of the moving wall with another normal and place: liquid is noisy where an
// obstacle takes over a side face by face, and the log says so.
TEST(Scenes, ObstaclesThatStartObliquelyInASideAreTold)
{
  const auto is_told = [](const std::string &normal, const std::string &point) {
    const Problem<2> problem =
      read_problem<2>(SceneFile(prm_folder() + "verification/moving_wall.prm",
                                {"Obstacle wall/Half-space/Normal=" + normal,
                                 "Obstacle wall/Half-space/Point=" + point}));
    return std::any_of(problem.notes.begin(),
                       problem.notes.end(),
                       [](const std::string &note) {
                         return note.find("'wall' starts in side 'left'") !=
                                std::string::npos;
                       });
  };
  EXPECT_TRUE(is_told("1, 0.2", "0, 0"));
  EXPECT_TRUE(is_told("1, -0.05", "0, 1"));
  EXPECT_FALSE(is_told("1, 0", "0, 0"));
  EXPECT_FALSE(is_told("1, 0.2", "0.25, 0")); // has all of the side
}



// What stirs a liquid for long scatters the volumes of its points.
TEST(Scenes, LiquidsThatAreStirredDoNotKeepTheirHistories)
{
  const auto history = [](std::vector<std::string> changes) {
    changes.push_back("Method/Time integration=explicit");
    changes.push_back("Body water/Newtonian fluid/Bulk modulus=1e6");
    return read_problem<2>(
             SceneFile(prm_folder() + "verification/moving_wall.prm", changes))
      .bodies[0]
      .history;
  };
  using H                = HistoryTreatment;
  const std::string lid  = "Boundaries/top=velocity",
                    runs = "Boundaries/Side top/Velocity=1; 0";
  EXPECT_EQ(history({}), H::keep);
  EXPECT_EQ(history({lid, runs}), H::crossing);
  EXPECT_EQ(history({lid, "Boundaries/Side top/Velocity=0; 0"}), H::keep);
  EXPECT_EQ(history({lid, runs, "Body water/History=keep"}), H::keep);
  EXPECT_EQ(history({lid, runs, "Body water/Locking treatment=none"}), H::keep);
  EXPECT_EQ(history({lid,
                     runs,
                     "Grid/Levels=1",
                     "Grid/Refine=near",
                     "Grid/Refine near/Criterion=obstacle"}),
            H::keep);
  EXPECT_EQ(history({"Obstacle wall/Rotation=0.1*t"}), H::crossing);
}



// No gravity, no initial velocity: the lid of a cavity alone moves.
TEST(Scenes, AutomaticBulkModulusGoesByTheSidesThatMove)
{
  const Problem<2> problem =
    read_problem<2>(SceneFile(prm_folder() + "dam_break.prm",
                              {"Method/Time integration=explicit",
                               "Method/Stress update=musl",
                               "Body water/Newtonian fluid/Bulk modulus=auto",
                               "Loads/Gravity=0, 0",
                               "Body water/Initial pressure=",
                               "Boundaries/top=velocity",
                               "Boundaries/Side top/Velocity=5*sin(20*t); 0"}));
  EXPECT_NEAR(problem.bodies[0].material.at(1),
              997.5 * 100 * 25,
              0.01 * 997.5 * 100 * 25);
}



// c = 1416 m/s and |v| + sqrt(g H) = 4.4 m/s in the scene as it is.
TEST(Scenes, AutomaticTimeIntegration)
{
  struct Case
  {
    std::vector<std::string> changes;
    bool                     semi_implicit;
    std::string              reason;
  };
  for (const Case &example :
       {Case{{}, true, "319.7"},
        Case{{"Body water/Initial velocity=40; 0"}, true, "31.87"},
        Case{{"Body water/Initial velocity=50; 0"}, false, "pay from 30"},
        Case{{"Body water/Newtonian fluid/Bulk modulus=1e7"},
             false,
             "pay from 30"},
        Case{{"Body water/Newtonian fluid/Tension cutoff=true"}, true, "319.7"},
        Case{{"Body water/Newtonian fluid/Viscosity=500"}, true, "319.7"},
        Case{{"Body water/Newtonian fluid/Viscosity=5000"}, true, "319.7"},
        Case{{"Body water/Newtonian fluid/Viscosity=20000"},
             false,
             "viscosity"},
        Case{{"Method/Stress update=musl"}, false, "stress update"},
        Case{{"Method/Kernel=quadratic"}, false, "kernel"},
        Case{{"Body water/Locking treatment=none"}, false, "treatment"},
        Case{{"Boundaries/left=velocity",
              "Boundaries/Side left/Velocity=100*t; 0"},
             false,
             "pay from 30"},
        Case{{"Method/Time step=1e-5"}, false, "short enough for sound"},
        Case{{"Method/Time step=1e-3"}, true, "319.7"},
        Case{{"Loads/Face loads=push",
              "Loads/Face load push/Body=water",
              "Loads/Face load push/Face=top",
              "Loads/Face load push/Pressure=1e5"},
             false,
             "face load 'push' acts on a liquid"},
        Case{{"Body water/Material=neo hookean"}, false, ""}})
    {
      // the default of the entry; the scene says 'explicit'
      std::vector<std::string> changes = {"Method/Time integration=auto",
                                          "Method/Stress update=auto"};
      changes.insert(changes.end(),
                     example.changes.begin(),
                     example.changes.end());
      const bool has_liquid = !example.reason.empty();
      if (!has_liquid)
        changes.push_back("Body water/Initial pressure=");
      SCOPED_TRACE(changes.back());
      const Problem<2> problem =
        read_problem<2>(SceneFile(prm_folder() + "dam_break.prm", changes));
      EXPECT_EQ(problem.method.integration,
                example.semi_implicit ? TimeIntegration::semi_implicit :
                                        TimeIntegration::explicit_steps);
      EXPECT_EQ(problem.bodies[0].implicit_pressure, example.semi_implicit);
      std::string notes;
      for (const std::string &note : problem.notes)
        notes += note + "\n";
      // where there is no choice nothing is said
      EXPECT_EQ(notes.find("Time integration 'auto' is '" +
                           std::string(example.semi_implicit ? "semi-implicit" :
                                                               "explicit")) !=
                  std::string::npos,
                has_liquid)
        << notes;
      EXPECT_NE(notes.find(example.reason), std::string::npos) << notes;
    }
  // Sound is 8.6 and 2.7 times as fast as waves in the solid
  for (const bool pays : {true, false})
    EXPECT_EQ(
      read_problem<2>(
        SceneFile(prm_folder() + "verification/rising_disc.prm",
                  {"Body water/Newtonian fluid/Bulk modulus=2e9",
                   std::string("Body disc/Neo hookean/Young's modulus=") +
                     (pays ? "1e7" : "1e8")}))
        .method.integration,
      pays ? TimeIntegration::semi_implicit : TimeIntegration::explicit_steps);
  // Also where nothing moves or weighs but an obstacle
  const auto with_moving_obstacle = [](const std::string &displacement) {
    return read_problem<2>(scene_of(R"(
      set Bodies    = water
      set Obstacles = piston
      subsection Body water
        set Material = newtonian fluid
        subsection Box
          set Lower corner = 0.2, 0
        end
      end
      subsection Obstacle piston
        set Displacement = )" + displacement +
                                    R"(
        subsection Box
          set Lower corner = -1, -1
          set Upper corner = 0.2, 2
        end
      end)"))
      .method.integration;
  };
  EXPECT_EQ(with_moving_obstacle("t^2/2; 0"), TimeIntegration::semi_implicit);
  EXPECT_EQ(with_moving_obstacle("0; 0"), TimeIntegration::explicit_steps);
  // Liquids that slide on obstacles have an implicit pressure, others not
  const std::string stiff = "Body water/Newtonian fluid/Bulk modulus=2.2e9";
  EXPECT_EQ(read_problem<2>(
              SceneFile(prm_folder() + "benchmarks/dam_break_obstacle.prm",
                        {"Method/Time integration=auto", stiff}))
              .method.integration,
            TimeIntegration::semi_implicit);
  const Problem<2> with_obstacle = read_problem<2>(SceneFile(
    prm_folder() + "benchmarks/dam_break_obstacle.prm",
    {"Method/Time integration=auto", stiff, "Obstacle step/Law=stick"}));
  EXPECT_EQ(with_obstacle.method.integration, TimeIntegration::explicit_steps);
  EXPECT_TRUE(std::any_of(with_obstacle.notes.begin(),
                          with_obstacle.notes.end(),
                          [](const std::string &note) {
                            return note.find(
                                     "'explicit', as liquids do not slide on "
                                     "obstacle 'step'") != std::string::npos;
                          }));
}



// In a step an obstacle that gathers speed may move by the Courant number in
// cells; a step that is short enough stays what it is.
TEST(Scenes, ObstaclesAllowStepsOfTheCourantNumber)
{
  const Problem<2> problem = read_problem<2>(scene_of(R"(
    set Bodies    = block
    set Obstacles = piston
    subsection Body block
      subsection Box
        set Lower corner = 0.2, 0
      end
    end
    subsection Obstacle piston
      set Displacement = t^2/2; 0
      subsection Box
        set Lower corner = -1, -1
        set Upper corner = 0.2, 2
      end
    end
    subsection Grid
      set Cells = 20, 10
    end
    subsection Method
      set Courant number = 0.4
    end)"));
  const double     step    = step_that_obstacles_allow(problem, 0., 10.);
  EXPECT_LE(0.5 * step * step, 0.4 * 0.05);
  EXPECT_GT(0.5 * step * step, 0.4 * 0.05 / 4);
  EXPECT_EQ(step_that_obstacles_allow(problem, 0., 0.01), 0.01);
  EXPECT_LE(step_that_obstacles_allow(problem, 2., 10.), 0.01);
}



// What is pushed apart in a full box would press on all of it in explicit
// steps.
TEST(Scenes, DensityIsNotControlledWhereThereIsNoRoom)
{
  const std::string full      = "Body water/Box/Upper corner=1, 1",
                    with_room = "Body water/Box/Upper corner=1, 0.9";
  const auto control          = [](const std::string &integration,
                          const std::string &change,
                          const std::string &weight = "Loads/Gravity=0, 0") {
    return read_problem<2>(
             SceneFile(
               prm_folder() + "verification/taylor_green.prm",
               {"Method/Time integration=" + integration, change, weight}))
      .bodies[0]
      .density_control;
  };
  EXPECT_EQ(control("explicit", full), 0);
  EXPECT_EQ(control("explicit", with_room), 0.2);
  EXPECT_EQ(control("semi-implicit", full), 0);
  EXPECT_EQ(control("semi-implicit", full, "Loads/Gravity=0, -10"), 0.2);
  EXPECT_EQ(control("explicit", "Body water/Density control=0.1"), 0.1);
}



// In explicit steps it takes nodes at which nothing but the liquid has mass.
TEST(Scenes, DensityControlOfExplicitStepsIsForALiquidAloneAtItsNodes)
{
  const auto control = [](const std::string              &scene,
                          const std::vector<std::string> &changes) {
    std::vector<std::string> all = {"Method/Time integration=explicit"};
    all.insert(all.end(), changes.begin(), changes.end());
    return read_problem<2>(SceneFile(prm_folder() + scene, all))
      .bodies[0]
      .density_control;
  };
  const std::string vortices = "verification/taylor_green.prm",
                    not_full = "Body water/Box/Upper corner=1, 0.9";
  EXPECT_EQ(control(vortices, {}), 0);
  EXPECT_EQ(control(vortices, {not_full}), 0.2);
  EXPECT_EQ(control(vortices, {not_full, "Method/Kernel=quadratic"}), 0);
  EXPECT_EQ(control(vortices, {not_full, "Body water/Locking treatment=none"}),
            0);
  EXPECT_EQ(control("verification/water_on_plate.prm",
                    {"Method/Kernel=linear"}),
            0);
}



// Parts of the lattice of 'regular' are in or out as a whole, so that others
// fill a block whose faces do not lie in it.
TEST(Scenes, PlacementFollowsTheFaces)
{
  const auto placement = [](const std::vector<std::string> &changes) {
    return read_problem<2>(scene_of(R"(
      set Bodies = block
      subsection Body block
        set Points per cell edge = 2
        set Material = linear elastic
        subsection Newtonian fluid
          set Bulk modulus = 1e6
        end
      end
      subsection Grid
        set Lower corner = -0.3, 0
        set Upper corner = 1.7, 2
        set Cells = 20, 20
      end)",
                                    changes))
      .bodies[0]
      .placement;
  };
  const auto beside_nothing = [&](std::vector<std::string> changes) {
    for (const std::string side : {"left", "right", "bottom", "top"})
      changes.push_back("Boundaries/" + side + "=free");
    return placement(changes);
  };
  EXPECT_EQ(placement({}), Placement::regular);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0.05, 0.1"}),
            Placement::regular);
  EXPECT_EQ(beside_nothing({"Body block/Box/Lower corner=0, 0.06", // 1 %
                            "Body block/Frame=current"}),
            Placement::regular);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0, 0.06"}), Placement::cut);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0, 0.12"}), // 2.3 %
            Placement::cut);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0, 0.12",
                       "Method/Kernel=cpdi",
                       "Body block/Frame=current"}),
            Placement::fitted);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0, 0.12",
                       "Body block/Material=newtonian fluid"}),
            Placement::cut);
  EXPECT_EQ(placement({"Body block/Box/Lower corner=0, 0.12",
                       "Body block/Placement=jittered"}),
            Placement::jittered);
  EXPECT_EQ(placement({"Body block/Points along edges=20, 20"}),
            Placement::fitted);
  const std::string tilted =
    "Body block/Block/Corners=0.5, 0.1; 1, 0.6; 0.5, 1.1; 0, 0.6";
  EXPECT_EQ(placement({"Body block/Shape=block", tilted}), Placement::cut);
  EXPECT_EQ(placement({"Body block/Shape=block",
                       tilted,
                       "Method/Kernel=cpdi",
                       "Body block/Frame=current"}),
            Placement::fitted);
  // Where the body keeps its frame and meets nothing
  const std::string initial = "Body block/Frame=initial";
  EXPECT_EQ(beside_nothing({initial}), Placement::gauss);
  EXPECT_EQ(beside_nothing({initial, "Body block/Shape=block", tilted}),
            Placement::gauss);
  EXPECT_EQ(beside_nothing({"Body block/Shape=ball", initial}),
            Placement::gauss);
  EXPECT_EQ(placement({initial}), Placement::regular);
  EXPECT_EQ(placement({"Body block/Shape=ball",
                       "Body block/Initial velocity=1; 0",
                       initial}),
            Placement::cut);
  const std::string untreated = "Body block/Locking treatment=none";
  EXPECT_EQ(placement({initial, untreated}), Placement::regular);
  EXPECT_EQ(placement({"Body block/Shape=ball", initial, untreated}),
            Placement::cut);
  EXPECT_EQ(beside_nothing({initial, untreated, "Method/Kernel=quadratic"}),
            Placement::gauss);
  EXPECT_EQ(placement({initial, "Body block/Points along edges=20, 20"}),
            Placement::fitted);
  EXPECT_EQ(placement({initial, "Body block/Placement=regular"}),
            Placement::regular);
  // Splines take parts of any size; linear functions lose thin ones
  const std::string current = "Body block/Frame=current";
  EXPECT_EQ(placement({"Body block/Shape=ball", current}), Placement::cut);
  EXPECT_EQ(placement(
              {"Body block/Shape=ball", current, "Method/Kernel=linear"}),
            Placement::regular);
  EXPECT_EQ(placement({"Body block/Shape=ball",
                       current,
                       "Obstacles=floor",
                       "Obstacle floor/Shape=half-space"}),
            Placement::regular);
}



// Of liquids: where obstacles bound them, unless parts of cells do.
TEST(Scenes, LiquidsBesideObstaclesAreCut)
{
  const std::string wall      = R"(
      set Obstacles = wall
      subsection Obstacle wall
        set Shape = half-space
        subsection Half-space
          set Point  = 0.73, 0
          set Normal = -1, 0
        end
      end)";
  const auto        placement = [&](const std::string &upper_corner,
                             const bool         bounded,
                             const unsigned int levels = 0) {
    return read_problem<2>(scene_of(R"(
      set Bodies = water
      subsection Body water
        set Shape = box
        subsection Box
          set Lower corner = 0, 0
          set Upper corner = )" + upper_corner +
                                    R"(
        end
        set Points per cell edge = 2
        set Material = newtonian fluid
        subsection Newtonian fluid
          set Density      = 1000
          set Bulk modulus = 1e6
        end
      end
      subsection Grid
        set Upper corner = 1, 1
        set Cells        = 8, 8
        set Levels       = )" + std::to_string(levels) +
                                    (levels > 0 ? R"(
        set Refine       = all
        subsection Refine all
          set Upper corner = 1, 0.5
        end)" :
                                                         "") +
                                    R"(
      end)" + (bounded ? wall : "")))
      .bodies[0]
      .placement;
  };
  EXPECT_EQ(placement("0.73, 0.5", true), Placement::cut);
  EXPECT_EQ(placement("0.6875, 0.5", true), Placement::regular);
  EXPECT_EQ(placement("0.73, 0.5", false), Placement::cut);  // 2.7 % off
  EXPECT_EQ(placement("0.75, 0.51", false), Placement::cut); // 2 % off
  EXPECT_EQ(placement("0.75, 0.5003", false), Placement::regular);
  EXPECT_EQ(placement("0.6875, 0.5", true, 1), Placement::regular);
  EXPECT_EQ(placement("0.71875, 0.5", true, 1), Placement::cut);
  EXPECT_EQ(placement("0.75, 0.51", false, 1), Placement::cut);
}



TEST(Scenes, ObservablesFarFromTheirBodyAreTold)
{
  const auto notes_with = [](const std::string &location) {
    std::string notes;
    for (const std::string &note : read_problem<2>(scene_of(R"(
      set Bodies = block
      subsection Body block
        subsection Box
          set Upper corner = 0.5, 0.5
        end
      end
      subsection Grid
        set Cells = 10, 10
      end
      set Observables = tip
      subsection Observable tip
        set Type = displacement
        set Location = )" + location + R"(
        set Direction = x
      end)"))
                                     .notes)
      notes += note + "\n";
    return notes;
  };
  EXPECT_EQ(notes_with("0.5, 0.55").find("'tip'"), std::string::npos);
  EXPECT_NE(notes_with("0.9, 0.8").find("0.5 m off body 'block'"),
            std::string::npos);
}



TEST(Scenes, ThreeDimensionsUnionFrictionAndMovingSide)
{
  const Problem<3> problem = read_problem<3>(scene_of(R"(
    set Dimension = 3
    set Constants = R = 0.2, speed = 2
    set Bodies    = pin
    subsection Body pin
      set Shape = union
      set Points per cell edge = 2, 3, 4
      set Placement = gauss
      subsection Union
        set Shapes = shaft, head
        subsection Shape shaft
          set Shape = cylinder
          subsection Cylinder
            set Radius    = 0.1
            set Lower end = 0.1
            set Upper end = 0.6
          end
        end
        subsection Shape head
          set Shape = formula
          subsection Formula
            set Inside       = R^2 - (x-0.5)^2 - (y-0.5)^2 - (z-0.7)^2
            set Lower corner = 0.3, 0.3, 0.5
            set Upper corner = 0.7, 0.7, 0.9
          end
        end
      end
    end
    subsection Boundaries
      set back  = friction
      set front = velocity
      subsection Side back
        set Friction coefficient = 0.4
      end
      subsection Side front
        set Velocity = 0; 0; -speed*t
      end
    end
    set Observables = push, stress
    subsection Observable push
      set Type = reaction force
      set Side = front
      set Direction = -z
    end
    subsection Observable stress
      set Type = stress
      set Location = 0.5, 0.5, 0.5
      set Direction = xz
    end
    subsection Output
      set Fields = none
    end)"));

  const Body<3> &pin = problem.bodies[0];
  EXPECT_TRUE(pin.shape->contains(Point<3>(0.5, 0.45, 0.2)));
  EXPECT_TRUE(pin.shape->contains(Point<3>(0.5, 0.65, 0.7)));
  EXPECT_FALSE(pin.shape->contains(Point<3>(0.5, 0.65, 0.2)));
  EXPECT_EQ(pin.points_per_cell_edge[2], 4u);
  EXPECT_EQ(pin.placement, Placement::gauss);
  EXPECT_DOUBLE_EQ(problem.sides[4].friction, 0.4);
  EXPECT_DOUBLE_EQ(problem.sides[5].velocity.vector(Point<3>(), 3.)[2], -6);
  EXPECT_EQ(problem.observables[0].side, 5u);
  EXPECT_FALSE(problem.observables[0].positive);
  EXPECT_EQ(problem.observables[1].axis, 0u);
  EXPECT_EQ(problem.observables[1].second_axis, 2u);
  EXPECT_EQ(problem.observables[1].body, "pin");
  EXPECT_TRUE(problem.output.fields.empty());
}



TEST(Scenes, SidesThatMoveInwardLetGoBodiesOfTheCurrentFrame)
{
  // An edge is 0.1 m, so that it may move by 0.05 m.
  const auto check = [](const std::string &velocity,
                        const std::string &frame,
                        const std::string &end = "2") {
    check_moving_sides(read_problem<2>(scene_of(R"(
      set End time = )" + end + R"(
      set Bodies = block
      subsection Body block
        set Frame = )" + frame + R"(
      end
      subsection Boundaries
        set left  = velocity
        set right = no slip
        subsection Side left
          set Velocity = )" + velocity + R"(
        end
      end
      subsection Grid
        set Cells = 10, 10
      end)")));
  };
  EXPECT_NO_THROW(check("0.024; 0", "current"));
  EXPECT_NO_THROW(check("0.026; 0", "initial"));
  EXPECT_NO_THROW(check("-0.026; 0", "current"));
  EXPECT_NO_THROW(check("0; 1", "current"));
  EXPECT_NO_THROW(check("0.04*6*cos(6*t); 0", "current"));
  EXPECT_NO_THROW(check("0.04*20*cos(20*t); 0", "current", "1000"));
  for (const std::string velocity :
       {"0.026; 0", "0.06*6*cos(6*t); 0", "0.06*y; 0"})
    try
      {
        check(velocity, "current");
        ADD_FAILURE() << velocity;
      }
    catch (const InputError &error)
      {
        EXPECT_NE(std::string(error.what()).find("'left' moves inward"),
                  std::string::npos)
          << error.what();
      }
}



// Where a side moves into the cells of a solid these are softer; told of the
// softest solid alone.
TEST(Scenes, SidesThatMoveIntoSolidsAreWarnedOf)
{
  const auto warnings = [](const std::string              &velocity,
                           const std::vector<std::string> &changes = {}) {
    return check_moving_sides(
      read_problem<2>(SceneFile(ParameterText{R"(
      set End time = 1
      set Bodies = left, right
      subsection Body left
        subsection Box
          set Upper corner = 0.5, 1
        end
        set Frame = current
      end
      subsection Body right
        subsection Box
          set Lower corner = 0.5, 0
          set Upper corner = 1, 1
        end
        set Frame = current
      end
      subsection Boundaries
        set left  = velocity
        subsection Side left
          set Velocity = )" + velocity +
                                                R"(
        end
      end
      subsection Grid
        set Cells = 10, 10
      end)",
                                              FileFormat::prm,
                                              "scene"},
                                changes)));
  };
  EXPECT_TRUE(warnings("0.009; 0").empty());
  ASSERT_EQ(warnings("0.011; 0").size(), 1u);
  EXPECT_NE(warnings("0.011; 0").front().find("of 'left'"), std::string::npos);
  EXPECT_TRUE(
    warnings("0.011; 0", {"Body left/Linear elastic/Young's modulus=1e12"})
      .empty());
}



// What a side would displace of a liquid, particle shifting gives back.
TEST(Scenes, SidesThatMoveIntoLiquidAreWarnedOf)
{
  const auto warnings = [](const std::string &velocity) {
    return check_moving_sides(read_problem<2>(scene_of(R"(
      set End time = 1
      set Bodies = water
      subsection Body water
        set Material = newtonian fluid
      end
      subsection Boundaries
        set left  = velocity
        subsection Side left
          set Velocity = )" + velocity + R"(
        end
      end
      subsection Grid
        set Cells = 10, 10
      end)")));
  };
  EXPECT_TRUE(warnings("0; 1").empty());
  EXPECT_TRUE(warnings("0.004; 0").empty());
  ASSERT_EQ(warnings("0.04; 0").size(), 1u);
  EXPECT_NE(warnings("0.04; 0").front().find("'half-space'"),
            std::string::npos);
}



TEST(Scenes, AutomaticChoicesFollowTheMaterial)
{
  const std::string automatic = "Method/Stress update=auto";
  const auto        read      = [&](const std::string              &name,
                        const std::vector<std::string> &overrides) {
    return read_problem<2>(SceneFile(prm_folder() + name, overrides));
  };
  const auto solid =
    read("cantilever.prm", {automatic, "Body beam/Locking treatment=auto"});
  const auto liquid = read("dam_break.prm",
                           {automatic,
                            "Method/Time integration=explicit",
                            "Body water/Locking treatment=auto"});

  EXPECT_EQ(solid.method.order, StressUpdateOrder::usavg);
  EXPECT_EQ(solid.bodies[0].treatment, Treatment::assumed_strain);
  EXPECT_EQ(solid.bodies[0].hourglass_control, 0);
  EXPECT_EQ(solid.bodies[0].checkerboard_control, 0);
  EXPECT_EQ(liquid.method.order, StressUpdateOrder::musl);
  EXPECT_EQ(liquid.bodies[0].treatment, Treatment::cell);
  EXPECT_EQ(liquid.bodies[0].hourglass_control, 0.2);
  EXPECT_EQ(liquid.bodies[0].checkerboard_control, 0.5);
  for (const auto *const problem : {&solid, &liquid})
    EXPECT_EQ(std::count_if(problem->notes.begin(),
                            problem->notes.end(),
                            [](const std::string &note) {
                              return note.find("'auto' is") !=
                                     std::string::npos;
                            }),
              2);
}



// Planes of symmetry hold what stands still, and not what may be thrown off.
TEST(Scenes, AutomaticFrameBetweenPlanesOfSymmetry)
{
  const std::string block = R"(
    set End time = 1
    set Bodies = block
    subsection Body block
      subsection Box
        set Upper corner = 2, 1
      end
      set Material = neo hookean
    end
    subsection Grid
      set Upper corner = 4, 4
      set Cells = 8, 8
    end
    subsection Boundaries
      set right = free
      set top = free
    end)";
  const auto frame = [&](const std::string &steps, const std::string &left) {
    return read_problem<2>(
             SceneFile(ParameterText{block, FileFormat::prm, "scene"},
                       {"Method/Time integration=" + steps,
                        "Method/Time step=" +
                          std::string(steps == "explicit" ? "0" : "0.1"),
                        "Boundaries/left=" + left}))
      .bodies[0]
      .frame;
  };
  EXPECT_EQ(frame("quasi-static", "slip"), Frame::initial);
  EXPECT_EQ(frame("implicit", "slip"), Frame::initial);
  EXPECT_EQ(frame("explicit", "slip"), Frame::current);
  EXPECT_EQ(frame("quasi-static", "free"), Frame::current);
}



TEST(Scenes, LiquidsThatSpreadHaveThreePointsAlongAnEdge)
{
  for (const std::string steps : {"explicit", "semi-implicit"})
    {
      const auto problem =
        read_problem<2>(SceneFile(prm_folder() + "dam_break.prm",
                                  {"Body water/Points per cell edge=auto",
                                   "Method/Stress update=auto",
                                   "Method/Time integration=" + steps}));
      EXPECT_EQ(problem.bodies[0].points_per_cell_edge[0], 3u);
      EXPECT_EQ(problem.bodies[0].points_per_cell_edge[1], 3u);
    }
}



TEST(Scenes, AutomaticFrameAndKernelKeepSolidsFromCreeping)
{
  const auto read = [](const std::string       &name,
                       std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), "Method/Kernel=auto");
    return read_problem<2>(SceneFile(prm_folder() + name, overrides));
  };
  const auto beam = [&](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(),
                     {"Body beam/Frame=auto",
                      "Body beam/Points per cell edge=auto",
                      "Body beam/Locking treatment=auto"});
    return read("cantilever.prm", overrides);
  };
  const auto expect_splines = [](const Problem<2> &problem) {
    EXPECT_EQ(problem.bodies[0].frame, Frame::current);
    EXPECT_EQ(problem.grid.kernel, KernelKind::quadratic);
    EXPECT_EQ(problem.bodies[0].points_per_cell_edge[0], 3u);
  };

  const auto held = beam({});
  EXPECT_EQ(held.bodies[0].frame, Frame::initial);
  EXPECT_EQ(held.grid.kernel, KernelKind::linear);
  EXPECT_EQ(held.bodies[0].points_per_cell_edge[0], 2u);
  // 'assumed strain' locks where what is nearly incompressible bends by much
  EXPECT_EQ(held.bodies[0].treatment, Treatment::cell);
  EXPECT_EQ(
    beam({"Body beam/Neo hookean/Poisson's ratio=0.3"}).bodies[0].treatment,
    Treatment::assumed_strain);

  // Splines as well, which need no third point where nothing crosses cells.
  const auto splines = beam({"Method/Kernel=quadratic"});
  EXPECT_EQ(splines.bodies[0].frame, Frame::initial);
  EXPECT_EQ(splines.bodies[0].points_per_cell_edge[0], 2u);
  EXPECT_EQ(splines.bodies[0].treatment, Treatment::cell);
  EXPECT_EQ(beam({"Method/Kernel=quadratic",
                  "Body beam/Neo hookean/Poisson's ratio=0.3"})
              .bodies[0]
              .treatment,
            Treatment::none);

  // Held or not, it meets nothing.
  EXPECT_EQ(beam({"Boundaries/left=free"}).bodies[0].frame, Frame::initial);
  // It may lift, or fly against a side.
  expect_splines(beam({"Boundaries/left=slip"}));
  expect_splines(beam({"Boundaries/left=friction",
                       "Boundaries/Side left/Friction coefficient=0.3"}));
  expect_splines(beam({"Body beam/Box/Lower corner=0.5, 2"}));
  expect_splines(beam({"Method/Stress update=usf"}));
  EXPECT_EQ(beam({"Body beam/Locking treatment=node"}).bodies[0].frame,
            Frame::current);
  // Splines have no hourglass modes.
  EXPECT_EQ(beam({"Boundaries/left=slip",
                  "Body beam/Locking treatment=assumed strain"})
              .grid.kernel,
            KernelKind::linear);

  const auto liquid = read("dam_break.prm", {});
  EXPECT_EQ(liquid.bodies[0].frame, Frame::current);
  EXPECT_EQ(liquid.grid.kernel, KernelKind::linear);
}



// What turns where it is meets no side, however far a run is extended; what
// flies does, whenever the run ends. A law for small rotations is for these.
TEST(Scenes, ABodyThatTurnsClearOfTheSidesTakesTheInitialFrame)
{
  const std::string path  = prm_folder() + "verification/spinning_disc.prm";
  const auto        frame = [&](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), "Constants=w = 0.001");
    overrides.emplace_back("Body disc/Material=linear elastic");
    return read_problem<2>(SceneFile(path, overrides)).bodies[0].frame;
  };
  EXPECT_EQ(frame({}), Frame::initial);
  EXPECT_EQ(frame({"Constants=w = 0.01"}), Frame::current);
  for (const std::string end : {"0.01", "1"})
    EXPECT_EQ(frame({"Body disc/Initial velocity=-w*y + 0.0001; w*x",
                     "End time=" + end}),
              Frame::current);
  EXPECT_EQ(frame({"Loads/Gravity=0, -0.01"}), Frame::current);
  // 0.7 m away is the side, and 0.5 m the radius
  EXPECT_EQ(frame({"Body disc/Ball/Radius=0.6"}), Frame::current);
  EXPECT_EQ(frame({"Body disc/Ball/Radius=0.6",
                   "Boundaries/left=free",
                   "Boundaries/right=free",
                   "Boundaries/bottom=free",
                   "Boundaries/top=free"}),
            Frame::initial);
  EXPECT_EQ(frame({"Loads/Body force=0; 1e-9*t"}), Frame::current);
}



// On cells of several sizes that stay as they are the initial frame is taken,
// unless a free body would pass them.
TEST(Scenes, TheInitialFrameOnCellsOfSeveralSizes)
{
  const auto read = [](const std::string       &name,
                       std::vector<std::string> overrides) {
    for (const std::string level :
         {"Grid/Levels=1", "Grid/Refine=part", "Method/Kernel=auto"})
      overrides.push_back(level);
    return read_problem<2>(
      SceneFile(prm_folder() + "verification/" + name, overrides));
  };
  const std::string held = "slow_cantilever.prm", disc = "spinning_disc.prm";
  const std::string region = "Grid/Refine part/Where=0.2 - x";
  const Problem<2>  beam   = read(held, {region});
  EXPECT_EQ(beam.bodies[0].frame, Frame::initial);
  EXPECT_EQ(beam.grid.kernel, KernelKind::linear);
  for (const std::string changing : {"Grid/Refine part/Where=0.2 - x + t",
                                     "Grid/Refine part/Criterion=stress"})
    {
      const std::string scale = changing.find("stress") == std::string::npos ?
                                  region :
                                  "Grid/Refine part/Scale=9";
      const Problem<2>  other = read(held, {scale, changing});
      EXPECT_EQ(other.bodies[0].frame, Frame::current) << changing;
      EXPECT_EQ(other.grid.kernel, KernelKind::cpdi) << changing;
      try
        {
          read(held, {scale, changing, "Body beam/Frame=initial"});
          ADD_FAILURE() << changing;
        }
      catch (const InputError &error)
        {
          EXPECT_NE(
            std::string(error.what()).find("'Grid/Refine part' changes"),
            std::string::npos)
            << error.what();
        }
    }
  EXPECT_EQ(read(disc, {region}).bodies[0].frame, Frame::current);
  EXPECT_EQ(read(disc, {"Grid/Refine part/Criterion=surface"}).bodies[0].frame,
            Frame::initial);
}



TEST(Scenes, MetalsHaveSplinesAndWhatFlowsOnHasNot)
{
  const auto read = [](const std::string              &name,
                       const std::vector<std::string> &overrides) {
    return read_problem<2>(SceneFile(prm_folder() + name, overrides));
  };
  const std::string bar   = "verification/pulled_bar.prm";
  const Problem<2>  metal = read(bar, {});
  EXPECT_EQ(metal.grid.kernel, KernelKind::quadratic);
  EXPECT_EQ(metal.bodies[0].treatment, Treatment::none);
  EXPECT_EQ(metal.bodies[0].points_per_cell_edge[0], 3u);
  EXPECT_EQ(read(bar, {"Body bar/J2/Poisson's ratio=0.49"}).bodies[0].treatment,
            Treatment::node);
  EXPECT_EQ(read(bar, {"Body bar/J2/Viscosity=10"}).grid.kernel,
            KernelKind::linear);
  for (const std::string soil :
       {"benchmarks/slope_stability.prm", "verification/oedometer.prm"})
    EXPECT_EQ(read(soil, {"Method/Kernel=auto"}).grid.kernel,
              KernelKind::linear);
}



TEST(Scenes, EndAndOutputAreNotAmongTheFixedEntries)
{
  const std::string path = prm_folder() + "cantilever.prm";
  const auto        read = [&](const std::vector<std::string> &overrides) {
    return read_problem<2>(SceneFile(path, overrides));
  };
  const Problem<2> plain = read({}),
                   late  = read({"End time=70",
                                 "Output/Fields=none",
                                 "Checkpoint/Interval=60",
                                 "Checkpoint/Steps=7",
                                 "Checkpoint/Wall time limit=3400"}),
                   other = read({"Method/Courant number=0.3"});
  EXPECT_EQ(late.fixed_entries, plain.fixed_entries);
  EXPECT_NE(other.fixed_entries, plain.fixed_entries);
  EXPECT_EQ(plain.checkpoint.steps, 0u);
  EXPECT_EQ(late.checkpoint.steps, 7u);
  EXPECT_EQ(late.checkpoint.interval, 60);
  EXPECT_EQ(late.checkpoint.wall_time_limit, 3400);
}



TEST(Scenes, MissingFileIsWrongInput)
{
  try
    {
      SceneFile("nowhere/my-scene.prm");
      FAIL() << "A scene that does not exist was read.";
    }
  catch (const Failure &failure)
    {
      EXPECT_EQ(failure.code, ExitCode::wrong_input);
      EXPECT_NE(std::string(failure.what()).find("nowhere/my-scene.prm"),
                std::string::npos);
    }
}



TEST(Scenes, OriginalTextIsKept)
{
  const SceneFile scene = scene_of("# mine\nset Dimension = 2\n");
  EXPECT_EQ(scene.original_text(), "# mine\nset Dimension = 2\n");
  EXPECT_EQ(scene.original_name(), "original.prm");
}
