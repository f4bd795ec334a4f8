// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_treatment_h
#define limber_materials_treatment_h

namespace limber
{
  /**
   * Which parts of strain and stress are averaged over the points of a body
   * (Hu-Washizu, Mast et al. 2012): in a cell (DGQ0 functions), or around each
   * node (Q1 functions, lumped).
   */
  enum class Treatment
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



  /** Over what a part of strain and stress is averaged. */
  enum class Mean
  {
    none,
    cell,
    node
  };



  /** A treatment against locking: how the scene calls it and what it does. */
  struct TreatmentRow
  {
    Treatment   kind;
    const char *word, *text;
    // Of the volumetric part, the shear components, the deviatoric rest
    Mean volume = Mean::none, shear = Mean::none, rest = Mean::none;
    // Other sums over a cell that strain and stress are formed with
    bool needs_moments = false;
    // Whether means leave motions of a cell without resistance in a solid
    bool weak_in_2d = false, weak_in_3d = false;
    // Whether bodies in the initial frame have it, and points with domains
    bool in_initial_frame = false, with_domains = false;
  };



  /**
   * The list of treatments. What the scene accepts
   * and what the averages_...() below say follow from it; the strain operator
   * of each is in interpolation/strain_operator.h.
   */
  inline constexpr TreatmentRow treatments[] = {
    {Treatment::automatic,
     "auto",
     "'cell' for liquids; for solids 'assumed strain' with linear functions, "
     "else 'none', 'node' or (initial frame) 'cell', by Poisson's ratio",
     Mean::none,
     Mean::none,
     Mean::none,
     false,
     false,
     false,
     true,
     true},
    {Treatment::none,
     "none",
     "values of the points as they are",
     Mean::none,
     Mean::none,
     Mean::none,
     false,
     false,
     false,
     true,
     true},
    {Treatment::cell,
     "cell",
     "Hu-Washizu, volumetric strain and pressure constant in the cell",
     Mean::cell,
     Mean::none,
     Mean::none,
     false,
     false,
     false,
     true,
     true},
    {Treatment::cell_shear,
     "cell shear",
     "volumetric strain, shear strain and their stresses constant",
     Mean::cell,
     Mean::cell,
     Mean::none,
     false,
     false,
     true},
    {Treatment::cell_full,
     "cell full",
     "all strain and stress constant",
     Mean::cell,
     Mean::cell,
     Mean::cell,
     false,
     true,
     true},
    {Treatment::node,
     "node",
     "volumetric strain and pressure averaged around nodes, linear between",
     Mean::node,
     Mean::none,
     Mean::none,
     false,
     false,
     false,
     false,
     true},
    {Treatment::hybrid,
     "hybrid",
     "as 'node', and shear strain and its stress constant in the cell",
     Mean::node,
     Mean::cell,
     Mean::none,
     false,
     false,
     true},
    {Treatment::assumed_strain,
     "assumed strain",
     "constant but for what bends the cell, see 'Hourglass response'",
     Mean::none,
     Mean::none,
     Mean::none,
     true,
     false,
     false,
     true,
     false}};



  /** The row of a treatment. */
  constexpr const TreatmentRow &
  treatment_of(const Treatment kind)
  {
    for (const TreatmentRow &treatment : treatments)
      if (treatment.kind == kind)
        return treatment;
    return treatments[0]; // every kind has its row
  }



  /** Whether the volumetric part is averaged around nodes. */
  constexpr bool
  averages_around_nodes(const Treatment kind)
  {
    return treatment_of(kind).volume == Mean::node;
  }



  /** Whether the volumetric part is constant in a cell. */
  constexpr bool
  averages_volume_in_cells(const Treatment kind)
  {
    return treatment_of(kind).volume == Mean::cell;
  }



  /** Whether the shear components are constant in a cell. */
  constexpr bool
  averages_shear_in_cells(const Treatment kind)
  {
    return treatment_of(kind).shear == Mean::cell;
  }



  /** Whether strain and stress are formed with means over a cell. */
  constexpr bool
  needs_cell_means(const Treatment kind)
  {
    const TreatmentRow &treatment = treatment_of(kind);
    return treatment.volume == Mean::cell || treatment.shear == Mean::cell ||
           treatment.needs_moments;
  }



  /** The strain that an hourglass mode gets under the assumed strain. */
  enum class HourglassResponse
  {
    automatic,     // to be chosen from the law when the scene is read
    bending,       // that of a beam in bending, from the moduli of the law
    deviatoric,    // the deviator of its own, in the plane of the mode
    incompressible // no change of volume
  };



  /**
   * A treatment and, for the assumed strain, the share of an hourglass mode
   * that goes to the normal strain of its own direction and of its mate's:
   * (e1, e2) of theory/treatments.md for modes bilinear in two coordinates,
   * and the same for the trilinear one.
   */
  struct StrainTreatment
  {
    Treatment kind           = Treatment::none;
    double    own            = 1;
    double    mate           = 0;
    double    trilinear_own  = 1;
    double    trilinear_mate = 0;
  };
} // namespace limber

#endif
