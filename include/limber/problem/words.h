// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_words_h
#define limber_problem_words_h

#include <limber/base/exceptions.h>
#include <limber/base/law_parameter.h>
#include <limber/base/parameters.h>
#include <limber/base/text.h>
#include <limber/problem/problem.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

/**
 * @file The words of the scene and their values in the program, side by side in
 * one place: ranges, help texts and error messages follow from them.
 */
namespace limber
{
  /** No value: the word is reserved, but not available in this version. */
  template <typename Enum>
  struct Word
  {
    std::string         word;
    std::optional<Enum> value;
    std::string         text;        // one line for --list and the manual
    std::string         former = {}; // what it was called in former versions
  };

  template <typename Enum>
  using Words = std::vector<Word<Enum>>;

  /** From the list of shapes, and that of unions. */
  const Words<std::string> &
  shape_words();

  const Words<RefinementCriterion> &
  criterion_words();

  /** From the list of laws. */
  const Words<LawDescription> &
  law_words();

  const Words<KernelKind> &
  kernel_words();

  const Words<TimeIntegration> &
  time_integration_words();

  const Words<StressUpdateOrder> &
  stress_update_words();

  const Words<Transfer> &
  transfer_words();

  const Words<Placement> &
  placement_words();

  const Words<Frame> &
  frame_words();

  const Words<ReferenceElement> &
  reference_element_words();

  const Words<ReferenceMethod> &
  reference_method_words();

  const Words<Treatment> &
  locking_words();

  const Words<HourglassResponse> &
  hourglass_words();

  const Words<HistoryTreatment> &
  history_words();

  /** Those and 'auto', which is 'keep' until choose_histories(). */
  const Words<HistoryTreatment> &
  volume_history_words();

  /** The word of a condition at a side of the grid, in place of a value. */
  const Words<std::string> &
  side_condition_words();

  /** The same for what a pair of bodies does where they touch. */
  const Words<std::string> &
  contact_law_words();



  /** The admissible words. */
  template <typename Enum>
  std::vector<std::string>
  plain(const Words<Enum> &words)
  {
    std::vector<std::string> result;
    for (const Word<Enum> &word : words)
      result.push_back(word.word);
    return result;
  }



  /** The same words as their own values, for those who only list them. */
  template <typename Enum>
  Words<std::string>
  without_values(const Words<Enum> &words)
  {
    Words<std::string> result;
    for (const Word<Enum> &word : words)
      result.push_back({word.word, word.word, word.text});
    return result;
  }



  /** "word: text; word: text", for the documentation of an entry. */
  template <typename Enum>
  std::string
  explained(const Words<Enum> &words)
  {
    std::vector<std::string> parts;
    bool                     all_available = true;
    for (const Word<Enum> &word : words)
      if (word.value)
        parts.push_back(word.word + ": " + word.text);
      else
        all_available = false;
    return join(parts, "; ") +
           (all_available ? "." : "; other words are not available yet.");
  }



  /** What words of former versions are called now. */
  template <typename Enum>
  std::map<std::string, std::string>
  former_words(const Words<Enum> &words)
  {
    std::map<std::string, std::string> result;
    for (const Word<Enum> &word : words)
      if (!word.former.empty())
        result[word.former] = word.word;
    return result;
  }



  template <typename Enum>
  void
  declare_word(Parameters        &parameters,
               const std::string &entry,
               const std::string &default_word,
               const Words<Enum> &words,
               const std::string &text)
  {
    parameters.declare(
      entry,
      default_word,
      admissible::one_of(plain(words)).with_former_words(former_words(words)),
      text + " " + explained(words));
  }



  /** Throws InputError for a word that is not available in this version. */
  template <typename Enum>
  Enum
  read_word(const Section     &section,
            const std::string &entry,
            const Words<Enum> &words)
  {
    const std::string text = section.text(entry);
    std::string       available;
    for (const Word<Enum> &word : words)
      {
        if (word.word == text && word.value)
          return *word.value;
        if (word.value)
          available = word.word;
      }
    // The list ends with the reserved words; the last one before them is the
    // most capable replacement.
    throw InputError(in_quotes(text) + " was chosen in " +
                     section.where(entry) +
                     ", but is not available in this version of Limber; the "
                     "word is reserved for a later one. Use " +
                     in_quotes(available) + " instead.");
  }
} // namespace limber

#endif
