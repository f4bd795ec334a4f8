// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/console.h>
#include <limber/base/exceptions.h>
#include <limber/base/run_info.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

using namespace limber;

TEST(Console, LogReceivesWhatWasSaidBeforeItWasOpened)
{
  const std::string  path = "console_" + std::to_string(getpid()) + ".txt";
  std::ostringstream screen;
  {
    Console console(true, screen);
    console.say("first");
    console.open_log(path);
    console.show("only on the screen");
    console.say("second");
  }
  EXPECT_EQ(screen.str(), "first\nonly on the screen\nsecond\n");

  std::stringstream log;
  log << std::ifstream(path).rdbuf();
  EXPECT_EQ(log.str(), "first\nsecond\n");
  std::remove(path.c_str());
}



TEST(Console, WarnsOnceAndCounts)
{
  std::ostringstream screen;
  Console            console(true, screen);
  console.warn_once("lost", "a point left the grid");
  console.warn_once("lost", "another point left the grid");
  EXPECT_EQ(screen.str(), "Warning: a point left the grid\n");
  EXPECT_EQ(console.warning_counts().at("lost"), 2u);
}



TEST(Console, OtherRanksAreSilent)
{
  std::ostringstream screen;
  Console            console(false, screen);
  console.open_log("/nowhere/log.txt");
  console.say("hidden");
  EXPECT_TRUE(screen.str().empty());
}



/** One message, and what is said about it is on the screen. */
TEST(Console, LogOnAFullDiskIsAFileErrorOnce)
{
  if (access("/dev/full", W_OK) != 0)
    GTEST_SKIP();
  std::ostringstream screen;
  Console            console(true, screen);
  console.open_log("/dev/full");
  EXPECT_THROW(console.say("first"), FileError);
  EXPECT_NO_THROW(console.say("second"));
  EXPECT_EQ(screen.str(), "first\nsecond\n");
}



TEST(Console, RemovedLogIsAFileError)
{
  const std::string  path = "console_" + std::to_string(getpid()) + ".txt";
  std::ostringstream screen;
  for (const bool at_the_end : {false, true})
    {
      Console console(true, screen);
      console.open_log(path);
      console.say("first");
      std::remove(path.c_str());
      if (at_the_end)
        EXPECT_THROW(console.close_log(), FileError);
      else
        EXPECT_THROW(console.say("second"), FileError);
    }
}



TEST(Console, UnwritableLogIsAFileError)
{
  std::ostringstream screen;
  Console            console(true, screen);
  EXPECT_THROW(console.open_log("/nowhere/log.txt"), FileError);
}



TEST(RunInfo, BannerNamesVersionsAndWarnsInDebug)
{
  RunInfo info = run_info();
  info.debug   = true;
  EXPECT_NE(banner(info).find("deal.II 9."), std::string::npos);
  EXPECT_NE(banner(info).find("timings mean nothing"), std::string::npos);
  info.debug = false;
  EXPECT_EQ(banner(info).find("timings"), std::string::npos);
}
