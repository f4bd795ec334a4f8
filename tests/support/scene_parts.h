// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef tests_support_scene_parts_h
#define tests_support_scene_parts_h

#include <string>

/** @file Pieces of which the scenes of tests are put together. */
namespace limber
{
  /** A box in the plane whose sides nothing feels. */
  inline const std::string free_sides = R"(
    subsection Boundaries
      set left = free
      set right = free
      set bottom = free
      set top = free
    end
)";



  /** The material of a body: of density 1 kg/m^3, with E (Pa) and nu. */
  inline std::string
  rubber(const std::string &young, const std::string &poisson)
  {
    return R"(
      set Material = neo hookean
      subsection Neo hookean
        set Density = 1
        set Young's modulus = )" +
           young + R"(
        set Poisson's ratio = )" +
           poisson + R"(
      end
)";
  }
} // namespace limber

#endif
