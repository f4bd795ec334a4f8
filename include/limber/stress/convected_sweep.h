// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_convected_sweep_h
#define limber_stress_convected_sweep_h

#include <limber/stress/pack_strain.h>

namespace limber
{
  /**
   * Strain points with domains (GIMP, CPDI) by the mean velocity gradient over
   * them, or by differences between their corners, move them, and do G2P in the
   * same sweep if requested (StressSweep); @p law is called once per pack. The
   * treatment is 'none', 'cell' or 'node'.
   */
  template <int dim>
  StressSummary
  strain_domains(const PointView<dim> &points,
                 const GridView<dim>  &grid,
                 const CellSums<dim> *,
                 const StressSweep     &what,
                 const StrainTreatment &treatment,
                 const PackStrain<dim> &law,
                 PackFindings<dim>     &found);

} // namespace limber

#endif
