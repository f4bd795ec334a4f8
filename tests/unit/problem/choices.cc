// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/file_shapes.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/words.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

/**
 * @file The lists of choices that a scene has: each says all about its
 * entries, and what follows from a list is what it has to be. Then what 'auto'
 * chooses of the kernel, and what the log says of it.
 */
using namespace limber;

namespace
{
  const std::string block = R"(
    set Bodies = block
    subsection Body block
      set Material = linear elastic
      subsection Linear elastic
        set Density = 1
        set Young's modulus = 1
      end
    end)";



  SceneFile
  scene_with(const std::string &text, const std::vector<std::string> &overrides)
  {
    return SceneFile(ParameterText{text, FileFormat::prm, "scene"}, overrides);
  }



  Problem<2>
  read(const std::vector<std::string> &overrides)
  {
    return read_problem<2>(
      SceneFile(ParameterText{block, FileFormat::prm, "scene"}, overrides));
  }
} // namespace



TEST(Choices, EveryTreatmentHasOneRowAndItsOwnWord)
{
  using P = Treatment;
  std::set<P>           kinds;
  std::set<std::string> words;
  for (const TreatmentRow &treatment : treatments)
    {
      EXPECT_TRUE(kinds.insert(treatment.kind).second);
      EXPECT_TRUE(words.insert(treatment.word).second);
    }
  EXPECT_EQ(kinds,
            (std::set<P>{P::automatic,
                         P::none,
                         P::cell,
                         P::cell_shear,
                         P::cell_full,
                         P::assumed_strain,
                         P::node,
                         P::hybrid}));
}



TEST(Choices, TreatmentsAverageWhatTheirWordsSay)
{
  struct
  {
    Treatment kind;
    bool      volume_around_nodes, volume_in_cells, shear_in_cells, means;
  } const cases[] = {{Treatment::none, false, false, false, false},
                     {Treatment::cell, false, true, false, true},
                     {Treatment::cell_shear, false, true, true, true},
                     {Treatment::cell_full, false, true, true, true},
                     {Treatment::assumed_strain, false, false, false, true},
                     {Treatment::node, true, false, false, false},
                     {Treatment::hybrid, true, false, true, true}};
  for (const auto &expected : cases)
    {
      const char *const word = treatment_of(expected.kind).word;
      EXPECT_EQ(averages_around_nodes(expected.kind),
                expected.volume_around_nodes)
        << word;
      EXPECT_EQ(averages_volume_in_cells(expected.kind),
                expected.volume_in_cells)
        << word;
      EXPECT_EQ(averages_shear_in_cells(expected.kind), expected.shear_in_cells)
        << word;
      EXPECT_EQ(needs_cell_means(expected.kind), expected.means) << word;
    }
}



TEST(Choices, ObservablesAreTheSameInTwoAndThreeDimensions)
{
  const std::set<std::string> entries = {"Body",
                                         "Location",
                                         "Direction",
                                         "Within",
                                         "Share beyond",
                                         "Observable",
                                         "From time",
                                         "Side",
                                         "Obstacle",
                                         "Variable"};
  const auto                 &in_2d   = observable_kinds<2>();
  const auto                 &in_3d   = observable_kinds<3>();
  std::set<std::string>       words;
  ASSERT_EQ(in_2d.size(), in_3d.size());
  for (std::size_t k = 0; k < in_2d.size(); ++k)
    {
      EXPECT_TRUE(words.insert(in_2d[k].word).second);
      EXPECT_EQ(in_2d[k].word, in_3d[k].word);
      EXPECT_EQ(in_2d[k].unit, in_3d[k].unit);
      EXPECT_EQ(&observable_kind<2>(in_2d[k].word), &in_2d[k]);
      for (const auto &list : {in_2d[k].required, in_2d[k].optional})
        for (const std::string &entry : list)
          EXPECT_EQ(entries.count(entry), 1u) << in_2d[k].word;
    }
}



