// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>

#include <gtest/gtest.h>

using namespace limber;

TEST(Text, IsShownWithoutControlCharactersAndShort)
{
  EXPECT_EQ(in_quotes("soil & rock"), "'soil & rock'");
  EXPECT_EQ(in_quotes(std::string("a\0b\x1b\n\t\x7f", 7)),
            "'a\\x00b\\x1b\\n\\t\\x7f'");
  EXPECT_EQ(in_quotes("M\xc3\xbcller \xff"), "'M\xc3\xbcller \\xff'");
  EXPECT_EQ(in_quotes("cut \xc3"), "'cut \\xc3'");

  const std::string exact(60, 'a');
  EXPECT_EQ(printable(exact), exact);
  EXPECT_EQ(printable(exact + "b"), exact + "...");
  EXPECT_EQ(printable(std::string(1000000, 'a')), exact + "...");

  // A path is one word, and its end matters.
  const std::string path = "/home/" + std::string(100, 'a') + "/run";
  EXPECT_EQ(printable(path), path);
  EXPECT_EQ(printable(path + std::string(200, 'b')).size(), 203u);
}



TEST(Text, IsEscapedForXmlAndJson)
{
  EXPECT_EQ(escaped_for_xml("<a & 'b' \"c\">"),
            "&lt;a &amp; &apos;b&apos; &quot;c&quot;&gt;");
  EXPECT_EQ(json_quoted("a\\\"\t\x01\xc3\xbc\xff"),
            "\"a\\\\\\\"\\t\\u0001\xc3\xbc\\ufffd\"");
}



TEST(Text, LongWordsAreNotGuessed)
{
  EXPECT_EQ(nearest("Gird", {"Grid", "Method"}), "Grid");
  EXPECT_EQ(nearest(std::string(1000000, 'G'), {"Grid"}), std::nullopt);
  EXPECT_EQ(nearest("Grid", {std::string(1000000, 'G')}), std::nullopt);
}
