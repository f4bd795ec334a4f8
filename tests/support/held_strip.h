// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_held_strip_h
#define limber_tests_support_held_strip_h

#include <string>

namespace limber
{
  // A strip that is held at its left end; the current frame, so that points
  // leave their cells
  inline const std::string held_strip = R"(
    set End time = 1
    set Bodies = strip
    subsection Body strip
      subsection Box
        set Lower corner = 0, 2
        set Upper corner = 8, 3
      end
      set Points per cell edge = 2
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
    end
    subsection Grid
      set Upper corner = 10, 5
      set Cells = 20, 10
    end
    subsection Boundaries
      set left = no slip
      set right = free
      set bottom = free
      set top = free
    end)";
} // namespace limber

#endif