TEST(Choices, ObservablesPickTheirPartOfWhatIsSeen)
{
  Observable<2> o;
  o.axis        = 1;
  o.second_axis = 0;
  Seen<2> seen;
  seen.position                                = dealii::Point<2>(1, 2);
  seen.displacement[1]                         = 3;
  seen.velocity[1]                             = 4;
  seen.stress[1][0]                            = 5;
  seen.pressure                                = 6;
  seen.volume_ratio                            = 7;
  seen.mass                                    = 2;
  seen.momentum[1]                             = 8;
  seen.mass_moment[1]                          = 18;
  seen.kinetic_energy                          = 10;
  seen.strain_energy                           = 11;
  seen.potential_energy                        = -1;
  seen.extent                                  = 12;
  seen.force[1]                                = 13;
  seen.frequency                               = 14;
  seen.variable                                = 15;
  seen.moment[2]                               = 16;
  seen.mean                                    = 17;
  seen.largest                                 = 18;
  seen.smallest                                = 19;
  const std::map<std::string, double> expected = {
    {"position", 2},         {"displacement", 3},
    {"velocity", 4},         {"stress", 5},
    {"pressure", 6},         {"volume ratio", 7},
    {"momentum", 8},         {"centre of mass", 9},
    {"kinetic energy", 10},  {"strain energy", 11},
    {"total energy", 20},    {"extreme coordinate", 12},
    {"reaction force", 13},  {"obstacle force", 13},
    {"obstacle moment", 16}, {"frequency", 14},
    {"state variable", 15},  {"largest state variable", 15},
    {"mass within", 2},      {"mean velocity", 4},
    {"mean stress", 5},      {"mean pressure", 6},
    {"mean over time", 17},  {"largest so far", 18},
    {"smallest so far", 19}};
  EXPECT_EQ(expected.size(), observable_kinds<2>().size());
  for (const auto &[word, value] : expected)
    EXPECT_EQ(observable_kind<2>(word).value(o, seen), value) << word;
}



TEST(Choices, SidesHoldWhatTheirWordsSay)
{
  using Held                 = HeldComponents;
  const std::string friction = "Boundaries/Side left/Friction coefficient=0.25";
  const std::string velocity = "Boundaries/Side left/Velocity=x; 3*t";
  struct
  {
    std::string word;
    Held        held;
    bool        one_sided, moves;
  } const cases[] = {{"free", Held::none, false, false},
                     {"slip", Held::normal, false, false},
                     {"no slip", Held::all, false, false},
                     {"separating", Held::normal, true, false},
                     {"friction", Held::normal, true, false},
                     {"velocity", Held::all, false, true}};
  for (const auto &expected : cases)
    {
      const Side<2> side =
        read({"Boundaries/left=" + expected.word, friction, velocity}).sides[0];
      EXPECT_EQ(side.word, expected.word);
      EXPECT_EQ(side.held, expected.held) << expected.word;
      EXPECT_EQ(side.one_sided, expected.one_sided) << expected.word;
      EXPECT_EQ(side.friction, expected.word == "friction" ? 0.25 : 0)
        << expected.word;
      EXPECT_EQ(side.prescribed_velocity(dealii::Point<2>(5, 0), 2, 1),
                expected.moves ? 6 : 0)
        << expected.word;
    }
}



/** They act in their order, but the velocity through a side is held by this
 * one alone, if it lets nothing go. */
TEST(Choices, SidesThatMeetHoldWhatGoesThroughThem)
{
  Sides<3> sides;
  sides[0].held = HeldComponents::all;
  sides[3].held = HeldComponents::none;
  for (const bool one_sided : {false, true})
    {
      sides[4].one_sided = one_sided;
      const auto held    = held_components(sides, 1 << 0 | 1 << 3 | 1 << 4);
      ASSERT_EQ(held.size(), one_sided ? 4u : 3u);
      for (unsigned int d = 0; d < held.size() - 1; ++d)
        {
          EXPECT_EQ(held[d].side, 0u);
          EXPECT_EQ(held[d].component, d);
        }
      EXPECT_EQ(held.back().side, 4u);
      EXPECT_EQ(held.back().component, 2u);
    }
}



TEST(Choices, EveryShapeFillsSomethingAsItIsDeclared)
{
  const std::set<std::string> from_files = {
    "polygon", "stl", "mesh", "image", "point list"};
  std::set<std::string> words;
  for (const auto &shape : shape_words())
    {
      EXPECT_TRUE(words.insert(shape.word).second);
      if (shape.word == "union" || shape.word == "cylinder" ||
          from_files.count(shape.word) > 0)
        continue; // needs parts, needs three dimensions, needs a file
      const auto problem = read({"Body block/Shape=" + shape.word,
                                 "Body block/Formula/Inside=x - 0.1"});
      EXPECT_TRUE(problem.bodies[0].shape->contains(dealii::Point<2>(0.5, 0.5)))
        << shape.word;
    }
  EXPECT_EQ(words.size(),
            std::tuple_size_v<ShapeList<2>> + from_files.size() + 1);
  EXPECT_EQ(from_files.size(), std::tuple_size_v<FileShapeList<2>>);
}



