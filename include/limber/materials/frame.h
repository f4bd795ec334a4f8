// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_frame_h
#define limber_materials_frame_h

namespace limber
{
  /** Where the functions of the grid are taken at the points of a body. */
  enum class Frame
  {
    automatic, // current or initial, by body and sides
    current,   // where the points are: they may flow, meet, and cross cells
    initial    // where they were at the start (total Lagrangian): none crosses
  };

} // namespace limber

#endif
