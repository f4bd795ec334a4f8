// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_dual_domain_sweep_h
#define limber_stress_dual_domain_sweep_h

#include <limber/stress/pack_strain.h>

namespace limber
{
  /**
   * Strain points by the gradients of the dual domain method
   * (interpolation/dual_domain.h), with the nodal mean gradients stored in the
   * grid, and move them (StressSweep); @p law is called once per pack. The
   * treatment is 'none', 'cell' or 'node'.
   */
  template <int dim>
  StressSummary
  strain_by_dual_domain(const PointView<dim> &points,
                        const GridView<dim>  &grid,
                        const CellSums<dim> *,
                        const StressSweep     &what,
                        const StrainTreatment &treatment,
                        const PackStrain<dim> &law,
                        PackFindings<dim>     &found);

} // namespace limber

#endif
