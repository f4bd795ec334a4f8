// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/read_problem.h>
#include <limber/problem/size_estimate.h>

#include <gtest/gtest.h>

#include <sstream>

using namespace limber;

namespace
{
  const std::string plain_scene = R"(
    set End time = 1
    set Bodies   = soil & rock
    subsection Body soil & rock
      subsection Box
        set Upper corner = 0.5, 0.5
      end
    end
  )";



  SceneFile
  door_scene(const std::string              &text,
             const std::vector<std::string> &changes = {},
             const FileFormat                format  = FileFormat::prm)
  {
    return SceneFile(ParameterText{text, format, "door"}, changes);
  }



  /** What is said about a text; a scene that is taken says nothing. */
  std::string
  said_of(const std::string              &text,
          const std::vector<std::string> &changes = {},
          const FileFormat                format  = FileFormat::prm)
  {
    try
      {
        read_problem<2>(door_scene(text, changes, format));
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  /** 16 GB of memory. */
  std::string
  said_of_size(const std::vector<std::string> &changes,
               const Task                      task  = Task::run,
               const Machine                  &there = {1, 16e9})
  {
    try
      {
        check_size(read_problem<2>(door_scene(plain_scene, changes)),
                   task,
                   there);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  void
  expect_short(const std::string &message)
  {
    EXPECT_FALSE(message.empty());
    std::istringstream words(message);
    unsigned int       n = 0;
    for (std::string word; words >> word;)
      ++n;
    EXPECT_LE(n, 60u) << message;
    EXPECT_LE(message.size(), 600u) << message.substr(0, 1000);
    for (const char letter : message)
      EXPECT_GE(static_cast<unsigned char>(letter), 0x20);
  }



  void
  expect_short_message(const std::string              &message,
                       const std::vector<std::string> &fragments)
  {
    expect_short(message);
    for (const std::string &fragment : fragments)
      EXPECT_NE(message.find(fragment), std::string::npos)
        << "expected: " << fragment << "\nin: " << message;
  }
} // namespace



TEST(GuardedDoor, ControlCharactersAreNamed)
{
  expect_short_message(said_of(plain_scene +
                               std::string("set End\0 time = 2", 17)),
                       {"'\\x00'", "line 9 of door"});
  expect_short_message(said_of("{\"End time\": \"1\x1b\"}",
                               {},
                               FileFormat::json),
                       {"'\\x1b'", "line 1"});
  expect_short_message(said_of("{\"Output\": {\"Directory\": \"a\\nb\"}}",
                               {},
                               FileFormat::json),
                       {"'a\\nb'", "control character", "'Directory'"});
  expect_short_message(said_of(plain_scene, {"Output/Directory=a\x01z"}),
                       {"'a\\x01z'", "--set"});
}



TEST(GuardedDoor, NestingEnds)
{
  std::string prm;
  for (unsigned int i = 0; i < 100000; ++i)
    prm += "subsection a\n";
  expect_short_message(said_of(prm), {"16 deep", "line 17"});
  for (const std::string level : {"{\"a\":", "["})
    {
      std::string json = "{\"a\":";
      for (unsigned int i = 0; i < 100000; ++i)
        json += level;
      expect_short_message(said_of(json, {}, FileFormat::json), {"16 deep"});
    }
  expect_short_message(said_of("{\"Grid\": {\"Cells\": [[1], [2]]}}",
                               {},
                               FileFormat::json),
                       {"'Cells'", "holds an array"});
}



TEST(GuardedDoor, LongValuesAreCutInMessages)
{
  const std::string long_one(1000000, 'a');
  for (const std::string &line : {"set End time = " + long_one,
                                  "set " + long_one + " = 1",
                                  "set Bodies = " + long_one,
                                  "subsection " + long_one + "\nend",
                                  long_one,
                                  "set Constants = " + long_one + " = 1",
                                  "subsection Body soil & rock\n"
                                  "set Initial velocity = 0; " +
                                    long_one + "\nend",
                                  "subsection Body soil & rock\n"
                                  "set Initial velocity = 0; " +
                                    std::string(300000, '(') + "\nend"})
    expect_short(said_of(plain_scene + line));
}



TEST(GuardedDoor, NamesThatFilesCannotHoldAreRefused)
{
  for (const std::string name :
       {"a/b", "a\\\\b", "a#b", "a [m]", "a\\u0007", "\xff"})
    expect_short_message(said_of("{\"Bodies\": \"" + name + "\", \"Body " +
                                   name + "\": {\"Shape\": \"box\"}}",
                                 {},
                                 FileFormat::json),
                         {name == "\xff" ? "JSON" : " "});
  for (const std::string name : {"a&b", "<a>", "\"a\"", "'a'", "a=b", "ä"})
    EXPECT_EQ(said_of("{\"Bodies\": \"" +
                        (name == "\"a\"" ? "\\\"a\\\"" : name) + "\", \"Body " +
                        (name == "\"a\"" ? "\\\"a\\\"" : name) +
                        "\": {\"Shape\": \"box\"}}",
                      {},
                      FileFormat::json),
              "");
}



TEST(GuardedDoor, RandomNumbersAreRefused)
{
  for (const std::string formula :
       {"0; rand()", "rand_seed(3); 0", "0; 2*rand ( )"})
    expect_short_message(
      said_of(plain_scene, {"Body soil & rock/Initial velocity=" + formula}),
      {"'rand", "Initial velocity", "jittered"});
  EXPECT_EQ(said_of(plain_scene,
                    {"Constants=brand = 2, rand_ = 1",
                     "Body soil & rock/Initial velocity=brand; rand_*x"}),
            "");
}



// Both forms of what a run used, read again, are what it used.
TEST(GuardedDoor, PrintedParametersAreReadAgain)
{
  for (const std::string folder : {"a b",
                                   "a;b",
                                   "a\\b",
                                   "a\"b'c",
                                   "ä/\xe2\x82\xac",
                                   "a=b, c",
                                   "a\tb",
                                   "$HOME/{x}"})
    {
      const SceneFile scene =
        door_scene(plain_scene, {"Output/Directory=" + folder});
      for (const PrintStyle style : {PrintStyle::prm, PrintStyle::json})
        {
          std::ostringstream text;
          print_parameters(text, style, &scene);
          const SceneFile again =
            door_scene(text.str(),
                       {},
                       style == PrintStyle::prm ? FileFormat::prm :
                                                  FileFormat::json);
          EXPECT_EQ(again.parameters().entries(), scene.parameters().entries());
        }
    }
  for (const std::string folder : {"a#b", "a\\", "a\nb", "a\xff"})
    expect_short_message(said_of(plain_scene, {"Output/Directory=" + folder}),
                         {"'Directory'", "parameters.prm"});
}



TEST(GuardedDoor, WhatDoesNotFitIsRefused)
{
  EXPECT_EQ(said_of_size({}), "");
  EXPECT_EQ(said_of_size({"Grid/Cells=4000, 4000"}), "");
  expect_short_message(said_of_size({"Grid/Cells=100000, 100000"}),
                       {"1e+10 cells"});
  expect_short_message(said_of_size({"Grid/Cells=1e9, 1e9"}), {"1e+18 cells"});
  expect_short_message(
    said_of_size({"Grid/Cells=8192, 8192"}),
    {"6.711e+07 cells", "16 GB", "Grid/Cells = ", "Memory limit"});
  expect_short_message(
    said_of_size({"Body soil & rock/Points per cell edge=100000"}),
    {"points", "'Body soil & rock', 'Points per cell edge = "});
  // one cell holds more places than the body has points
  expect_short_message(said_of_size(
                         {"Body soil & rock/Box/Upper corner=1e-9, 1e-9",
                          "Body soil & rock/Placement=regular",
                          "Body soil & rock/Points per cell edge=100000"}),
                       {"points", "Points per cell edge"});
  // a lattice of its own has no places in cells
  EXPECT_EQ(said_of_size({"Body soil & rock/Box/Upper corner=1e-9, 1e-9",
                          "Body soil & rock/Placement=fitted",
                          "Body soil & rock/Points per cell edge=100000"}),
            "");
  expect_short_message(said_of_size(
                         {"Body soil & rock/Placement=fitted",
                          "Body soil & rock/Points along edges=1e5, 1e5"}),
                       {"1e+10 points", "Points along edges"});
  expect_short_message(said_of_size({"Memory limit=0.1"}),
                       {"the program alone", "'Memory limit' is 0.1 GB"});
  EXPECT_EQ(said_of_size({"Memory limit=100", "Grid/Cells=8192, 8192"}), "");
}



// What the message proposes is accepted.
TEST(GuardedDoor, TheRemedyFits)
{
  for (const std::vector<std::string> &changes :
       {std::vector<std::string>{"Grid/Cells=30000, 10000"},
        {"Body soil & rock/Points per cell edge=3000"},
        {"Body soil & rock/Points per cell edge=400, 40000"}})
    {
      const std::string message  = said_of_size(changes);
      auto              proposed = message.find("Grid/Cells = ");
      std::string       entry    = "Grid/Cells";
      if (proposed == std::string::npos)
        {
          proposed = message.find("Points per cell edge = ");
          entry    = "Body soil & rock/Points per cell edge";
        }
      ASSERT_NE(proposed, std::string::npos) << message;
      const auto begin = message.find("= ", proposed) + 2;
      auto       all   = changes;
      all.push_back(entry + "=" +
                    message.substr(begin, message.find('\'', begin) - begin));
      EXPECT_EQ(said_of_size(all), "") << message;
    }
}



TEST(GuardedDoor, ReferencesThatDoNotFitAreRefused)
{
  EXPECT_EQ(said_of_size({}, Task::reference), "");
  expect_short_message(said_of_size({"Reference/Refinements=10"},
                                    Task::reference),
                       {"elements", "Refinements = 0"});
  expect_short_message(said_of_size({"Reference/Refinements=1000000000"},
                                    Task::reference),
                       {"elements", "Refinements"});
  expect_short_message(said_of_size({"Reference/Elements over depth=100000"},
                                    Task::reference),
                       {"1e+10 elements", "Elements over depth"});
}



TEST(GuardedDoor, PicturesAndStepsHaveAnEnd)
{
  for (const Task task : {Task::run, Task::reference})
    {
      expect_short_message(said_of_size({"Output/Time interval=1e-9"}, task),
                           {"1e+09 pictures", "Time interval = 0.01"});
      EXPECT_EQ(said_of_size({"Output/Time interval=1e-4"}, task), "");
    }
  EXPECT_EQ(said_of_size({"Output/Time interval=1e-9", "End step=10"}), "");
  expect_short_message(said_of_size({"Method/Time step=1e-12"}),
                       {"1e+12 steps"});
  expect_short_message(said_of_size({"Reference/Time step=1e-12"},
                                    Task::reference),
                       {"1e+12 steps"});
}



// The memory of several ranks is that of all machines together.
TEST(GuardedDoor, RanksHaveTheirShare)
{
  const auto problem = read_problem<2>(
    door_scene(plain_scene, {"Grid/Cells=1001, 1003", "Method/Kernel=linear"}));
  const double one  = estimate_size(problem, Task::run, 1).bytes();
  const double four = estimate_size(problem, Task::run, 4).bytes();
  // every rank holds the whole coarse mesh
  EXPECT_GT(four, one + 3 * 1001 * 1003 * 400.);
  EXPECT_NEAR(estimate_size(problem, Task::run, 1).all_points(),
              0.25 * 4 * 1001 * 1003,
              1);
}
