// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_projections_h
#define limber_tests_support_projections_h

#include <limber/materials/kernel.h>
#include <limber/materials/projection.h>

#include <vector>

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



    /** Those that a kernel has. */
    template <KernelKind kernel>
    std::vector<Projection>
    projections_of()
    {
      std::vector<Projection> result;
      for (const Projection kind : all_projections)
        if (kernel == KernelKind::linear || kind != Projection::assumed_strain)
          result.push_back(kind);
      return result;
    }



    /** With a response to hourglass modes that makes any mistake show. */
    inline StrainProjection
    projection_of(const Projection kind)
    {
      return {kind, 0.9, -0.7, 0.8, -0.3};
    }
  } // namespace testing_support
} // namespace limber

#endif
