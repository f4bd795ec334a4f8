// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/simulation/command_line.h>

#include <gtest/gtest.h>

#include <fstream>

using namespace limber;

namespace
{
  CommandLine
  parse_words(std::vector<const char *> words)
  {
    words.insert(words.begin(), "limber");
    return parse_command_line(words.size(), words.data());
  }



  std::string
  command_line_error(const std::vector<const char *> &words)
  {
    try
      {
        parse_words(words);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace



TEST(CommandLine, OptionsInAnyOrder)
{
  const CommandLine line = parse_words({"--validate",
                                        "scene.prm",
                                        "--set",
                                        "Check a=b/Value=1",
                                        "--set=End time=2",
                                        "--output-directory",
                                        "runs/a",
                                        "--resume"});
  EXPECT_TRUE(line.validate);
  EXPECT_TRUE(line.resume);
  EXPECT_FALSE(line.help);
  EXPECT_EQ(line.scene, "scene.prm");
  EXPECT_EQ(line.overrides,
            (std::vector<std::string>{"Check a=b/Value=1",
                                      "End time=2",
                                      "Output/Directory=runs/a"}));
  EXPECT_EQ(line.output_directory, "runs/a");
}



TEST(CommandLine, HelpHasAShortName)
{
  EXPECT_TRUE(parse_words({"-h"}).help);
  EXPECT_TRUE(parse_words({"scene.prm", "--help"}).help);
}



TEST(CommandLine, MisspeltCommands)
{
  const auto said = [](std::vector<const char *> words) -> std::string {
    words.insert(words.begin(), "limber");
    try
      {
        check_first_word(words.size(), words.data());
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  };
  EXPECT_NE(said({"studdy", "a.prm"}).find("'limber study'"),
            std::string::npos);
  EXPECT_NE(said({"plto", "run"}).find("'limber plot'"), std::string::npos);
  EXPECT_EQ(said({"study", "a.prm"}), "");
  EXPECT_EQ(said({"plot.prm"}), "");
  EXPECT_EQ(said({"runs/studdy"}), "");
  EXPECT_EQ(said({"--validate"}), "");
  EXPECT_EQ(said({"something", "else"}), "");
  const std::string file = testing::TempDir() + "/scene.prm";
  std::ofstream(file) << '\n';
  EXPECT_NE(said({"run", file.c_str()}).find("'limber " + file + "'"),
            std::string::npos);
  EXPECT_EQ(said({}), "");
}



TEST(CommandLine, HelpNamesEveryCommand)
{
  for (const char *const command : {"reference",
                                    "compare",
                                    "study",
                                    "stability",
                                    "inf-sup",
                                    "advise",
                                    "plot",
                                    "animate"})
    EXPECT_NE(usage().find(std::string("\n  ") + command + " "),
              std::string::npos)
      << command;
}



TEST(CommandLine, StandardInputAndStyles)
{
  EXPECT_EQ(parse_words({"--"}).scene, "--");
  EXPECT_EQ(parse_words({"--print-parameters", "json"}).print_parameters,
            PrintStyle::json);
  EXPECT_EQ(parse_words({"--list=laws"}).list, "laws");
  EXPECT_EQ(parse_words({"--frequencies", "3"}).frequencies, "3");
  EXPECT_TRUE(parse_words({}).scene.empty());
}



TEST(CommandLine, ErrorsGuessWhatWasMeant)
{
  EXPECT_NE(command_line_error({"--valdate"}).find("'--validate'"),
            std::string::npos);
  EXPECT_NE(command_line_error({"--set"}).find("lacks its value"),
            std::string::npos);
  EXPECT_NE(command_line_error({"--validate=yes"}).find("takes none"),
            std::string::npos);
  EXPECT_NE(command_line_error({"a.prm", "b.prm"}).find("two scenes"),
            std::string::npos);
  EXPECT_NE(command_line_error({"--print-parameters", "xml"}).find("markdown"),
            std::string::npos);
}



TEST(CommandLine, ListsNameEveryChoice)
{
  EXPECT_NE(list_text("laws").find("neo hookean"), std::string::npos);
  EXPECT_NE(list_text("kernels").find("linear"), std::string::npos);
  EXPECT_NE(list_text("schemes").find("apic"), std::string::npos);
  EXPECT_NE(list_text("shapes").find("cylinder"), std::string::npos);
  EXPECT_NE(list_text("sides").find("separating"), std::string::npos);
  EXPECT_NE(list_text("contact").find("friction"), std::string::npos);
  EXPECT_NE(list_text("exact").find("None"), std::string::npos);
  EXPECT_THROW(list_text("lows"), InputError);
}
