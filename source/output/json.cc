// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>
#include <limber/output/json.h>

#include <charconv>
#include <cmath>

namespace limber::json
{
  namespace
  {
    std::string
    indented(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        {
          result += c;
          if (c == '\n')
            result += "  ";
        }
      return result;
    }



    std::string
    enclosed(const char                      open,
             const std::vector<std::string> &items,
             const char                      close)
    {
      std::string result(1, open);
      for (std::size_t i = 0; i < items.size(); ++i)
        result += (i == 0 ? "\n  " : ",\n  ") + indented(items[i]);
      if (!items.empty())
        result += '\n';
      return result + close;
    }
  } // namespace



  Value
  string(const std::string &text)
  {
    return {json_quoted(text)};
  }



  Value
  number(const double value)
  {
    if (!std::isfinite(value))
      return {"null"};
    char       text[32];
    const auto end = std::to_chars(text, text + sizeof(text), value);
    return {std::string(text, end.ptr)};
  }



  Value
  integer(const unsigned long value)
  {
    return {std::to_string(value)};
  }



  Value
  boolean(const bool value)
  {
    return {value ? "true" : "false"};
  }



  Value
  array(const std::vector<Value> &values)
  {
    std::vector<std::string> items;
    for (const Value &value : values)
      items.push_back(value.text);
    return {enclosed('[', items, ']')};
  }



  Value
  object(const Members &members)
  {
    std::vector<std::string> items;
    for (const auto &[name, value] : members)
      items.push_back(string(name).text + ": " + value.text);
    return {enclosed('{', items, '}')};
  }
} // namespace limber::json