// On cells of several sizes solids have neither the initial frame nor splines,
// and creep with linear functions: a bar under tension stretches by a third too
// far.
TEST(Choices, KernelOfSolidsOverLevels)
{
  const auto kernel = [](std::vector<std::string> changes) {
    changes.push_back("Grid/Levels=1");
    changes.push_back("Grid/Refine=region");
    changes.push_back("Grid/Refine region/Upper corner=1, 1");
    return read_problem<2>(scene_with(R"(
      set Bodies = bar
      subsection Body bar
      end
      subsection Grid
        set Cells = 10, 10
      end)",
                                      changes))
      .grid.kernel;
  };
  EXPECT_EQ(kernel({}), KernelKind::cpdi);
  EXPECT_EQ(kernel({"Body bar/Material=j2", "Body bar/J2/Yield stress=1e5"}),
            KernelKind::cpdi);
  EXPECT_EQ(kernel({"Body bar/Material=drucker prager",
                    "Body bar/Drucker prager/Friction angle=30"}),
            KernelKind::linear); // flows without end
  EXPECT_EQ(kernel({"Body bar/Material=newtonian fluid"}), KernelKind::linear);
  EXPECT_EQ(kernel({"Method/Transfer=apic"}), KernelKind::linear);
  EXPECT_EQ(kernel({"Grid/Join points=true"}), KernelKind::linear);
  EXPECT_EQ(kernel({"Body bar/Locking treatment=assumed strain"}),
            KernelKind::linear);
}



// The cells that count are the fine ones, where all of the body has them.
TEST(Choices, TreatmentFollowsTheCellsAcrossTheBody)
{
  const auto treatment = [](const std::string       &cells,
                            std::vector<std::string> changes) {
    changes.push_back("Grid/Cells=" + cells);
    changes.push_back("Body block/Box/Upper corner=1, 0.3");
    changes.push_back("Body block/Linear elastic/Poisson's ratio=0.499");
    changes.push_back("Body block/Frame=initial");
    changes.push_back("Method/Kernel=linear");
    return read(changes).bodies[0].treatment;
  };
  EXPECT_EQ(treatment("8, 8", {}), Treatment::assumed_strain);
  EXPECT_EQ(treatment("16, 16", {}), Treatment::cell);
  EXPECT_EQ(treatment("8, 8",
                      {"Grid/Levels=1",
                       "Grid/Refine=all",
                       "Grid/Refine all/Criterion=body",
                       "Grid/Refine all/Bodies=block"}),
            Treatment::cell);
  EXPECT_EQ(treatment("8, 8",
                      {"Grid/Levels=1",
                       "Grid/Refine=half",
                       "Grid/Refine half/Upper corner=0.5, 1"}),
            Treatment::assumed_strain);
}



// Splines where bodies may bend across the cells
TEST(Choices, KernelInTheInitialFrameFollowsTheFaces)
{
  const auto kernel_and_notes = [](const std::vector<std::string> &changes) {
    const auto  problem = read_problem<2>(scene_with(R"(
      set Bodies = block
      subsection Body block
        set Frame = initial
      end
      subsection Grid
        set Lower corner = -0.3, 0
        set Upper corner = 1.7, 2
        set Cells = 20, 20
      end
      subsection Boundaries
        set left = free
        set right = free
        set top = free
        set bottom = no slip
      end)",
                                                    changes));
    std::string notes;
    for (const std::string &note : problem.notes)
      notes += note + "\n";
    return std::make_pair(problem.grid.kernel, notes);
  };
  const std::string block = "Body block/Shape=block";
  const std::string tilted =
    "Body block/Block/Corners=0.5, 0; 1, 0; 1.5, 1; 1, 1";
  const std::string warning = "bends across the cells";
  EXPECT_EQ(kernel_and_notes({}).first, KernelKind::linear);
  EXPECT_EQ(kernel_and_notes({block}).first, KernelKind::linear);
  // not where nothing holds it, and it may spin
  EXPECT_EQ(kernel_and_notes({"Body block/Shape=ball",
                              "Body block/Ball/Centre=1, 1",
                              "Body block/Ball/Radius=0.4"})
              .first,
            KernelKind::linear);
  EXPECT_EQ(kernel_and_notes({block, tilted, "Boundaries/bottom=free"}).first,
            KernelKind::linear);
  // but if it is slender and does not spin
  const std::string strip =
    "Body block/Block/Corners=0.5, 0.5; 1.3, 1.3; 1.2, 1.4; 0.4, 0.6";
  const std::string spin = "Body block/Initial velocity=1 - y; x - 1";
  EXPECT_EQ(kernel_and_notes({block, strip, "Boundaries/bottom=free"}).first,
            KernelKind::quadratic);
  EXPECT_EQ(
    kernel_and_notes({block, strip, spin, "Boundaries/bottom=free"}).first,
    KernelKind::linear);
  EXPECT_EQ(kernel_and_notes({block, tilted}).first, KernelKind::quadratic);
  EXPECT_EQ(kernel_and_notes({block, tilted}).second.find(warning),
            std::string::npos);
  EXPECT_NE(kernel_and_notes({block, tilted, "Method/Kernel=linear"})
              .second.find(warning),
            std::string::npos);
  const auto at_rest =
    kernel_and_notes({block, tilted, "Method/Time integration=quasi-static"});
  EXPECT_EQ(at_rest.first, KernelKind::quadratic);
  EXPECT_EQ(at_rest.second.find(warning), std::string::npos);
  // Newton's method knows no splines there
  const auto current =
    kernel_and_notes({block,
                      tilted,
                      "Body block/Frame=current",
                      "Method/Time integration=quasi-static"});
  EXPECT_EQ(current.first, KernelKind::linear);
  EXPECT_NE(current.second.find(warning), std::string::npos);
  EXPECT_EQ(kernel_and_notes({"Method/Kernel=linear"}).second.find(warning),
            std::string::npos);
}



