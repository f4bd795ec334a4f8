// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace limber
{
  namespace
  {
    /** Damerau-Levenshtein distance: how many letters have to be changed,
     * added, removed or swapped with their neighbour. */
    std::size_t
    edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<std::vector<std::size_t>> d(
        a.size() + 1, std::vector<std::size_t>(b.size() + 1));
      for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j)
          if (i == 0 || j == 0)
            d[i][j] = i + j;
          else
            {
              d[i][j] = std::min({d[i - 1][j] + 1,
                                  d[i][j - 1] + 1,
                                  d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
              if (i > 1 && j > 1 && a[i - 1] == b[j - 2] &&
                  a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
      return d[a.size()][b.size()];
    }
  } // namespace



  std::string
  lower_case(std::string text)
  {
    std::transform(text.begin(), text.end(), text.begin(), [](const char c) {
      return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    return text;
  }



  std::string
  trimmed(const std::string &text)
  {
    const char *const blank = " \t\r\n";
    const auto        first = text.find_first_not_of(blank);
    if (first == std::string::npos)
      return "";
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
  }



  std::vector<std::string>
  split(const std::string &text, const char separator)
  {
    std::vector<std::string> parts;
    if (trimmed(text).empty())
      return parts;
    std::size_t begin = 0;
    while (true)
      {
        const std::size_t end = text.find(separator, begin);
        parts.push_back(trimmed(text.substr(begin, end - begin)));
        if (end == std::string::npos)
          return parts;
        begin = end + 1;
      }
  }



  std::string
  join(const std::vector<std::string> &parts, const std::string &separator)
  {
    std::string result;
    for (std::size_t i = 0; i < parts.size(); ++i)
      result += (i == 0 ? "" : separator) + parts[i];
    return result;
  }



  bool
  is_control(const char letter)
  {
    return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
  }



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



  namespace
  {
    std::string
    escaped(const char letter)
    {
      if (letter == '\n')
        return "\\n";
      if (letter == '\t')
        return "\\t";
      const char digits[] = "0123456789abcdef";
      const auto byte     = static_cast<unsigned char>(letter);
      return std::string("\\x") + digits[byte / 16] + digits[byte % 16];
    }
  } // namespace



  std::string
  printable(const std::string &text)
  {
    const bool is_path = text.find('/') != std::string::npos &&
                         text.find_first_of(" \t\n") == std::string::npos;
    const std::size_t longest = is_path ? 200 : 60;
    std::string       result;
    std::size_t       shown = 0;
    for (std::size_t i = 0; i < text.size(); ++shown)
      {
        if (shown == longest)
          return result + "...";
        const std::size_t n = utf8_length(text, i);
        result +=
          n == 0 || is_control(text[i]) ? escaped(text[i]) : text.substr(i, n);
        i += std::max<std::size_t>(n, 1);
      }
    return result;
  }



  std::string
  in_quotes(const std::string &text)
  {
    return "'" + printable(text) + "'";
  }



  namespace
  {
    std::string
    escaped_for_json(const char c)
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
  } // namespace



  std::string
  json_quoted(const std::string &text)
  {
    std::string result = "\"";
    for (std::size_t i = 0; i < text.size();)
      {
        const std::size_t length = utf8_length(text, i);
        if (length == 0)
          result += "\\ufffd";
        else if (length == 1)
          result += escaped_for_json(text[i]);
        else
          result += text.substr(i, length);
        i += length == 0 ? 1 : length;
      }
    return result + '"';
  }



  std::string
  escaped_for_xml(const std::string &text)
  {
    std::string result;
    for (const char letter : text)
      switch (letter)
        {
          case '&':
            result += "&amp;";
            break;
          case '<':
            result += "&lt;";
            break;
          case '>':
            result += "&gt;";
            break;
          case '"':
            result += "&quot;";
            break;
          case '\'':
            result += "&apos;";
            break;
          default:
            result += letter;
        }
    return result;
  }



  std::optional<double>
  to_number(const std::string &text)
  {
    const std::string word   = trimmed(text);
    char             *end    = nullptr;
    const double      number = std::strtod(word.c_str(), &end);
    if (word.empty() || *end != '\0' || !std::isfinite(number))
      return std::nullopt;
    return number;
  }



  std::string
  to_text(const double number)
  {
    for (int digits = 6; digits <= 17; ++digits)
      {
        std::ostringstream text;
        text.precision(digits);
        text << number;
        if (to_number(text.str()) == number)
          return text.str();
      }
    return std::to_string(number);
  }



  std::string
  brief(const double number)
  {
    std::ostringstream text;
    text.precision(4);
    text << number;
    return text.str();
  }



  namespace
  {} // namespace



  std::string
  counted(const std::size_t n, const std::string &what)
  {
    return std::to_string(n) + ' ' + what + (n == 1 ? "" : "s");
  }



  std::optional<std::string>
  nearest(const std::string &word, const std::vector<std::string> &candidates)
  {
    std::optional<std::string> result;
    std::size_t                best = std::string::npos;
    // Nobody misspells a word of that length; finding out would take long.
    constexpr std::size_t longest = 200;
    if (word.size() > longest)
      return result;
    for (const std::string &candidate : candidates)
      {
        if (candidate.size() > longest)
          continue;
        const std::size_t distance =
          edit_distance(lower_case(word), lower_case(candidate));
        // A third of the letters may be wrong; beyond, a hint only confuses.
        const std::size_t letters = std::max(word.size(), candidate.size());
        if (distance < best &&
            distance <= std::max<std::size_t>(1, letters / 3))
          {
            best   = distance;
            result = candidate;
          }
      }
    if (!result)
      if (const auto longer = with_word(word, candidates); longer.size() == 1)
        result = longer.front();
    return result;
  }



  std::vector<std::string>
  with_word(const std::string &word, const std::vector<std::string> &candidates)
  {
    const std::string        wanted = ' ' + lower_case(word) + ' ';
    std::vector<std::string> result;
    for (const std::string &candidate : candidates)
      if ((' ' + lower_case(candidate) + ' ').find(wanted) != std::string::npos)
        result.push_back(candidate);
    return result;
  }
} // namespace limber
