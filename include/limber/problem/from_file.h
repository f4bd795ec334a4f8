// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_from_file_h
#define limber_problem_from_file_h

#include <string>

namespace limber
{
  /** Base class of shapes that come from a file. */
  class FromFile
  {
  public:
    explicit FromFile(const std::string &checksum)
      : checksum(checksum)
    {}

    // Checksum that the file must still have when a run is resumed
    const std::string checksum;
  };
} // namespace limber

#endif
