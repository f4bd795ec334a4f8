// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_axis_ends_h
#define limber_problem_axis_ends_h

#include <string>
#include <utility>

namespace limber
{
  class Parameters;
  class Section;

  /** 'Lower end' and 'Upper end' of a shape along an axis. */
  void
  declare_axis_ends(Parameters &parameters);

  /** m; @p shape names it in the message that refuses ends in reverse. */
  std::pair<double, double>
  read_axis_ends(const Section &section, const std::string &shape);
} // namespace limber

#endif
