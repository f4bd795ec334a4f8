// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_frame_h
#define limber_materials_frame_h

#include <limber/materials/projection.h>

namespace limber
{
  /** Where the functions of the grid are taken at the points of a body. */
  enum class Frame
  {
    automatic, // current or initial, by body and sides
    current,   // where the points are: they may flow, meet, and cross cells
    initial    // where they were at the start (total Lagrangian): none crosses
  };



  /** How a body in its initial frame gets its stress to the nodes. */
  struct InitialFrameForce
  {
    bool             finite_strain = true; // stress on the deformed body
    StrainProjection projection; // of F: assumed strain; others need none
  };
} // namespace limber

#endif
