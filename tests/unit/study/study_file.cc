// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/study/study_file.h>
#include <limber/study/variants.h>

#include <gtest/gtest.h>

#include <fstream>

using namespace limber;

namespace
{
  const std::string good = R"(
    set Scene = scenes/beam.prm
    set Settings = Method/Transfer=flip | End time=2
    set Short settings = End time=1
    set Methods = locked, cured
    set Short methods = cured
    set Variations = cells, speed, points
    set Measures = energy
    subsection Method cured
      set Settings = Body beam/Locking treatment=cell
      set Closed form = 2*x
    end
    subsection Variation cells
      set Entry = Grid/Cells
      set Values = 9, 5 | 18, 10 | 36, 20
      set Labels = 1 | 2 | 4
      set Short = 4
    end
    subsection Variation speed
      set Entry = Body beam/Constants
      set Values = a = 1, b = 2 | a = 2, b = 2
    end
    subsection Variation points
      set With = cells
      set Entry = Body beam/Points per cell edge
      set Values = 4 | 3 | 2
    end
    subsection Measure energy
      set Source = column
      set Name = kinetic energy, strain energy
      set Reduction = last over first
      set Reference = 1
    end
    subsection Chart
      set Horizontal axis = cells
      set Methods = cured
      set Measures = energy
    end)";



  StudyFile
  read(const std::string              &text,
       const std::vector<std::string> &overrides  = {},
       const bool                      take_short = false)
  {
    const std::string path = testing::TempDir() + "study_under_test.prm";
    std::ofstream(path) << text;
    return read_study(path, overrides, take_short);
  }



  std::string
  error_of(const std::string &text, const bool take_short = false)
  {
    try
      {
        read(text, {}, take_short);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  std::string
  replaced(const std::string &what, const std::string &with)
  {
    std::string text  = good;
    const auto  place = text.find(what);
    EXPECT_NE(place, std::string::npos) << what;
    return text.replace(place, what.size(), with);
  }
} // namespace



TEST(StudyFile, AllParts)
{
  const StudyFile study = read(good);
  EXPECT_EQ(study.scene, testing::TempDir() + "scenes/beam.prm");
  EXPECT_EQ(study.directory, "studies/study_under_test");
  EXPECT_EQ(study.settings.size(), 2u);
  ASSERT_EQ(study.methods.size(), 2u);
  EXPECT_TRUE(study.methods[0].closed_form.empty());
  EXPECT_EQ(study.methods[1].closed_form.value({3, 0}, 0), 6);
  ASSERT_EQ(study.variations.size(), 2u); // the third goes with the first
  EXPECT_EQ(study.variations[0].choices[1].label, "2");
  EXPECT_EQ(study.variations[0].choices[1].settings,
            (std::vector<std::string>{"Grid/Cells=18, 10",
                                      "Body beam/Points per cell edge=3"}));
  EXPECT_EQ(study.variations[1].choices[0].label, "a = 1, b = 2");
  EXPECT_EQ(study.measures[0].of.size(), 2u);
  EXPECT_EQ(study.measures[0].reference, 1);
  EXPECT_FALSE(is_compared(study));
}



TEST(StudyFile, Comparison)
{
  const std::string text =
    replaced("set Source = column\n      set Name = kinetic energy, strain "
             "energy\n      set Reduction = last over first\n      set "
             "Reference = 1",
             "set Source = comparison\n set Name = velocity") +
    R"(
    subsection Comparison
      set With = points
      set Settings = Grid/Cells=72, 40
      set Short settings = Grid/Cells=36, 20
    end)";
  const StudyFile study = read(text);
  EXPECT_TRUE(is_compared(study));
  EXPECT_TRUE(study.measures[0].has_error());
  EXPECT_EQ(study.comparison.with, Standard::points);
  EXPECT_EQ(study.comparison.settings.size(), 1u);
  EXPECT_EQ(read(text, {}, true).comparison.settings.back(),
            "Grid/Cells=36, 20");
}



// One reference cannot be that of several problems.
TEST(StudyFile, AComparisonIsOfOneProblem)
{
  std::string text =
    replaced("set Source = column\n      set Name = kinetic energy, strain "
             "energy\n      set Reduction = last over first\n      set "
             "Reference = 1",
             "set Source = comparison\n set Name = velocity");
  const std::string entry = "set Entry = Body beam/Constants";
  text.replace(text.find(entry),
               entry.size(),
               entry + "\n set Another problem = true");
  const std::string with_reference = R"(
    subsection Comparison
      set With = reference
    end)",
                    with_exact     = R"(
    subsection Comparison
      set With = exact
    end)";
  try
    {
      standard_of(read(text + with_reference));
      ADD_FAILURE() << "is accepted";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("'Another problem = true'"),
                std::string::npos)
        << error.what();
    }
  EXPECT_FALSE(standard_of(read(text + with_exact)));
}



TEST(StudyFile, ShortVersion)
{
  const StudyFile study = read(good, {}, true);
  EXPECT_EQ(study.settings.back(), "End time=1");
  ASSERT_EQ(study.methods.size(), 1u);
  EXPECT_EQ(study.methods[0].choice.label, "cured");
  ASSERT_EQ(study.variations[0].choices.size(), 1u);
  EXPECT_EQ(study.variations[0].choices[0].settings.back(),
            "Body beam/Points per cell edge=2");
}



TEST(StudyFile, CommandLineCounts)
{
  const StudyFile study = read(good, {"Directory=elsewhere", "Cost=steps"});
  EXPECT_EQ(study.directory, "elsewhere");
  EXPECT_EQ(study.cost, Cost::steps);
}



TEST(StudyFile, WrongInputIsRefused)
{
  const auto refused = [](const std::string &what,
                          const std::string &with,
                          const std::string &message,
                          const bool         take_short = false) {
    const std::string error = error_of(replaced(what, with), take_short);
    EXPECT_NE(error.find(message), std::string::npos) << with << ": " << error;
  };
  refused("set Scene = scenes/beam.prm", "", "'Scene'");
  refused("set Values = 4 | 3 | 2", "set Values = 4 | 3", "equally long");
  refused("set Labels = 1 | 2 | 4", "set Labels = 1 | 2", "labels for 3");
  refused("set Labels = 1 | 2 | 4", "set Labels = 1 | 2 | 2", "stands twice");
  refused("set Labels = 1 | 2 | 4", "set Labels = 1 | 2 | x", "no label", true);
  refused("set Labels = 1 | 2 | 4",
          "set Labels = 1 | 2 | x",
          "is no number",
          false);
  refused("set With = cells", "set With = cels", "Did you mean 'cells'?");
  refused("Horizontal axis = cells", "Horizontal axis = cell", "'cells'");
  refused("Methods = cured", "Methods = curd", "Did you mean 'cured'?");
  refused("set Measures = energy\n    end",
          "set Measures = enery\n    end",
          "Did you mean 'energy'?");
  refused("Reference = 1", "Reference = 0", "Set 'Scale'");
  refused("Reduction = last over first", "Reduction = last", "");
  refused("Source = column", "Source = check", "brings its own");
  refused("Source = column", "Source = comparison", "relative to what");
  refused("set Short methods = cured", "set Short methods = curd", "", false);
  refused("set Short methods = cured",
          "set Short methods = curd",
          "Did you mean 'cured'?",
          true);
  refused("subsection Method cured",
          "subsection Method cured 2",
          "belongs to no name in the list 'Methods'");
}
