// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_touching_bodies_h
#define limber_tests_support_touching_bodies_h

#include <support/scene_parts.h>
#include <support/scene_run.h>

#include <algorithm>

/** @file What tests of contact with bodies and with obstacles share. */
namespace limber
{
  namespace touching
  {
    inline const double slope = std::acos(-1.) / 6; // 30 degrees

    // Of 1 m x 0.5 m; the box comes with the scene
    inline const std::string soft_block = R"(
    subsection Body block
      subsection Linear elastic
        set Density = 1000
        set Young's modulus = 1e6
        set Poisson's ratio = 0.3
      end
    end)";



    /** Of what slides down the slope, m/s^2. */
    inline double
    sliding_acceleration(const double friction)
    {
      return 9.81 * (std::sin(slope) - friction * std::cos(slope));
    }



    /** The least coordinate of a body's points, m. */
    inline double
    lowest(SceneRun<2> &run, const unsigned int body, const int d)
    {
      double result = 1e300;
      for (const auto &place : run.positions(body))
        result = std::min(result, place[d]);
      return result;
    }



    /** The greatest one, m. */
    inline double
    highest(SceneRun<2> &run, const unsigned int body, const int d)
    {
      double result = -1e300;
      for (const auto &place : run.positions(body))
        result = std::max(result, place[d]);
      return result;
    }
  } // namespace touching
} // namespace limber

#endif
