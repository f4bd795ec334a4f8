// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_projection_h
#define limber_materials_projection_h

namespace limber
{
  /**
   * Which parts of strain and stress are averaged over the points of a body
   * (Hu-Washizu, Mast et al. 2012): in a cell (DGQ0 functions), or around each
   * node (Q1 functions, lumped).
   */
  enum class Projection
  {
    automatic,      // to be chosen from the law when the scene is read
    none,           // nothing
    cell,           // in a cell: the volumetric part
    cell_shear,     // the volumetric part and the shear components
    cell_full,      // everything
    assumed_strain, // everything but what resists hourglass modes as bending
    node,           // around nodes: the volumetric part
    hybrid          // the same, and the shear components in a cell
  };



  /** Whether the volumetric part is averaged around nodes. */
  constexpr bool
  averages_around_nodes(const Projection kind)
  {
    return kind == Projection::node || kind == Projection::hybrid;
  }



  /** Whether the volumetric part is constant in a cell. */
  constexpr bool
  averages_volume_in_cells(const Projection kind)
  {
    return kind == Projection::cell || kind == Projection::cell_shear ||
           kind == Projection::cell_full;
  }



  /** Whether the shear components are constant in a cell. */
  constexpr bool
  averages_shear_in_cells(const Projection kind)
  {
    return kind == Projection::cell_shear || kind == Projection::cell_full ||
           kind == Projection::hybrid;
  }



  /** Whether strain and stress are formed with means over a cell. */
  constexpr bool
  needs_cell_means(const Projection kind)
  {
    return kind != Projection::none && kind != Projection::node;
  }



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
