// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_admissible_h
#define limber_base_admissible_h

#include <deal.II/base/patterns.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /**
   * What an entry of the scene may hold: a test, the same in words ("a number
   * greater than 0"), and a value that passes. A pattern of deal.II's
   * ParameterHandler whose words are fit for our messages and manual.
   */
  class Admissible : public dealii::Patterns::PatternBase
  {
  public:
    using Test = std::function<bool(const std::string &)>;

    /** @p choices: the words to choose from, where it is a choice. */
    Admissible(const Test                     &test,
               const std::string              &in_words,
               const std::string              &example,
               const std::vector<std::string> &choices = {});

    bool
    match(const std::string &value) const override;

    std::string
    description(const OutputStyle style = Machine) const override;

    std::unique_ptr<dealii::Patterns::PatternBase>
    clone() const override;

    /** A value that passes, for error messages. */
    const std::string &
    example() const;

    /** Of a choice, the word that a misspelt @p value was meant to have. */
    std::optional<std::string>
    meant(const std::string &value) const;

    /** Whether it is a word or words of a list. */
    bool
    is_choice() const
    {
      return !choices.empty();
    }

    /** The same, or nothing at all: the entry may be left empty. */
    Admissible
    or_empty() const;

    /** The same, or the given word. */
    Admissible
    or_word(const std::string &word) const;

    /** The same, which knows what words of former versions are called now. */
    Admissible
    with_former_words(const std::map<std::string, std::string> &former) const;

    /** What a word of a former version is called now; empty for others. */
    std::string
    successor(const std::string &value) const;

  private:
    Test                               test;
    std::string                        words, sample;
    std::vector<std::string>           choices;
    std::map<std::string, std::string> former;
  };



  /** The kinds of entries that a scene is made of. */
  namespace admissible
  {
    Admissible
    number(const std::string &example = "0");

    Admissible
    positive_number(const std::string &example = "1");

    /** Zero or greater. */
    Admissible
    non_negative_number(const std::string &example = "0");

    /** Strictly between the bounds. */
    Admissible
    number_between(const double       lower,
                   const double       upper,
                   const std::string &example);

    /** From lower to upper, both included. */
    Admissible
    number_from_to(const double       lower,
                   const double       upper,
                   const std::string &example);

    Admissible
    positive_integer(const std::string &example = "1");

    Admissible
    non_negative_integer(const std::string &example = "0");

    /** From lower to upper, both included. */
    Admissible
    integer_from_to(const unsigned int lower,
                    const unsigned int upper,
                    const std::string &example);

    /** Exactly so many numbers, separated by commas. */
    Admissible
    numbers(const unsigned int count, const std::string &example);

    /** Exactly so many integers greater than 0, or one for all. */
    Admissible
    positive_integers(const unsigned int count,
                      const bool         one_for_all,
                      const std::string &example);

    /** true or false. */
    Admissible
    flag();

    Admissible
    one_of(const std::vector<std::string> &words);

    /** Some of the words, separated by commas. */
    Admissible
    some_of(const std::vector<std::string> &words);

    /** Names separated by commas, possibly none. */
    Admissible
    names(const std::string &example);

    /** Any text; @p in_words says what it is meant to be. */
    Admissible
    text(const std::string &in_words, const std::string &example);
  } // namespace admissible
} // namespace limber

#endif