// The initial frame for what stays together, and does not flow far.
TEST(Choices, FrameFollowsTheStepsAndWhatIsOnePiece)
{
  const std::string metal = "Body lower/Material=j2",
                    soil  = "Body lower/Material=drucker prager";
  const auto frames       = [&](std::vector<std::string> changes) {
    const auto has = [&](const std::string &change) {
      return std::count(changes.begin(), changes.end(), change) > 0;
    };
    if (has(metal))
      changes.push_back("Body lower/J2/Yield stress=1e5");
    if (has(soil))
      changes.push_back("Body lower/Drucker prager/Friction angle=30");
    const auto problem = read_problem<2>(scene_with(R"(
      set Bodies = lower, upper
      subsection Body lower
        subsection Box
          set Upper corner = 1, 0.5
        end
      end
      subsection Body upper
        subsection Box
          set Lower corner = 0, 0.5
        end
      end
      subsection Grid
        set Upper corner = 2, 2
        set Cells = 20, 20
      end
      subsection Boundaries
        set left = free
        set right = free
        set top = free
        set bottom = no slip
      end
      subsection Method
        set Time integration = quasi-static
        set Time step = 0.1
      end)",
                                                    changes));
    EXPECT_EQ(problem.bodies[0].frame, problem.bodies.back().frame);
    EXPECT_EQ(problem.bodies[0].points_per_cell_edge[0],
              problem.bodies[0].frame == Frame::current &&
                  problem.method.integration !=
                    TimeIntegration::explicit_steps ?
                      3 :
                      2);
    return problem.bodies[0].frame;
  };
  const std::string implicit   = "Method/Time integration=implicit",
                    explicitly = "Method/Time integration=explicit",
                    no_step    = "Method/Time step=0",
                    linear     = "Method/Kernel=linear";
  EXPECT_EQ(frames({}), Frame::initial);
  EXPECT_EQ(frames({implicit}), Frame::initial);
  EXPECT_EQ(frames({explicitly, no_step, linear}), Frame::current);
  // apart by more than a cell
  EXPECT_EQ(frames({"Body upper/Box/Lower corner=0, 0.7"}), Frame::current);
  EXPECT_EQ(frames({"Body upper/Frame=current"}), Frame::current);
  EXPECT_EQ(frames({"Body upper/Initial stress=xx: 1", "Loads/Load factor=1"}),
            Frame::current);
  EXPECT_EQ(frames({metal}), Frame::initial);
  EXPECT_EQ(frames({soil}), Frame::initial);
  EXPECT_EQ(frames({metal, implicit}), Frame::initial);
  EXPECT_EQ(frames({soil, implicit}), Frame::current);
}



// Water beside obstacles has the mass of what it fills, whatever tells the
// shape.
TEST(Choices, LiquidsBesideObstaclesAreCutWhateverTheirShape)
{
  const auto placement = [](const std::vector<std::string> &changes) {
    return read_problem<2>(scene_with(R"(
      set Bodies = water
      subsection Body water
        set Material = newtonian fluid
      end
      set Obstacles = floor
      subsection Obstacle floor
        set Shape = half-space
        subsection Half-space
          set Point = 0, 0.1
        end
      end
      subsection Grid
        set Cells = 10, 10
      end)",
                                      changes))
      .bodies[0]
      .placement;
  };
  EXPECT_EQ(placement({}), Placement::regular); // a box of whole parts
  EXPECT_EQ(placement({"Body water/Shape=union",
                       "Body water/Union/Shapes=part",
                       "Body water/Union/Shape part/Shape=ball"}),
            Placement::cut);
  EXPECT_EQ(placement({"Body water/Shape=ball"}), Placement::cut);
}



