// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/simulation/checkpoint_folder.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

namespace
{
  using namespace limber;

  const std::string folder = "seal.dir";



  /** A sealed file with two arrays, one of them empty. */
  Seal
  write_sealed(const std::string &name, const unsigned long step)
  {
    std::vector<double> values(40);
    std::iota(values.begin(), values.end(), 0.1);
    Seal seal;
    seal.format = checkpoint_format;
    seal.run    = 0xfeedbeef;
    seal.step   = step;
    seal.time   = 0.1 * step;
    seal.room   = room_for_seal({"body 0/mass", "nothing"});
    GatheredFile file(folder + "/" + name, 1 << 20, MPI_COMM_SELF, seal.room);
    file.write("body 0/mass", values.data(), values.size());
    file.write("nothing", values.data(), 0);
    file.close();
    seal.pieces = file.pieces();
    put_seal(folder + "/" + name, seal);
    return seal;
  }



  void
  flip(const std::string &path, const std::size_t place, const int bit)
  {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(place);
    const char byte = file.get();
    file.seekp(place);
    file.put(byte ^ (1 << bit));
  }



  class Seals : public testing::Test
  {
  protected:
    Seals()
    {
      std::filesystem::remove_all(folder);
      std::filesystem::create_directory(folder);
    }
  };



  TEST_F(Seals, ReturnWhatWasPut)
  {
    const Seal put  = write_sealed("slot_0.h5", 7);
    const Seal seal = read_seal(folder + "/slot_0.h5");
    check_seal(folder + "/slot_0.h5", seal);
    EXPECT_EQ(seal.run, 0xfeedbeef);
    EXPECT_EQ(seal.step, 7u);
    EXPECT_EQ(seal.time, put.time);
    EXPECT_EQ(seal.n_bytes, std::filesystem::file_size(folder + "/slot_0.h5"));
    EXPECT_EQ(seal.own, put.own);
    ASSERT_EQ(seal.pieces.size(), 2u);
    EXPECT_EQ(seal.pieces[0].name, "body 0/mass");
    EXPECT_EQ(seal.pieces[0].n_bytes, 320u);

    // The array is where the seal says, and HDF5 still reads the file.
    std::vector<double> values(40);
    std::ifstream       file(folder + "/slot_0.h5", std::ios::binary);
    file.seekg(seal.pieces[0].begin);
    file.read(reinterpret_cast<char *>(values.data()), 320);
    EXPECT_EQ(values[39], 39.1);
    ArrayFile(folder + "/slot_0.h5", ArrayFile::Mode::read)
      .read("body 0/mass", 0, values.data(), 40);
    EXPECT_EQ(values[39], 39.1);
  }



  TEST_F(Seals, NoticeABitOfEveryByte)
  {
    const std::string path = folder + "/slot_0.h5";
    const Seal        seal = write_sealed("slot_0.h5", 7);
    for (std::size_t place = 0; place < seal.n_bytes; ++place)
      {
        const int bit = place % 8;
        flip(path, place, bit);
        EXPECT_THROW(check_seal(path, read_seal(path)), DamagedFile)
          << "byte " << place;
        flip(path, place, bit);
      }
    check_seal(path, read_seal(path));
  }



  TEST_F(Seals, NoticeEveryLength)
  {
    const std::string path = folder + "/slot_0.h5";
    const Seal        seal = write_sealed("slot_0.h5", 7);
    std::filesystem::resize_file(path, seal.n_bytes + 1);
    EXPECT_THROW(read_seal(path), DamagedFile);
    for (std::size_t length = seal.n_bytes; length-- > 0;)
      {
        std::filesystem::resize_file(path, length);
        EXPECT_THROW(read_seal(path), DamagedFile) << length << " bytes";
      }
    std::filesystem::remove(path);
    EXPECT_THROW(read_seal(path), DamagedFile);
  }



  TEST_F(Seals, TheLaterSlotCountsAndThenTheOther)
  {
    const Seal later = write_sealed("slot_0.h5", 8),
               early = write_sealed("slot_1.h5", 5);
    // As it should be, and when a run was killed before it changed the note
    for (const bool changed : {true, false})
      {
        write_note(folder,
                   changed ? "slot_0.h5" : "slot_1.h5",
                   changed ? later : early);
        Survey survey = survey_checkpoints(folder);
        EXPECT_EQ(next_candidate(survey).name, "slot_0.h5");
        EXPECT_EQ(warning_about(survey), "");
      }

    flip(folder + "/slot_0.h5", later.pieces[0].begin + 9, 3);
    Survey survey = survey_checkpoints(folder);
    EXPECT_EQ(next_candidate(survey).name, "slot_1.h5");
    for (const char *const words :
         {"slot_0.h5 has changed in the array 'body 0/mass'",
          "slot_1.h5, step 5, time 0.5 s; the steps from there to 8"})
      EXPECT_NE(warning_about(survey).find(words), std::string::npos);
    EXPECT_THROW(next_candidate(survey), FileError);
  }



  TEST_F(Seals, ANoteThatHasChangedInABitIsNone)
  {
    const Seal        seal = write_sealed("slot_0.h5", 8);
    const std::string note = folder + "/good_slot.txt";
    write_note(folder, "slot_0.h5", seal);
    const std::size_t length = std::filesystem::file_size(note);
    for (std::size_t place = 0; place < length; ++place)
      for (int bit = 0; bit < 8; ++bit)
        {
          flip(note, place, bit);
          Survey survey = survey_checkpoints(folder);
          EXPECT_EQ(next_candidate(survey).name, "slot_0.h5");
          EXPECT_NE(warning_about(survey).find("good_slot.txt has changed"),
                    std::string::npos)
            << "bit " << bit << " of byte " << place;
          flip(note, place, bit);
        }
  }
} // namespace
