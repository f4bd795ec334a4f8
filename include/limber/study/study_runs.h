// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_runs_h
#define limber_study_study_runs_h

#include <limber/output/folder_lock.h>
#include <limber/study/child_process.h>
#include <limber/study/study.h>
#include <limber/study/variants.h>

#include <optional>

namespace limber
{
  /**
   * The runs of a study: its folder, its child processes, what is kept of a
   * former call, and what is said meanwhile.
   *
   * A run that has ended, well or not, leaves beside its folder a file
   * NAME.done with the way it ended and all that it depended on: program,
   * scene, entries. With --resume a run is not repeated while these are the
   * same.
   */
  class StudyRuns
  {
  public:
    /** Checks all variants and prepares the folder, unless only validating. */
    StudyRuns(const StudyFile &study, const StudyCall &call, Console &console);

    const std::vector<Variant> &
    variants() const
    {
      return all;
    }

    /**
     * Run a variant, or know from a former call how it ended; nothing if the
     * user has interrupted it. @p settings: further ones, beyond those of the
     * variant, for a run of its own in @p subfolder.
     */
    std::optional<ChildEnd>
    run(const Variant                  &variant,
        const std::vector<std::string> &settings  = {},
        const std::string              &subfolder = "");

    /**
     * Run what variants are compared with, where the study asks for it; false
     * if the user has interrupted it. Throws InputError if that run fails.
     */
    bool
    prepare_comparison();

    /**
     * Compare a finished variant, whose run folder then has the errors; false
     * if the user has interrupted it. Throws InputError where it cannot be
     * compared.
     */
    bool
    compare(const Variant &variant);

    /** A line about a variant that is done, and how long the rest takes. */
    void
    progress(const Variant &variant, const std::string &text);

    /** Says how to go on; returns what the program should. */
    int
    interrupted();

  private:
    void
    prepare_folder();
    std::string
    dependencies(const Variant                  &variant,
                 const std::vector<std::string> &settings) const;
    double
    seconds_left() const;

    const StudyFile       &study;
    const StudyCall       &call;
    Console               &console;
    std::vector<Variant>   all;
    FolderLock             lock;
    std::optional<Variant> standard; // what variants are compared with
    std::vector<double>    seconds;  // wall time of the variants done; 0: kept
    double                 present = 0; // of the one that is being done
  };
} // namespace limber

#endif