TEST(Choices, KernelOfScenesWithALiquidIsLinear)
{
  const auto grid = [](const std::vector<std::string> &changes) {
    return read_problem<2>(scene_with(R"(
      set Bodies = block, water
      subsection Body block
        subsection Box
          set Lower corner = 0, 0.5
        end
      end
      subsection Body water
        set Material = newtonian fluid
        subsection Box
          set Upper corner = 1, 0.5
        end
      end
      subsection Grid
        set Cells = 10, 10
      end)",
                                      changes))
      .grid;
  };
  EXPECT_EQ(grid({}).kernel, KernelKind::linear);
  // what 'auto' would not take is known of given kernels as well
  EXPECT_NE(grid({"Method/Kernel=linear"}).against_splines.find("lose volume"),
            std::string::npos);
  EXPECT_EQ(grid({"Body water/Material=linear elastic"}).against_splines, "");
  // which keep the volume of liquids with splines
  EXPECT_EQ(grid({"Method/Transfer=aflip"}).kernel, KernelKind::quadratic);
  EXPECT_EQ(grid({"Body water/Material=linear elastic"}).kernel,
            KernelKind::quadratic);
}



// What has no effect is noted, if the word that chooses it is given.
TEST(Choices, EntriesWithoutEffectAreNoted)
{
  const auto warnings = [](const std::string &material) {
    return SceneFile(ParameterText{"set Bodies = block\nsubsection Body block\n"
                                   "set Material = " +
                                     material +
                                     "\n subsection J2\n set Yield stress = "
                                     "7\n set Density = 1000\n end\n end\n",
                                   FileFormat::prm,
                                   "scene"},
                     {})
      .warnings();
  };
  EXPECT_TRUE(warnings("j2").empty());
  ASSERT_EQ(warnings("neo hookean").size(), 1u);
  EXPECT_EQ(warnings("neo hookean").front(),
            "Section 'Body block/J2' has no effect, as 'Material' is 'neo "
            "hookean'.");
}



// Entries of Newton's method in explicit steps: noted if these were chosen,
// refused if nothing was.
TEST(Choices, EntriesOfNewtonStepsAreNotedInExplicitOnes)
{
  const auto warnings = [](const std::string &integration,
                           const std::string &entry) {
    return SceneFile(ParameterText{"set Bodies = block\nsubsection Body "
                                   "block\nend\nsubsection Method\n" +
                                     integration + "set " + entry + "\nend\n",
                                   FileFormat::prm,
                                   "scene"},
                     {})
      .warnings();
  };
  const std::string tolerance = "Newton tolerance = 1e-8",
                    penalty   = "Ghost penalty = 0.1";
  const auto chosen           = [](const std::string &word) {
    return "set Time integration = " + word + "\n";
  };
  EXPECT_TRUE(warnings(chosen("quasi-static"), tolerance).empty());
  EXPECT_TRUE(warnings(chosen("implicit"), tolerance).empty());
  EXPECT_TRUE(warnings(chosen("quasi-static"), penalty).empty());
  for (const auto &[word, entry] : {std::make_pair("explicit", tolerance),
                                    std::make_pair("semi-implicit", tolerance),
                                    std::make_pair("explicit", penalty),
                                    std::make_pair("implicit", penalty)})
    {
      const auto found = warnings(chosen(word), entry);
      ASSERT_EQ(found.size(), 1u) << word << entry;
      EXPECT_NE(found.front().find("has no effect, as 'Time integration' is"),
                std::string::npos)
        << found.front();
    }
  EXPECT_THROW(warnings("", tolerance), InputError);
}



// Other steps are refused a radius rather than run without.
TEST(Choices, SpectralRadiusIsOfImplicitStepsAlone)
{
  const auto read = [](const std::string &integration) {
    return read_problem<2>(
      SceneFile(ParameterText{"set Bodies = block\nsubsection Body "
                              "block\nend\nsubsection Method\nset Time "
                              "integration = " +
                                integration +
                                "\nset Time step = 0.1\nset Spectral radius "
                                "at infinity = 0.8\nend\n",
                              FileFormat::prm,
                              "scene"},
                {}));
  };
  EXPECT_EQ(read("implicit").method.spectral_radius, 0.8);
  for (const std::string word :
       {"explicit", "semi-implicit", "auto", "quasi-static"})
    try
      {
        read(word);
        ADD_FAILURE() << word;
      }
    catch (const InputError &refusal)
      {
        EXPECT_NE(std::string(refusal.what()).find("damps implicit steps"),
                  std::string::npos)
          << refusal.what();
      }
}



