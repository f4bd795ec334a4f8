// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/pieces.h>

#include <gtest/gtest.h>

using namespace limber;

TEST(Pieces, AreKnownByTheirNames)
{
  for (const char *const file : {"points_00012.vtu", "points_00012.h5"})
    EXPECT_TRUE(is_piece(file, "points")) << file;
  for (const char *const file : {"points_00012.vtu.part",
                                 "points_00012.csv",
                                 "points_.vtu",
                                 "points_1b.vtu",
                                 "points.vtu",
                                 "grid_00012.vtu",
                                 "my_points_00012.vtu"})
    EXPECT_FALSE(is_piece(file, "points")) << file;
}



TEST(Pieces, AreUnfinishedWithTheirLocks)
{
  for (const char *const file :
       {"points_00012.vtu.part", "points_00012.vtu.part-1-4711.lock"})
    EXPECT_TRUE(is_unfinished_piece(file, "points")) << file;
  for (const char *const file : {"points_00012.vtu",
                                 "points_00012.vtu.part.lock",
                                 "points_00012.vtu.part-mine.lock",
                                 "points_00012.vtu.part-1-4711",
                                 "points_00012.vtu.partial",
                                 "grid_00012.vtu.part-1-4711.lock"})
    EXPECT_FALSE(is_unfinished_piece(file, "points")) << file;
}
