// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_projections_h
#define limber_tests_support_projections_h

#include <limber/materials/projection.h>

namespace limber
{
  namespace testing_support
  {
    constexpr Projection all_projections[] = {Projection::none,
                                              Projection::cell,
                                              Projection::cell_shear,
                                              Projection::cell_full,
                                              Projection::assumed_strain,
                                              Projection::node,
                                              Projection::hybrid};



    /** With a response to hourglass modes that makes any mistake show. */
    inline StrainProjection
    projection_of(const Projection kind)
    {
      return {kind, 0.9, -0.7, 0.8, -0.3};
    }
  } // namespace testing_support
} // namespace limber

#endif