// A bar along an axis or across, four or eight cells thick; splines are worse.
TEST(Choices, SlowTorsionIsNoted)
{
  const auto is_noted = [](const std::vector<std::string> &changes) {
    const auto problem = read_problem<3>(scene_with(R"(
      set Dimension = 3
      set Bodies = bar
      subsection Body bar
        subsection Box
          set Lower corner = 0, 1, 1
          set Upper corner = 4, 2, 2
        end
      end
      subsection Grid
        set Upper corner = 5, 3, 3
        set Cells = 20, 12, 12
      end
      subsection Boundaries
        set left = no slip
        set right = free
        set top = free
        set bottom = free
        set front = free
        set back = free
      end)",
                                                    changes));
    return std::any_of(problem.notes.begin(),
                       problem.notes.end(),
                       [](const std::string &note) {
                         return note.find("in torsion") != std::string::npos;
                       });
  };
  EXPECT_TRUE(is_noted({}));
  EXPECT_TRUE(
    is_noted({"Method/Time integration=implicit", "Method/Time step=0.1"}));
  EXPECT_FALSE(is_noted({"Method/Time integration=quasi-static"}));
  EXPECT_FALSE(is_noted({"Boundaries/left=free"}));
  EXPECT_FALSE(is_noted({"Grid/Cells=40, 24, 24"}));
  EXPECT_FALSE(is_noted({"Grid/Cells=30, 18, 18"}));
  EXPECT_TRUE(is_noted({"Grid/Cells=30, 18, 18", "Method/Kernel=quadratic"}));
  // as thick as long, and a plate
  EXPECT_FALSE(is_noted({"Body bar/Box/Upper corner=1, 2, 2"}));
  EXPECT_FALSE(is_noted({"Body bar/Box/Lower corner=0, 0, 1.5"}));
  // turned by 45 degrees
  EXPECT_TRUE(
    is_noted({"Body bar/Shape=block",
              "Body bar/Block/Corners=0, 0, 1; 2.1, 2.1, 1; 1.4, 2.8, 1; 0, "
              "1.4, 1; 0, 0, 2; 2.1, 2.1, 2; 1.4, 2.8, 2; 0, 1.4, 2",
              "Grid/Cells=20, 12, 12"}));
}



// Tension is not given by cohesion alone: the log says how much could be borne.
TEST(Choices, CohesionWithoutTensionIsTold)
{
  const auto told = [](std::vector<std::string> changes) {
    changes.emplace_back("Body block/Material=drucker prager");
    changes.emplace_back("Body block/Drucker prager/Friction angle=45");
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("'Tensile strength' gives it some, at most 500 Pa") !=
             std::string::npos;
    });
  };
  const std::string law = "Body block/Drucker prager/";
  EXPECT_TRUE(told({law + "Cohesion=500"}));
  EXPECT_FALSE(told({law + "Cohesion=500", law + "Tensile strength=100"}));
  EXPECT_FALSE(told({}));
}



// Rows for explicit steps are too rare for implicit ones.
TEST(Choices, RareRowsForAFrequencyAreTold)
{
  const auto told = [](std::vector<std::string> changes) {
    for (const char *const change : {"Observables=height, swings",
                                     "Observable height/Type=centre of mass",
                                     "Observable height/Direction=y",
                                     "Observable swings/Type=frequency",
                                     "Observable swings/Observable=height"})
      changes.emplace_back(change);
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("swings shorter than 40 of them") != std::string::npos;
    });
  };
  const std::string rare     = "Output/Statistics interval=10",
                    implicit = "Method/Time integration=implicit",
                    step     = "Method/Time step=0.1";
  EXPECT_TRUE(told({rare, implicit, step}));
  EXPECT_FALSE(told({implicit, step}));
  EXPECT_FALSE(told({rare}));
}



// A solid that turns through cells loses its spin with FLIP.
TEST(Choices, RotationInTheCurrentFrameIsTold)
{
  const auto told = [](std::vector<std::string> changes) {
    changes.emplace_back("End time=1");
    changes.emplace_back("Method/Kernel=quadratic");
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("makes 0.5 turns") != std::string::npos &&
             note.find("'Method/Transfer = aflip'") != std::string::npos;
    });
  };
  const std::string spin    = "Body block/Initial velocity=7 - pi*y; pi*x",
                    current = "Body block/Frame=current";
  EXPECT_TRUE(told({spin, current}));
  EXPECT_FALSE(told({spin, current, "Method/Transfer=aflip"}));
  EXPECT_FALSE(told({spin, "Body block/Frame=initial"}));
  EXPECT_FALSE(told({"Body block/Initial velocity=pi*x; -pi*y", current}));
}



// Linear functions that the scene asks for creep, whatever the transfer.
TEST(Choices, CreepOfLinearFunctionsIsTold)
{
  const auto told = [](std::vector<std::string> changes,
                       const bool               is_loaded = true) {
    if (is_loaded)
      changes.insert(changes.begin(),
                     {"Loads/Face loads=pull",
                      "Loads/Face load pull/Body=block",
                      "Loads/Face load pull/Face=right",
                      "Loads/Face load pull/Traction=1; 0"});
    changes.insert(changes.begin(),
                   {"Body block/Frame=current",
                    "Body block/Initial velocity=3; 0",
                    "Grid/Cells=10, 10",
                    "End time=1",
                    "Method/Kernel=linear"});
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("'block' is under load") != std::string::npos &&
             note.find("creeps") != std::string::npos &&
             note.find("'Method/Kernel = quadratic'") != std::string::npos;
    });
  };
  EXPECT_TRUE(told({}));
  EXPECT_TRUE(told({"Method/Transfer=apic"}));
  EXPECT_TRUE(told({"Method/Transfer=fmpm"}));
  EXPECT_FALSE(told({"Method/Kernel=quadratic"}));
  EXPECT_FALSE(told({"Method/Kernel=auto"}));
  EXPECT_FALSE(told({"Body block/Frame=initial"}));
  EXPECT_FALSE(told({"Body block/Initial velocity=0.01; 0"}));
  EXPECT_FALSE(told({}, /*is_loaded=*/false));
}



