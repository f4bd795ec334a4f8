// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/base/parameters.h>
#include <limber/base/text.h>

#include <gtest/gtest.h>

#include <sstream>
#include <tuple>

using namespace limber;

namespace
{
  /** Two small sections with names that are hard to handle. */
  void
  declare_example(Parameters &parameters)
  {
    parameters.declare("Names", "", admissible::names("a"), "A list.");
    parameters.enter_subsection("Young's box, v1.2");
    parameters.declare("Length", "1", admissible::positive_number(), "L, m.");
    parameters.declare("Word",
                       "one | two",
                       admissible::one_of({"one | two", "a \"quoted\" one"}),
                       "A word.");
    parameters.leave_subsection();
    parameters.enter_subsection("Check a=b");
    parameters.declare("Value", "0", admissible::number(), "A value.");
    parameters.leave_subsection();
  }



  Section
  read_example(Parameters                     &parameters,
               const std::string              &text,
               const FileFormat                format    = FileFormat::prm,
               const std::vector<std::string> &overrides = {})
  {
    declare_example(parameters);
    parameters.read(scan_parameters(text, format, "example"), overrides);
    return parameters.root();
  }



  std::string
  example_error(const std::string              &text,
                const std::vector<std::string> &overrides = {})
  {
    Parameters parameters;
    try
      {
        read_example(parameters, text, FileFormat::prm, overrides);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace



TEST(Parameters, PrmWithCommentsContinuationsAndSignsInNames)
{
  Parameters    parameters;
  const Section root = read_example(parameters,
                                    "# a comment that ends in \\\n"
                                    "set Names = front at T=3, \\\n"
                                    "            other   # more words\r\n"
                                    "subsection Check a=b\n"
                                    "  set Value = -1e-3\n"
                                    "end");
  EXPECT_EQ(root.list("Names"),
            (std::vector<std::string>{"front at T=3", "other"}));
  EXPECT_DOUBLE_EQ(root.subsection("Check a=b").number("Value"), -1e-3);
  EXPECT_DOUBLE_EQ(root.subsection("Young's box, v1.2").number("Length"), 1.);
}



TEST(Parameters, JsonWithNumbersAndArrays)
{
  Parameters    parameters;
  const Section root = read_example(parameters,
                                    R"({"Names": ["a", "b"],
                                        "Check a=b": {"Value": 2.5}})",
                                    FileFormat::json);
  EXPECT_EQ(root.list("Names").size(), 2u);
  EXPECT_DOUBLE_EQ(root.subsection("Check a=b").number("Value"), 2.5);
}



TEST(Parameters, WhatIsPrintedCanBeReadBack)
{
  Parameters original;
  read_example(original,
               "subsection Young's box, v1.2\n"
               "  set Word = a \"quoted\" one\n  set Length = 7\nend");
  for (const auto &[style, format] :
       {std::pair(PrintStyle::prm, FileFormat::prm),
        std::pair(PrintStyle::json, FileFormat::json)})
    {
      std::ostringstream printed;
      original.print(printed, style);
      Parameters    copy;
      const Section box = read_example(copy, printed.str(), format)
                            .subsection("Young's box, v1.2");
      EXPECT_EQ(box.text("Word"), "a \"quoted\" one") << printed.str();
      EXPECT_DOUBLE_EQ(box.number("Length"), 7.);
      EXPECT_TRUE(copy.warnings().empty());
    }
}



TEST(Parameters, MarkdownKeepsItsTable)
{
  Parameters parameters;
  declare_example(parameters);
  std::ostringstream printed;
  parameters.print(printed, PrintStyle::markdown);
  EXPECT_NE(printed.str().find(
              "| Length | 1 | a number greater than 0 | L, m. |"),
            std::string::npos);
  EXPECT_NE(printed.str().find("one \\| two"), std::string::npos);
}



TEST(Parameters, OfRepeatedEntriesTheLastCountsAndTheLogSaysSo)
{
  Parameters    parameters;
  const Section root = read_example(parameters, "set Names=a\nset Names = b");
  EXPECT_EQ(root.text("Names"), "b");
  ASSERT_EQ(parameters.warnings().size(), 1u);
  EXPECT_NE(parameters.warnings()[0].find("line 2"), std::string::npos);
}



TEST(Parameters, OverridesFindTheirEntryDespiteSignsInNames)
{
  Parameters    parameters;
  const Section root = read_example(parameters,
                                    "set Names = a",
                                    FileFormat::prm,
                                    {"Check a=b/Value = 3", "Names=a=b"});
  EXPECT_DOUBLE_EQ(root.subsection("Check a=b").number("Value"), 3.);
  EXPECT_EQ(root.text("Names"), "a=b");
}



TEST(Parameters, ErrorsSayWhereAndWhatWasMeant)
{
  const std::string box = "subsection Young's box, v1.2\n";
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
    {"set Nmaes = a", "'Nmaes' at the top level (line 1", "mean 'Names'?"},
    {"\nset Value = 1", "(line 2", "exists in section 'Check a=b'"},
    {"subsection Check a=c\nend", "'Check a=c'", "mean 'Check a=b'?"},
    {box + "set Length = -1\nend", "'-1'", "a number greater than 0"},
    {box + "set Length = 1 m\nend", "'1 m'", "line 2 of example"},
    {box + "set Word = three\nend", "'three'", "one of one | two"},
    {box, "is not closed", "Write 'end'"},
    {"end", "'end' without", "Remove"},
    {"Names = a", "'Names = a'", "set Name = value"},
    {"include other.prm", "not supported", "Copy"}};
  for (const auto &[text, what, hint] : cases)
    {
      const std::string message = example_error(text);
      EXPECT_NE(message.find(what), std::string::npos) << text << message;
      EXPECT_NE(message.find(hint), std::string::npos) << text << message;
    }
  EXPECT_NE(example_error("", {"Names"}).find("has no '='"), std::string::npos);
  EXPECT_NE(example_error("", {"Check a=b/Valeu=1"}).find("mean 'Value'?"),
            std::string::npos);
}



