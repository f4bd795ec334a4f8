// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/files.h>
#include <limber/simulation/checkpoint_folder.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

namespace limber
{
  namespace
  {
    constexpr const char *slots[]   = {"slot_0.h5", "slot_1.h5"};
    constexpr const char *note_name = "good_slot.txt";



    /** Content of the note: which slot is good. */
    struct Note
    {
      std::string   slot;
      unsigned long step = 0;
      std::uint64_t run  = 0;
      std::uint32_t seal = 0; // Seal::own
    };



    std::string
    last_line_of_note(const std::string &text)
    {
      char line[32];
      std::snprintf(line,
                    sizeof(line),
                    "checksum %08" PRIx32 "\n",
                    checksum(text.data(), text.size()));
      return line;
    }



    std::string
    text_of_note(const std::string &slot, const Seal &seal)
    {
      char line[64];
      std::snprintf(line,
                    sizeof(line),
                    "run %016" PRIx64 ", seal %08" PRIx32 "\n",
                    seal.run,
                    seal.own);
      const std::string text = slot + "\nstep " + std::to_string(seal.step) +
                               ", time " + to_text(seal.time) + " s\n" + line;
      return text + last_line_of_note(text);
    }



    /**
     * The first bytes of a file, more than a note has; empty if there is none.
     */
    std::string
    start_of_file(const std::string &path)
    {
      std::error_code error;
      if (!std::filesystem::is_regular_file(path, error))
        return "";
      std::ifstream file(path, std::ios::binary);
      std::string   text(512, '\0');
      file.read(&text[0], text.size());
      text.resize(file.gcount());
      return text;
    }



    std::optional<Note>
    read_note(const std::string &folder)
    {
      const std::string text  = start_of_file(folder + "/" + note_name);
      const auto        lines = text.rfind("checksum ");
      if (lines == std::string::npos ||
          text.substr(lines) != last_line_of_note(text.substr(0, lines)))
        return std::nullopt;
      Note note;
      note.slot = text.substr(0, text.find('\n'));
      if (std::sscanf(text.c_str() + note.slot.size(),
                      "\nstep %lu, time %*s s\nrun %" SCNx64 ", seal %" SCNx32,
                      &note.step,
                      &note.run,
                      &note.seal) != 3)
        return std::nullopt;
      return note;
    }



    std::string
    fault_of_note(const std::string &folder)
    {
      std::error_code error;
      return std::string(note_name) +
             (std::filesystem::exists(folder + "/" + note_name, error) ?
                " has changed" :
                " is not there");
    }



    /**
     * Adds a slot to the candidates if its seal can be read, or notes why not.
     */
    void
    look_at(const std::string &name, Survey &survey, bool &other_format)
    {
      try
        {
          const Seal seal = read_seal(survey.folder + "/" + name);
          if (seal.format == checkpoint_format)
            survey.candidates.push_back({name, seal});
          else
            {
              survey.faults.push_back(name + " has another format");
              other_format = true;
            }
        }
      catch (const DamagedFile &damaged)
        {
          survey.faults.push_back(name + " " + damaged.reason);
        }
    }



    /** Removes candidates of other runs than this one. */
    void
    drop_other_runs(const std::uint64_t run, Survey &survey)
    {
      auto &all = survey.candidates;
      for (const Candidate &candidate : all)
        if (candidate.seal.run != run)
          survey.faults.push_back(candidate.name + " is of another run");
      all.erase(std::remove_if(all.begin(),
                               all.end(),
                               [&](const Candidate &candidate) {
                                 return candidate.seal.run != run;
                               }),
                all.end());
    }



    /** Latest step first; of equal steps the slot that the note names. */
    void
    order_by_step(Survey &survey, const std::uint32_t noted_seal = 0)
    {
      std::stable_sort(survey.candidates.begin(),
                       survey.candidates.end(),
                       [&](const Candidate &a, const Candidate &b) {
                         return std::make_pair(a.seal.step,
                                               a.seal.own == noted_seal) >
                                std::make_pair(b.seal.step,
                                               b.seal.own == noted_seal);
                       });
    }



    void
    judge_without_note(Survey &survey)
    {
      auto &all = survey.candidates;
      if (all.size() == 2 && all[0].seal.run != all[1].seal.run)
        {
          survey.faults.push_back("the slots are of different runs");
          all.clear();
        }
      order_by_step(survey);
      survey.last_step  = all.empty() ? 0 : all[0].seal.step;
      survey.or_a_later = all.size() == 1;
    }



