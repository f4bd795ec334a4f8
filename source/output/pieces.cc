// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/output/pieces.h>

namespace limber
{
  namespace
  {
    /** ".vtu" of "points_00012.vtu"; empty if it is not of the series. */
    std::string
    ending_of_piece(const std::string &file, const std::string &series)
    {
      const std::string start = series + "_";
      const auto        dot   = file.find('.');
      if (file.compare(0, start.size(), start) != 0 ||
          dot == std::string::npos || dot == start.size() ||
          file.find_first_not_of("0123456789", start.size()) != dot)
        return "";
      return file.substr(dot);
    }
  } // namespace



  bool
  is_piece(const std::string &file, const std::string &series)
  {
    const std::string ending = ending_of_piece(file, series);
    return ending == ".vtu" || ending == ".h5";
  }



  bool
  is_unfinished_piece(const std::string &file, const std::string &series)
  {
    const std::string part = ".vtu.part", lock = ".lock";
    const std::string ending = ending_of_piece(file, series);
    if (ending == part)
      return true;
    return ending.size() > part.size() + lock.size() &&
           ending.compare(0, part.size() + 1, part + "-") == 0 &&
           ending.compare(ending.size() - lock.size(), lock.size(), lock) ==
             0 &&
           ending.find_first_not_of("-0123456789", part.size()) ==
             ending.size() - lock.size();
  }
} // namespace limber
