// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_study_parameters_h
#define limber_study_study_parameters_h

#include <limber/base/parameters.h>
#include <limber/problem/words.h>
#include <limber/study/study_file.h>

#include <string>
#include <vector>

/**
 * @file The entries that a study may have, and the words for its choices.
 */
namespace limber
{
  const Words<MeasureSource> &
  source_words();
  const Words<Reduction> &
  reduction_words();
  const Words<Runner> &
  runner_words();
  const Words<Cost> &
  cost_words();
  const Words<Standard> &
  standard_words();

  /** Declare all sections of a study whose lists hold these names. */
  void
  declare_study(Parameters                     &parameters,
                const std::vector<std::string> &methods,
                const std::vector<std::string> &variations,
                const std::vector<std::string> &measures);
} // namespace limber

#endif
