// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_from_file_h
#define limber_problem_from_file_h

#include <string>

namespace limber
{
  /** What a shape is besides, if it comes from a file. */
  class FromFile
  {
  public:
    explicit FromFile(const std::string &checksum)
      : checksum(checksum)
    {}

    // What a resumed run must find in the file again
    const std::string checksum;
  };
} // namespace limber

#endif
