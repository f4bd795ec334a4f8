// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_text_h
#define limber_base_text_h

#include <optional>
#include <string>
#include <vector>

/** @file Small tools for words: cutting, joining, showing, guessing the meant
 * one.
 */
namespace limber
{
  /** Without white space at both ends. */
  std::string
  trimmed(const std::string &text);

  std::string
  lower_case(std::string text);

  /** The trimmed parts of @p text; an empty text has no parts. */
  std::vector<std::string>
  split(const std::string &text, const char separator);

  std::string
  join(const std::vector<std::string> &parts, const std::string &separator);

  /** Whether it is a control character, which no entry and no name may hold. */
  bool
  is_control(const char letter);

  /**
   * @p text as a message may show it: control characters and what is not
   * UTF-8 as \x00, \n or \t, and of a long text the first 60 characters and
   * '...'; a path, which has no blanks, keeps 200.
   */
  std::string
  printable(const std::string &text);

  /** The printable text in single quotes, as values stand in messages. */
  std::string
  in_quotes(const std::string &text);

  /** The finite number that @p text is as a whole, if it is one. */
  std::optional<double>
  to_number(const std::string &text);

  /** Length of the UTF-8 character that begins at @p i; 0: none does. */
  std::size_t
  utf8_length(const std::string &text, const std::size_t i);

  /** In double quotes, as JSON wants it; what is not UTF-8 is replaced. */
  std::string
  json_quoted(const std::string &text);

  /** As it may stand in XML, in texts and in quoted attributes. */
  std::string
  escaped_for_xml(const std::string &text);

  /** The shortest decimal form that reads back as the same number. */
  std::string
  to_text(const double number);

  /** With four significant digits, for messages. */
  std::string
  brief(const double number);

  /** "1 word", "2 words" */
  std::string
  counted(std::size_t n, const std::string &what);

  /**
   * The candidate that @p word was probably meant to be: the one with the
   * smallest edit distance, letter case aside, or the only one that has it
   * among its words, as 'Initial velocity' has 'velocity'. Empty where none is
   * near.
   */
  std::optional<std::string>
  nearest(const std::string &word, const std::vector<std::string> &candidates);

  /** Those that have @p word among their words, letter case aside. */
  std::vector<std::string>
  with_word(const std::string              &word,
            const std::vector<std::string> &candidates);
} // namespace limber

#endif