// At first order in the step 'usavg' spins it up.
TEST(Choices, SpinFromTheStressUpdateIsTold)
{
  const auto told = [](std::vector<std::string> changes) {
    changes.emplace_back("End time=1");
    changes.emplace_back("Body block/Initial velocity=7 - pi*y; pi*x");
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("pi w dt of its spin") != std::string::npos;
    });
  };
  const std::string usavg   = "Method/Stress update=usavg",
                    current = "Body block/Frame=current";
  EXPECT_TRUE(told({usavg, current}));
  EXPECT_FALSE(told({usavg, "Body block/Frame=initial"}));
  EXPECT_FALSE(told({"Method/Stress update=musl", current}));
}



// What fills its box between slip sides can go nowhere.
TEST(Choices, ABodyThatFillsItsBoxKeepsItsFrame)
{
  const auto frame = [](const std::vector<std::string> &changes) {
    return read_problem<2>(scene_with(R"(
      set Bodies = block
      subsection Body block
        set Initial velocity = 0.1*sin(pi*x); 0
        subsection Box
          set Upper corner = 1, 1
        end
      end
      subsection Boundaries
        set left   = slip
        set right  = slip
        set top    = slip
        set bottom = slip
      end)",
                                      changes))
      .bodies[0]
      .frame;
  };
  EXPECT_EQ(frame({}), Frame::initial);
  EXPECT_EQ(frame({"Body block/Box/Upper corner=1, 0.9"}), Frame::current);
  EXPECT_EQ(frame({"Boundaries/top=separating"}), Frame::current);
}



// Two solids that are apart and in no pair would stick together.
TEST(Choices, SolidsApartInNoPairAreTold)
{
  const auto told = [](std::vector<std::string> changes) {
    for (const char *const change : {"Bodies=block, other",
                                     "Body other/Material=linear elastic",
                                     "Body other/Box/Lower corner=0, 2",
                                     "Body other/Box/Upper corner=1, 2.5"})
      changes.insert(changes.begin(), change);
    changes.emplace_back("Grid/Upper corner=4, 4");
    changes.emplace_back("Body block/Box/Lower corner=0, 0");
    changes.emplace_back("Body block/Box/Upper corner=1, 1");
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("Bodies 'block' and 'other' are apart and in no pair") !=
             std::string::npos;
    });
  };
  EXPECT_TRUE(told({}));
  EXPECT_FALSE(told({"Body other/Box/Lower corner=0, 1"})); // on top
  EXPECT_FALSE(told({"Contact/Pairs=both",
                     "Contact/Pair both/Bodies=block, other",
                     "Contact/Pair both/Law=stick"}));
  EXPECT_FALSE(told({"Body other/Material=newtonian fluid"}));
}



// In the initial frame with linear functions it turns too slowly, the less so
// the smaller the cells.
TEST(Choices, LagOfASpinIsTold)
{
  const auto told = [](std::vector<std::string> changes) {
    for (const char *const change :
         {"End time=1",
          "Body block/Frame=initial",
          "Body block/Initial velocity=7 - pi*y; pi*x"})
      changes.emplace_back(change);
    const auto notes = read(changes).notes;
    return std::any_of(notes.begin(), notes.end(), [](const auto &note) {
      return note.find("falls behind by about") != std::string::npos;
    });
  };
  EXPECT_TRUE(told({"Grid/Cells=8, 8"}));
  EXPECT_FALSE(told({"Grid/Cells=200, 200"}));
  EXPECT_FALSE(told({"Grid/Cells=8, 8", "Method/Transfer=aflip"}));
  EXPECT_FALSE(told({"Grid/Cells=8, 8", "Method/Kernel=quadratic"}));
  EXPECT_FALSE(told({"Grid/Cells=8, 8",
                     "Method/Time integration=implicit",
                     "Method/Time step=0.1"}));
}



