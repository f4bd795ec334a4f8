// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/json.h>

#include <charconv>
#include <cmath>
#include <cstdio>

namespace limber::json
{
  namespace
  {
    /** Length of the UTF-8 character that begins at @p i; 0 if there is none.
     */
    std::size_t
    utf8_length(const std::string &text, const std::size_t i)
    {
      const auto byte = [&](const std::size_t k) {
        return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
      };
      const unsigned int first  = byte(i);
      const std::size_t  length = first < 0x80           ? 1 :
                                  first >> 5 == 0b110u   ? 2 :
                                  first >> 4 == 0b1110u  ? 3 :
                                  first >> 3 == 0b11110u ? 4 :
                                                           0;
      for (std::size_t k = 1; k < length; ++k)
        if (byte(i + k) >> 6 != 0b10u)
          return 0;
      // longer than needed, surrogates, beyond the last code point
      const bool forbidden = first == 0xc0 || first == 0xc1 || first > 0xf4 ||
                             (first == 0xe0 && byte(i + 1) < 0xa0) ||
                             (first == 0xed && byte(i + 1) > 0x9f) ||
                             (first == 0xf0 && byte(i + 1) < 0x90) ||
                             (first == 0xf4 && byte(i + 1) > 0x8f);
      return forbidden ? 0 : length;
    }



    std::string
    escaped(const char c)
    {
      switch (c)
        {
          case '"':
            return "\\\"";
          case '\\':
            return "\\\\";
          case '\n':
            return "\\n";
          case '\r':
            return "\\r";
          case '\t':
            return "\\t";
          default:
            break;
        }
      if (static_cast<unsigned char>(c) >= 0x20)
        return std::string(1, c);
      char code[8];
      std::snprintf(code,
                    sizeof(code),
                    "\\u%04x",
                    static_cast<unsigned int>(c));
      return code;
    }



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
    std::string result = "\"";
    for (std::size_t i = 0; i < text.size();)
      {
        const std::size_t length = utf8_length(text, i);
        if (length == 0)
          result += "\\ufffd";
        else if (length == 1)
          result += escaped(text[i]);
        else
          result += text.substr(i, length);
        i += length == 0 ? 1 : length;
      }
    return {result + '"'};
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
