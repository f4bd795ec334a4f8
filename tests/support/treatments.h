// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_tests_support_treatments_h
#define limber_tests_support_treatments_h

#include <limber/materials/kernel.h>
#include <limber/materials/treatment.h>

#include <vector>

namespace limber
{
  namespace testing_support
  {
    constexpr Treatment all_treatments[] = {Treatment::none,
                                            Treatment::cell,
                                            Treatment::cell_shear,
                                            Treatment::cell_full,
                                            Treatment::assumed_strain,
                                            Treatment::node,
                                            Treatment::hybrid};



    /** Those that a kernel has. */
    template <KernelKind kernel>
    std::vector<Treatment>
    treatments_of()
    {
      std::vector<Treatment> result;
      for (const Treatment kind : all_treatments)
        if (kernel == KernelKind::linear || kind != Treatment::assumed_strain)
          result.push_back(kind);
      return result;
    }



    /** With a response to hourglass modes that makes any mistake show. */
    inline StrainTreatment
    strain_treatment_of(const Treatment kind)
    {
      return {kind, 0.9, -0.7, 0.8, -0.3};
    }
  } // namespace testing_support
} // namespace limber

#endif