// Hints are places where the entry has a meaning.
TEST(Parameters, UnknownEntriesOfWordsThatOthersHave)
{
  Parameters parameters;
  parameters.enter_subsection("Output");
  for (const char *const name : {"Time interval", "Statistics interval"})
    parameters.declare(name, "0", admissible::number(), "dt, s.");
  parameters.leave_subsection();
  parameters.enter_subsection("Checkpoint");
  parameters.declare("Interval", "0", admissible::number(), "dt, s.");
  parameters.leave_subsection();
  parameters.enter_subsection("Method");
  parameters.declare("Courant number",
                     "0.4",
                     admissible::number(),
                     "CFL number C.");
  parameters.leave_subsection();
  for (const char *const side : {"left", "right"})
    {
      parameters.enter_subsection(side);
      parameters.declare("Velocity", "0", admissible::number(), "v, m/s.");
      parameters.leave_subsection();
    }
  const auto said = [&](const std::string &setting) -> std::string {
    try
      {
        parameters.read(scan_parameters("", FileFormat::prm, "example"),
                        {setting});
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  };
  const std::string interval = said("Output/Interval=1");
  EXPECT_NE(interval.find("mean 'Time interval' or 'Statistics interval'?"),
            std::string::npos)
    << interval;
  EXPECT_EQ(interval.find("Checkpoint"), std::string::npos) << interval;
  const std::string cfl = said("Method/CFL=1");
  EXPECT_NE(cfl.find("mean 'Courant number'?"), std::string::npos) << cfl;
  const std::string velocity = said("Method/Velocity=1");
  EXPECT_NE(velocity.find("exists in section 'left', for instance"),
            std::string::npos)
    << velocity;
}



TEST(Parameters, BrokenJsonIsWrongInput)
{
  EXPECT_THROW(scan_parameters("{\"a\": 1,}", FileFormat::json, "a.json"),
               InputError);
}



TEST(Text, NearestNameIsNotGuessedFromAfar)
{
  EXPECT_EQ(nearest("densty", {"Viscosity", "Density"}), "Density");
  EXPECT_EQ(nearest("baem", {"bed", "beam"}), "beam");
  EXPECT_FALSE(nearest("temperature", {"Density", "Viscosity"}));
  // a word of a longer name, where it is the only one
  EXPECT_EQ(nearest("velocity", {"Initial velocity", "Density"}),
            "Initial velocity");
  EXPECT_FALSE(nearest("stress", {"Initial stress", "Stress update"}));
}



TEST(Text, NumbersAreReadAsAWholeOnly)
{
  EXPECT_EQ(to_number(" 1e3 "), 1000.);
  EXPECT_FALSE(to_number("1 m"));
  EXPECT_FALSE(to_number(""));
  EXPECT_FALSE(to_number("inf"));
  EXPECT_EQ(to_text(0.1), "0.1");
}
