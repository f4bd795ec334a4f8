// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_strain_treatment_h
#define limber_stress_strain_treatment_h

#include <limber/materials/treatment.h>

#include <stdexcept>

namespace limber
{
  /**
   * The factors of the assumed strain for an hourglass mode. With 'bending' it
   * resists as a beam does: the transverse (mate) strain is -nu / (1 - nu) of
   * that along the beam in plane strain, and -nu in both directions in the
   * trilinear mode (doc/theory/treatments.md).
   */
  template <class Law>
  inline StrainTreatment
  strain_treatment(const Law              &law,
                   const Treatment         kind,
                   const HourglassResponse response)
  {
    const double    K = law.bulk_modulus, G = law.shear_modulus;
    StrainTreatment result;
    result.kind = kind;
    switch (response)
      {
        case HourglassResponse::automatic:
          throw std::logic_error("no hourglass response chosen");
        case HourglassResponse::bending:
          result.own            = 1;
          result.mate           = -(K - 2. / 3. * G) / (K + 4. / 3. * G);
          result.trilinear_own  = 1;
          result.trilinear_mate = -(3 * K - 2 * G) / (2 * (3 * K + G));
          break;
        case HourglassResponse::deviatoric:
          result.own            = 0.5;
          result.mate           = -0.5;
          result.trilinear_own  = 2. / 3.;
          result.trilinear_mate = -1. / 3.;
          break;
        case HourglassResponse::incompressible:
          result.own            = 1;
          result.mate           = -1;
          result.trilinear_own  = 1;
          result.trilinear_mate = -0.5;
          break;
      }
    return result;
  }
} // namespace limber

#endif
