// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/text.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace limber
{
  namespace
  {
    std::string
    lower_case(std::string text)
    {
      std::transform(text.begin(), text.end(), text.begin(), [](const char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      });
      return text;
    }



    /**
     * Damerau and Levenshtein's distance: how many letters have to be
     * changed, added, removed or swapped with their neighbour.
     */
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



  std::string
  in_quotes(const std::string &text)
  {
    return "'" + text + "'";
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



  std::optional<std::string>
  nearest(const std::string &word, const std::vector<std::string> &candidates)
  {
    std::optional<std::string> result;
    std::size_t                best = std::string::npos;
    for (const std::string &candidate : candidates)
      {
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
    return result;
  }
} // namespace limber
