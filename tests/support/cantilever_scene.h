// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_cantilever_scene_h
#define limber_tests_support_cantilever_scene_h

#include <string>

namespace limber
{
  /**
   * A linear elastic cantilever of 8 m x 1 m, set free in its first bending
   * mode; four cells over the depth. Poisson's ratio 0.3, period 12.1 s. 'v0'
   * of the body's constants is the speed of its end, m/s.
   */
  inline const std::string cantilever_scene = R"(
    set Bodies = beam
    subsection Body beam
      subsection Box
        set Lower corner = 0, 2
        set Upper corner = 8, 3
      end
      set Constants = v0 = 0.01
      set Initial velocity = 0; v0/2*(cosh(1.875104068711961*x/8))"
                                              R"( - cos(1.875104068711961*x/8))"
                                              R"( - 0.734095513758924*()"
                                              R"(sinh(1.875104068711961*x/8))"
                                              R"( - sin(1.875104068711961*x/8)))
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
    end
    subsection Grid
      set Upper corner = 9, 5
      set Cells = 36, 20
    end
    subsection Boundaries
      set left = no slip
      set right = free
      set bottom = free
      set top = free
    end)";
} // namespace limber

#endif
