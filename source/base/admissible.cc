// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/admissible.h>
#include <limber/base/text.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  Admissible::Admissible(const Test                     &test,
                         const std::string              &in_words,
                         const std::string              &example,
                         const std::vector<std::string> &choices)
    : test(test)
    , words(in_words)
    , sample(example)
    , choices(choices)
  {}



  bool
  Admissible::match(const std::string &value) const
  {
    return test(trimmed(value));
  }



  std::string
  Admissible::description(const OutputStyle) const
  {
    return words;
  }



  std::unique_ptr<dealii::Patterns::PatternBase>
  Admissible::clone() const
  {
    return std::make_unique<Admissible>(*this);
  }



  const std::string &
  Admissible::example() const
  {
    return sample;
  }



  std::optional<std::string>
  Admissible::meant(const std::string &value) const
  {
    for (const std::string &word : split(value, ','))
      if (std::find(choices.begin(), choices.end(), word) == choices.end())
        if (const auto near = nearest(word, choices))
          return near;
    return {};
  }



  Admissible
  Admissible::or_empty() const
  {
    return Admissible(
      [inner = test](const std::string &value) {
        return value.empty() || inner(value);
      },
      words + ", or empty",
      sample,
      choices);
  }



  Admissible
  Admissible::with_former_words(
    const std::map<std::string, std::string> &former) const
  {
    Admissible result = *this;
    result.former     = former;
    return result;
  }



  std::string
  Admissible::successor(const std::string &value) const
  {
    const auto found = former.find(value);
    return found == former.end() ? "" : found->second;
  }



  Admissible
  Admissible::or_word(const std::string &word) const
  {
    return Admissible(
      [inner = test, word](const std::string &value) {
        return value == word || inner(value);
      },
      words + ", or " + in_quotes(word),
      sample,
      choices);
  }



  namespace admissible
  {
    namespace
    {
      Admissible
      number_that(const std::function<bool(double)> &test,
                  const std::string                 &in_words,
                  const std::string                 &example)
      {
        return Admissible(
          [test](const std::string &value) {
            const auto number = to_number(value);
            return number && test(*number);
          },
          in_words,
          example);
      }



      bool
      is_positive_integer(const std::string &value)
      {
        const auto number = to_number(value);
        // The upper bound keeps the conversion to unsigned int safe.
        return number && *number >= 1 && *number <= 1e9 &&
               std::floor(*number) == *number;
      }



      bool
      contains(const std::vector<std::string> &words, const std::string &word)
      {
        return std::find(words.begin(), words.end(), word) != words.end();
      }
    } // namespace



    Admissible
    number(const std::string &example)
    {
      return number_that([](double) { return true; }, "a number", example);
    }



    Admissible
    positive_number(const std::string &example)
    {
      return number_that([](const double value) { return value > 0; },
                         "a number greater than 0",
                         example);
    }



    Admissible
    non_negative_number(const std::string &example)
    {
      return number_that([](const double value) { return value >= 0; },
                         "a number not less than 0",
                         example);
    }



    Admissible
    number_between(const double       lower,
                   const double       upper,
                   const std::string &example)
    {
      return number_that(
        [=](const double value) { return lower < value && value < upper; },
        "a number greater than " + to_text(lower) + " and less than " +
          to_text(upper),
        example);
    }



    Admissible
    number_from_to(const double       lower,
                   const double       upper,
                   const std::string &example)
    {
      return number_that(
        [=](const double value) { return lower <= value && value <= upper; },
        "a number from " + to_text(lower) + " to " + to_text(upper),
        example);
    }



    Admissible
    positive_integer(const std::string &example)
    {
      return Admissible(is_positive_integer,
                        "an integer greater than 0",
                        example);
    }



    Admissible
    non_negative_integer(const std::string &example)
    {
      return Admissible(
        [](const std::string &value) {
          return value == "0" || is_positive_integer(value);
        },
        "an integer not less than 0",
        example);
    }



    Admissible
    integer_from_to(const unsigned int lower,
                    const unsigned int upper,
                    const std::string &example)
    {
      return Admissible(
        [lower, upper](const std::string &value) {
          if (value != "0" && !is_positive_integer(value))
            return false;
          const double number = *to_number(value);
          return number >= lower && number <= upper;
        },
        "an integer from " + std::to_string(lower) + " to " +
          std::to_string(upper),
        example);
    }



    Admissible
    numbers(const unsigned int count, const std::string &example)
    {
      return Admissible(
        [count](const std::string &value) {
          const auto parts = split(value, ',');
          return parts.size() == count &&
                 std::all_of(parts.begin(),
                             parts.end(),
                             [](const std::string &part) {
                               return to_number(part).has_value();
                             });
        },
        std::to_string(count) + " numbers separated by commas",
        example);
    }



    Admissible
    positive_integers(const unsigned int count,
                      const bool         one_for_all,
                      const std::string &example)
    {
      return Admissible(
        [=](const std::string &value) {
          const auto parts = split(value, ',');
          return (parts.size() == count ||
                  (one_for_all && parts.size() == 1)) &&
                 std::all_of(parts.begin(), parts.end(), is_positive_integer);
        },
        (one_for_all ? "one integer or " : "") + std::to_string(count) +
          " integers greater than 0, separated by commas",
        example);
    }



    Admissible
    flag()
    {
      return one_of({"true", "false"});
    }



    Admissible
    one_of(const std::vector<std::string> &words)
    {
      return Admissible(
        [words](const std::string &value) { return contains(words, value); },
        "one of " + join(words, " | "),
        words.front(),
        words);
    }



    Admissible
    some_of(const std::vector<std::string> &words)
    {
      return Admissible(
        [words](const std::string &value) {
          const auto parts = split(value, ',');
          return std::all_of(parts.begin(),
                             parts.end(),
                             [&](const std::string &part) {
                               return contains(words, part);
                             });
        },
        "some of " + join(words, " | ") + ", separated by commas",
        words.front(),
        words);
    }



    Admissible
    names(const std::string &example)
    {
      return Admissible(
        [](const std::string &value) {
          return !contains(split(value, ','), "");
        },
        "names separated by commas",
        example);
    }



    Admissible
    text(const std::string &in_words, const std::string &example)
    {
      return Admissible([](const std::string &) { return true; },
                        in_words,
                        example);
    }
  } // namespace admissible
} // namespace limber
