// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/json.h>
#include <limber/output/summary.h>

#include <boost/property_tree/json_parser.hpp>

#include <gtest/gtest.h>

#include <sstream>

#include "sample_run.h"

namespace limber::test
{
  TEST(Json, EscapesWhatHasToBe)
  {
    EXPECT_EQ(json::string("a\"b\\c\n\t\x01/").text,
              "\"a\\\"b\\\\c\\n\\t\\u0001/\"");
    EXPECT_EQ(json::string("Stoß").text, "\"Stoß\"");
    EXPECT_EQ(json::string("Sto\xdf, \xc3").text, "\"Sto\\ufffd, \\ufffd\"");
    EXPECT_EQ(json::string("\xed\xa0\x80").text, "\"\\ufffd\\ufffd\\ufffd\"");
  }



  TEST(Json, NumbersReadBackAndWhatIsNotOneIsNull)
  {
    const double third = 1. / 3;
    EXPECT_EQ(std::stod(json::number(third).text), third);
    EXPECT_EQ(json::number(std::numeric_limits<double>::quiet_NaN()).text,
              "null");
    EXPECT_EQ(json::number(-std::numeric_limits<double>::infinity()).text,
              "null");
    EXPECT_EQ(json::array({}).text, "[]");
    EXPECT_EQ(json::object({}).text, "{}");
  }



  TEST(Summary, IsReadByAnotherParser)
  {
    Summary summary;
    summary.verdict      = "check missed";
    summary.message      = "The \"tip\" is\nelsewhere";
    summary.steps        = 1234567890123ul;
    summary.energy_drift = 1e-17;
    summary.verbs        = {{"sum shared", 0.25}, {"grid to points", 0.5}};
    CheckResult check;
    check.name       = "tip at the end";
    check.value      = std::numeric_limits<double>::quiet_NaN();
    summary.checks   = {check};
    summary.warnings = {"one", "two"};
    summary.health   = {{"mass", Verdict::bad, -0.1, "lost", "Grid/Cells"}};

    const std::string folder = fresh_folder("summary.dir");
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      return;
    write_summary(folder, summary);
    std::istringstream          text(content(folder + "/summary.json"));
    boost::property_tree::ptree tree;
    boost::property_tree::read_json(text, tree);
    EXPECT_EQ(tree.get<std::string>("message"), summary.message);
    EXPECT_EQ(tree.get<unsigned long>("steps"), summary.steps);
    EXPECT_EQ(tree.get<double>("energy_drift"), 1e-17);
    EXPECT_EQ(tree.get<double>("verbs.grid to points"), 0.5);
    EXPECT_EQ(tree.get_child("checks").front().second.get<std::string>("value"),
              "null");
    EXPECT_FALSE(tree.get_child("checks").front().second.get<bool>("passed"));
    EXPECT_EQ(tree.get_child("warnings").size(), 2u);
    const auto &health = tree.get_child("health").front().second;
    EXPECT_EQ(health.get<std::string>("verdict"), "bad");
    EXPECT_EQ(health.get<double>("value"), -0.1);
    EXPECT_EQ(health.get<std::string>("entry"), "Grid/Cells");
    EXPECT_FALSE(std::filesystem::exists(folder + "/summary.json.part"));
  }
} // namespace limber::test
