// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_commands_h
#define limber_study_study_commands_h

#include <limber/study/study.h>

/** @file What is behind the words of commands.h. Each returns an exit code. */
namespace limber
{
  /** `limber inf-sup`. */
  int
  inf_sup_command(const int argc, const char *const *argv);

  /** `limber advise`. */
  int
  advise_command(const int argc, const char *const *argv);
} // namespace limber

#endif
