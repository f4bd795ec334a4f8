// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_output_json_h
#define limber_output_json_h

#include <string>
#include <utility>
#include <vector>

/**
 * @file Just enough JSON to write: boost's property trees would turn all
 * numbers into strings.
 */
namespace limber::json
{
  /** A value as text; the functions below make it. */
  struct Value
  {
    std::string text;
  };

  using Members = std::vector<std::pair<std::string, Value>>;

  /** Escaped; bytes that are not UTF-8 become U+FFFD. */
  Value
  string(const std::string &text);

  /** The shortest form that reads back the same; null if not finite. */
  Value
  number(const double value);

  Value
  integer(const unsigned long value);

  Value
  boolean(const bool value);

  Value
  array(const std::vector<Value> &values);

  /** Members in the given order, one per line. */
  Value
  object(const Members &members);
} // namespace limber::json

#endif
