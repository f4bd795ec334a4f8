// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/file_shapes.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/words.h>

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

/**
 * @file The lists of choices that a scene has: each says all about its
 * entries, and what follows from a list is what it has to be.
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
                                         "Observable",
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
  const std::map<std::string, double> expected = {{"position", 2},
                                                  {"displacement", 3},
                                                  {"velocity", 4},
                                                  {"stress", 5},
                                                  {"pressure", 6},
                                                  {"volume ratio", 7},
                                                  {"momentum", 8},
                                                  {"centre of mass", 9},
                                                  {"kinetic energy", 10},
                                                  {"strain energy", 11},
                                                  {"total energy", 20},
                                                  {"extreme coordinate", 12},
                                                  {"reaction force", 13},
                                                  {"obstacle force", 13},
                                                  {"obstacle moment", 16},
                                                  {"frequency", 14},
                                                  {"state variable", 15},
                                                  {"largest state variable",
                                                   15}};
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



/** The last that holds a component counts. */
TEST(Choices, SidesThatMeetActInTheirOrder)
{
  Sides<3> sides;
  sides[0].held   = HeldComponents::all;
  sides[3].held   = HeldComponents::none;
  const auto held = held_components(sides, 1 << 0 | 1 << 3 | 1 << 4);
  ASSERT_EQ(held.size(), 4u);
  for (unsigned int d = 0; d < 3; ++d)
    {
      EXPECT_EQ(held[d].side, 0u);
      EXPECT_EQ(held[d].component, d);
    }
  EXPECT_EQ(held[3].side, 4u);
  EXPECT_EQ(held[3].component, 2u);
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
