// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_study_variants_h
#define limber_study_variants_h

#include <limber/study/study_file.h>

#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /** One run of a study: a method with one choice of each variation. */
  struct Variant
  {
    std::size_t              method = 0;
    std::vector<std::size_t> choices;    // one per variation
    std::string              name;       // "cell, 4", unique in the study
    std::string              folder;     // of its run
    std::vector<std::string> settings;   // all of them, "Section/Name=value"
    std::string              parameters; // all entries as the run will use them
    Runner                   runner = Runner::points;
  };

  /**
   * All variants, methods outermost. Each is read and checked as a run would
   * do it, so that nothing is computed if one of them is wrong; throws
   * InputError with its name.
   */
  std::vector<Variant>
  expand(const StudyFile &study);

  /**
   * What the variants are compared with, where a measure asks for it and it
   * has to be computed; checked likewise.
   */
  std::optional<Variant>
  standard_of(const StudyFile &study);

  /** The number on the horizontal axis, where that is a variation. */
  double
  abscissa(const StudyFile &study, const Variant &variant);
} // namespace limber

#endif
