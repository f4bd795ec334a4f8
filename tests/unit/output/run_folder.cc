// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/output/files.h>
#include <limber/output/run_folder.h>

#include <gtest/gtest.h>

#include "sample_run.h"

namespace limber::test
{
  namespace
  {
    bool
    exists(const std::string &path)
    {
      return std::filesystem::exists(path);
    }



    /** Written by one rank, seen by all afterwards. */
    void
    touch(const std::string &path)
    {
      on_first_rank(MPI_COMM_WORLD, [&]() {
        std::filesystem::create_directories(
          std::filesystem::path(path).parent_path());
        write_whole_file(path, "x");
      });
    }
  } // namespace



  TEST(RunFolder, IsMadeWithParentsAndExplainsItself)
  {
    const std::string folder = fresh_folder("folder.dir") + "/a/b";
    prepare_run_folder(folder, false, MPI_COMM_WORLD);
    write_run_texts(folder,
                    {"# mine\n", false, "prm\n", "{}\n"},
                    MPI_COMM_WORLD);
    EXPECT_EQ(content(folder + "/original.prm"), "# mine\n");
    EXPECT_EQ(content(folder + "/parameters.prm"), "prm\n");
    EXPECT_EQ(content(folder + "/parameters.json"), "{}\n");
  }



  TEST(RunFolder, ThatHoldsARunIsRefused)
  {
    for (const char *const trace :
         {"statistics", "summary.json", "parameters.prm"})
      {
        const std::string folder = fresh_folder("folder.dir");
        touch(folder + "/" + trace);
        EXPECT_THROW(prepare_run_folder(folder, false, MPI_COMM_WORLD),
                     InputError);
        EXPECT_TRUE(exists(folder + "/" + trace));
      }
    // A folder with other things is not a run.
    const std::string folder = fresh_folder("folder.dir");
    touch(folder + "/notes.txt");
    EXPECT_NO_THROW(prepare_run_folder(folder, false, MPI_COMM_WORLD));
  }



  TEST(RunFolder, ReplacementLeavesForeignFiles)
  {
    const std::string folder = fresh_folder("folder.dir");
    for (const char *const name : {"original.prm",
                                   "parameters.prm",
                                   "parameters.json",
                                   "statistics",
                                   "summary.json",
                                   "log.txt",
                                   "points.pvd",
                                   "grid.pvd",
                                   "points/points_00000.vtu",
                                   "grid/grid_00012.vtu",
                                   "checkpoint/slot_0.h5",
                                   "checkpoint/good_slot.txt.part",
                                   // not ours
                                   "notes.txt",
                                   "snapshots.png",
                                   "checkpoint/keys",
                                   "points/points_of_interest.txt",
                                   "points/points_1.vtu.bak"})
      touch(folder + "/" + name);
    prepare_run_folder(folder, true, MPI_COMM_WORLD);

    unsigned int n_left = 0;
    for (const auto &entry :
         std::filesystem::recursive_directory_iterator(folder))
      n_left += entry.is_regular_file();
    EXPECT_EQ(n_left, 6u); // with the mark
    EXPECT_EQ(maker_of(folder), "run");
    EXPECT_TRUE(exists(folder + "/notes.txt"));
    EXPECT_TRUE(exists(folder + "/points/points_of_interest.txt"));
    EXPECT_FALSE(exists(folder + "/grid"));
    EXPECT_FALSE(exists(folder + "/checkpoint/slot_0.h5"));
    EXPECT_TRUE(exists(folder + "/checkpoint/keys"));
  }



  /** Who sets the folder to that of the scene must not lose the scene. */
  TEST(RunFolder, ThatNoRunWroteIsNotReplaced)
  {
    const std::string folder = fresh_folder("folder.dir");
    touch(folder + "/parameters.prm");
    EXPECT_THROW(prepare_run_folder(folder, true, MPI_COMM_WORLD), InputError);
    EXPECT_TRUE(exists(folder + "/parameters.prm"));
  }



  TEST(RunFolder, BelongsToOneAtATime)
  {
    const std::string folder = fresh_folder("folder.dir");
    {
      const FolderLock lock = prepare_run_folder(folder, false, MPI_COMM_WORLD);
      EXPECT_EQ(lock.warning(), "");
      for (const bool replace : {false, true})
        EXPECT_THROW(prepare_run_folder(folder, replace, MPI_COMM_WORLD),
                     InputError);
      try
        {
          reopen_run_folder(folder, MPI_COMM_WORLD);
          FAIL() << "nothing was thrown";
        }
      catch (const InputError &error)
        {
          EXPECT_NE(std::string(error.what()).find("is in use by process "),
                    std::string::npos)
            << error.what();
        }
    }
    EXPECT_NO_THROW(reopen_run_folder(folder, MPI_COMM_WORLD));
    EXPECT_NO_THROW(prepare_run_folder(folder, true, MPI_COMM_WORLD));
  }



  TEST(RunFolder, UnderAFileCannotBeMade)
  {
    const std::string folder = fresh_folder("folder.dir");
    touch(folder + "/file");
    EXPECT_THROW(prepare_run_folder(folder + "/file/run",
                                    false,
                                    MPI_COMM_WORLD),
                 FileError);
  }
} // namespace limber::test
