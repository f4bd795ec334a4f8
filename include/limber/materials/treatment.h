// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_treatment_h
#define limber_materials_treatment_h

namespace limber
{
  /**
   * Locking treatments (B-bar, Hu-Washizu; Mast et al. 2012): which parts of
   * strain and stress are averaged over the points of a body, either in a cell
   * (piecewise constant, DGQ0) or around each node (continuous Q1, lumped).
   */
  enum class Treatment
  {
    automatic,      // chosen from the law when the scene is read
    none,           // full strain of each point
    cell,           // volumetric part, mean of the cell (B-bar)
    cell_shear,     // the volumetric part and the shear components
    cell_full,      // all components, mean of the cell
    assumed_strain, // all but the bending part of hourglass modes
    node,           // volumetric part, mean around nodes
    hybrid          // as node, and the shear components as in cell_shear
  };



  /** What a part of strain and stress is averaged over. */
  enum class Mean
  {
    none,
    cell,
    node
  };



  /**
   * A locking treatment: its word and help text in the scene, and what it does.
   */
  struct TreatmentRow
  {
    Treatment   kind;
    const char *word, *text;
    // Means of the volumetric part, the shear components, and the rest of the
    // deviator (normal components)
    Mean volume = Mean::none, shear = Mean::none, rest = Mean::none;
    // Whether further moments of the points of a cell are needed (centroid,
    // products of coordinates)
    bool needs_moments = false;
    // Whether hourglass modes remain without stiffness in a solid
    bool weak_in_2d = false, weak_in_3d = false;
    // Whether it may be used with the initial frame, and with points with
    // domains (GIMP, CPDI)
    bool in_initial_frame = false, with_domains = false;
  };



  /**
   * The list of treatments, from which the words of the scene and the
   * averages_...() below follow; the strain operator of each is in
   * interpolation/strain_operator.h.
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



  /**
   * The strain that the assumed strain treatment gives to an hourglass mode.
   */
  enum class HourglassResponse
  {
    automatic,     // chosen from the law when the scene is read
    bending,       // as a beam in bending, by the moduli of the law
    deviatoric,    // the deviator of the mode, in its plane
    incompressible // no volume strain
  };



  /**
   * A treatment and, for the assumed strain, the factors with which an
   * hourglass mode enters the normal strain of its own direction and of the
   * other direction (mate) in its plane: (e1, e2) of theory/treatments.md for
   * bilinear modes, and the same for the trilinear one.
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