// What the note on a lag proposes, no warning says is unstable.
TEST(Choices, RemedyForALagGoesWithThePlacement)
{
  const auto says = [](const std::vector<std::string> &notes,
                       const std::string              &words) {
    return std::any_of(notes.begin(), notes.end(), [&](const auto &note) {
      return note.find(words) != std::string::npos;
    });
  };
  const std::string aflip = "'Method/Transfer = aflip'";
  for (const std::string placement : {"regular", "gauss", "cut", "fitted"})
    {
      std::vector<std::string> scene = {
        "End time=1",
        "Grid/Cells=8, 8",
        "Method/Kernel=linear",
        "Body block/Frame=initial",
        "Body block/Placement=" + placement,
        "Body block/Initial velocity=7 - pi*y; pi*x"};
      const auto notes = read(scene).notes;
      EXPECT_TRUE(says(notes, "falls behind by about")) << placement;
      scene.emplace_back("Method/Transfer=aflip");
      EXPECT_NE(says(notes, aflip), says(read(scene).notes, "is unstable"))
        << placement;
    }
}



// The largest of blocks at any place, as computed, are 0.33 and 0.24 with GIMP
// and 0.40 with splines (doc/theory/kernels.md).
TEST(Choices, CourantNumberIsOneThatTheFilterHolds)
{
  const auto courant_number = [](std::vector<std::string> overrides,
                                 const std::string       &transfer) {
    overrides.push_back("Body block/Frame=current");
    overrides.push_back("Method/Transfer=" + transfer);
    const auto problem = read(overrides);
    const bool said =
      std::any_of(problem.notes.begin(),
                  problem.notes.end(),
                  [](const std::string &note) {
                    return note.find("is lowered to") != std::string::npos;
                  });
    EXPECT_EQ(said, problem.method.courant_number != 0.4);
    return problem.method.courant_number;
  };
  for (const std::string kernel : {"gimp", "cpgimp", "cpdi", "quadratic"})
    EXPECT_EQ(courant_number({"Method/Kernel=" + kernel}, "flip"), 0.4);
  EXPECT_EQ(courant_number({"Method/Kernel=quadratic"}, "xpic"), 0.4);
  EXPECT_EQ(courant_number({"Method/Kernel=cubic"}, "fmpm"), 0.4);
  EXPECT_EQ(courant_number({"Method/Kernel=linear"}, "fmpm"), 0.4);
  EXPECT_EQ(courant_number({"Method/Kernel=gimp", "Method/Time step=1e-3"},
                           "fmpm"),
            0.4);
  EXPECT_NEAR(courant_number({"Method/Kernel=quadratic"}, "fmpm"), 0.33, 0.01);
  EXPECT_NEAR(courant_number({"Method/Time integration=semi-implicit",
                              "Body block/Locking treatment=cell"},
                             "fmpm"),
              0.2,
              1e-12);
  const std::string two = "Body block/Points per cell edge=2";
  EXPECT_NEAR(courant_number({"Method/Kernel=gimp", two}, "fmpm"), 0.25, 0.01);
  EXPECT_NEAR(courant_number(
                {"Method/Kernel=gimp", two, "Method/Transfer order=8"}, "fmpm"),
              0.19,
              0.01);
}



// What a note says of several bodies is one line; of single ones it stays.
TEST(Choices, NotesOfSeveralBodiesAreOneLine)
{
  const std::string two_blocks = R"(
    set Bodies = one, other
    subsection Body one
      set Material = linear elastic
      subsection Box
        set Upper corner = 0.25, 1
      end
    end
    subsection Body other
      set Material = linear elastic
      subsection Box
        set Lower corner = 0.75, 0
      end
    end)";
  std::string       notes;
  for (const std::string &note :
       read_problem<2>(scene_with(two_blocks, {})).notes)
    notes += note + "\n";
  EXPECT_NE(notes.find("Bodies 'one', 'other': frame 'auto' is"),
            std::string::npos)
    << notes;
  EXPECT_EQ(notes.find("Body 'one': frame"), std::string::npos) << notes;
  EXPECT_EQ(notes.find("Body 'other': frame"), std::string::npos) << notes;
}



// A load that is a formula of t acts as it is written.
TEST(Choices, LoadFactorOfLoadsThatDependOnTime)
{
  const auto factor_at_half = [](const std::string &traction,
                                 const std::string &factor) {
    const Problem<2> problem =
      read_problem<2>(scene_with(block,
                                 {"Method/Time integration=quasi-static",
                                  "Boundaries/bottom=no slip",
                                  "End time=2",
                                  "Loads/Face loads=top",
                                  "Loads/Load factor=" + factor,
                                  "Loads/Face load top/Body=block",
                                  "Loads/Face load top/Face=top",
                                  "Loads/Face load top/Traction=" + traction}));
    return problem.loads.factor.empty() ? -1 :
                                          problem.loads.factor.value({}, 1);
  };
  EXPECT_EQ(factor_at_half("1; 0", "auto"), -1); // t / 'End time'
  EXPECT_EQ(factor_at_half("t; 0", "auto"), 1);
  EXPECT_EQ(factor_at_half("t; 0", "t/4"), 0.25);
}
