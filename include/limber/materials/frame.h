// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_frame_h
#define limber_materials_frame_h

namespace limber
{
  /**
   * The configuration in which shape functions are evaluated at the points of a
   * body (updated or total Lagrangian).
   */
  enum class Frame
  {
    automatic, // current or initial, chosen from body and sides
    current,   // updated Lagrangian: points move through cells
    initial    // total Lagrangian: at reference places, no crossing
  };

} // namespace limber

#endif
