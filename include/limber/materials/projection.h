// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_projection_h
#define limber_materials_projection_h

namespace limber
{
  /**
   * Which parts of strain and stress are averaged over the points of a body
   * in a cell (Hu-Washizu, Mast et al. 2012, with DGQ0 functions).
   */
  enum class Projection
  {
    automatic,     // to be chosen from the law when the scene is read
    none,          // nothing
    cell,          // the volumetric part
    cell_shear,    // the volumetric part and the shear components
    cell_full,     // everything
    assumed_strain // everything but what resists hourglass modes as bending
  };



  /** The strain that an hourglass mode gets under the assumed strain. */
  enum class HourglassResponse
  {
    bending,       // that of a beam in bending, from the moduli of the law
    deviatoric,    // the deviator of its own, in the plane of the mode
    incompressible // no change of volume
  };



  /**
   * A projection and, for the assumed strain, the share of an hourglass mode
   * that goes to the normal strain of its own direction and of its mate's:
   * (e1, e2) of theory/treatments.md for modes bilinear in two coordinates,
   * and the same for the trilinear one.
   */
  struct StrainProjection
  {
    Projection kind           = Projection::none;
    double     own            = 1;
    double     mate           = 0;
    double     trilinear_own  = 1;
    double     trilinear_mate = 0;
  };
} // namespace limber

#endif