    void
    judge_by_note(const Note &note, Survey &survey)
    {
      drop_other_runs(note.run, survey);
      order_by_step(survey, note.seal);
      const auto &all  = survey.candidates;
      survey.last_step = note.step;
      for (const Candidate &candidate : all)
        {
          survey.last_step = std::max(survey.last_step, candidate.seal.step);
          if (candidate.name == note.slot && candidate.seal.own != note.seal)
            survey.faults.push_back(note.slot + " is not that of step " +
                                    std::to_string(note.step) + " which " +
                                    note_name + " names");
        }
      survey.expected =
        !all.empty() &&
        (all[0].seal.step > note.step ||
         (all[0].seal.own == note.seal && all[0].name == note.slot));
    }



    InputError
    nothing_there(const std::string &folder)
    {
      return InputError(
        "The folder " + in_quotes(folder) +
        " has no checkpoint to go on from. Usually the run ended before its "
        "first one, or --output-directory is another one. Run without "
        "--resume; 'Checkpoint/Interval' says how often one is written.");
    }



    FileError
    too_old(const std::string &folder)
    {
      return FileError("The checkpoints in " + in_quotes(folder) +
                       " have another format than format " +
                       std::to_string(checkpoint_format) +
                       " of this version of Limber. Usually the program was "
                       "updated in between. Resume with the version named in "
                       "log.txt, or run without --resume in another "
                       "'Output/Directory'.");
    }



    bool
    is_empty(const std::string &folder)
    {
      std::error_code error;
      return std::none_of(std::begin(slots),
                          std::end(slots),
                          [&](const char *const name) {
                            return std::filesystem::exists(folder + "/" + name,
                                                           error);
                          }) &&
             !std::filesystem::exists(folder + "/" + note_name, error);
    }
  } // namespace



  Survey
  survey_checkpoints(const std::string &folder)
  {
    if (is_empty(folder))
      throw nothing_there(folder);
    Survey survey;
    survey.folder     = folder;
    bool other_format = false;
    for (const char *const name : slots)
      look_at(name, survey, other_format);
    if (survey.candidates.empty() && other_format)
      throw too_old(folder);

    if (const auto note = read_note(folder))
      judge_by_note(*note, survey);
    else
      {
        survey.faults.push_back(fault_of_note(folder));
        judge_without_note(survey);
      }
    return survey;
  }



  const Candidate &
  next_candidate(Survey &survey)
  {
    while (survey.n_tried < survey.candidates.size())
      {
        const Candidate &candidate = survey.candidates[survey.n_tried++];
        try
          {
            check_seal(survey.folder + "/" + candidate.name, candidate.seal);
            return candidate;
          }
        catch (const DamagedFile &damaged)
          {
            survey.faults.push_back(candidate.name + " " + damaged.reason);
          }
      }
    throw FileError(
      "No checkpoint in " + in_quotes(survey.folder) +
      " can be used: " + join(survey.faults, ", and ") +
      ". Usually the disk fails, or files were edited or "
      "copied in part. Restore the folder from a copy, or start the "
      "run anew in another 'Output/Directory'.");
  }



  std::string
  warning_about(const Survey &survey)
  {
    if (survey.expected && survey.n_tried == 1)
      return "";
    const Candidate &taken = survey.candidates[survey.n_tried - 1];
    std::string      text =
      "In " + in_quotes(survey.folder) + ", " + join(survey.faults, ", and ") +
      ". Usually the disk fails, or files were edited or copied in part. The "
      "run goes on from " +
      taken.name + ", step " + std::to_string(taken.seal.step) + ", time " +
      brief(taken.seal.time) + " s";
    if (survey.last_step > taken.seal.step)
      text += "; the steps from there to " + std::to_string(survey.last_step) +
              " are done again";
    else if (survey.or_a_later)
      text += "; later steps, if any, are done again";
    return text + ".";
  }



  std::string
  slot_after(const std::string &good)
  {
    return slots[good == slots[0] ? 1 : 0];
  }



  void
  write_note(const std::string &folder,
             const std::string &slot,
             const Seal        &seal)
  {
    // Not write_whole_file(): the text has to be on the disk before its name.
    const std::string path = folder + "/" + note_name, partial = path + ".part";
    errno = 0;
    std::ofstream file(partial, std::ios::binary);
    file << text_of_note(slot, seal);
    file.close();
    if (!file)
      throw cannot_write(path, std::strerror(errno));
    settle(partial);
    if (std::rename(partial.c_str(), path.c_str()) != 0)
      throw cannot_write(path, std::strerror(errno));
  }



  void
  settle(const std::string &path)
  {
    const int  file    = open(path.c_str(), O_RDONLY);
    const bool settled = file >= 0 && fsync(file) == 0;
    const int  reason  = errno;
    if (file >= 0)
      close(file);
    if (!settled)
      throw cannot_write(path, std::strerror(reason));
  }
} // namespace limber
