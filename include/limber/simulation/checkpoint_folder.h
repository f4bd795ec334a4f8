// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_simulation_checkpoint_folder_h
#define limber_simulation_checkpoint_folder_h

#include <limber/simulation/seal.h>

#include <string>
#include <vector>

/**
 * @file The folder `checkpoint` of a run: two files, the slots, and a note that
 * names the good one. What is here is for one rank.
 */
namespace limber
{
  /** A slot that may be gone on from. */
  struct Candidate
  {
    std::string name; // "slot_0.h5"
    Seal        seal;
  };



  /** What there is to go on from. */
  struct Survey
  {
    std::string            folder;
    std::vector<Candidate> candidates;       // to be tried in this order
    std::size_t            n_tried  = 0;     // of them
    bool                   expected = false; // the first is where it should be
    // Why others, or the note, do not count: "slot_0.h5 is not there"
    std::vector<std::string> faults;
    // The last step that a checkpoint is known to have been written of, and
    // whether there may have been a later one
    unsigned long last_step  = 0;
    bool          or_a_later = false;
  };



  /**
   * Look at the note and at the seals of both slots. Only slots of the run that
   * the note names count, the later before the earlier, whatever their names
   * are: a run that is killed before it has changed the note leaves a slot that
   * is later. Throws InputError where there is nothing at all, FileError where
   * nothing but another format is left.
   */
  Survey
  survey_checkpoints(const std::string &folder);

  /**
   * The next candidate that is what its seal says. Throws FileError, which
   * tells of all faults, where none is left.
   */
  const Candidate &
  next_candidate(Survey &survey);

  /** What the user has to know when the last one tried is taken, or nothing. */
  std::string
  warning_about(const Survey &survey);

  /** The slot to be written when this one (empty: none) is good. */
  std::string
  slot_after(const std::string &good);

  /** Make the note name this slot; it is on the disk afterwards. */
  void
  write_note(const std::string &folder,
             const std::string &slot,
             const Seal        &seal);

  /** Wait until a file or folder is on the disk; throws FileError. */
  void
  settle(const std::string &path);
} // namespace limber

#endif
