// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_dual_domain_sweep_h
#define limber_stress_dual_domain_sweep_h

#include <limber/stress/pack_strain.h>

namespace limber
{
  /**
   * Strain points by the gradients of the dual domain method
   * (interpolation/dual_domain.h), whose means around nodes the grid holds, and
   * move them (StressSweep); @p law is called once per pack. The projection is
   * 'none', 'cell' or 'node'.
   */
  template <int dim>
  StressSummary
  strain_by_dual_domain(const PointView<dim>  &points,
                        const GridView<dim>   &grid,
                        const StressSweep     &what,
                        Projection             kind,
                        const PackStrain<dim> &law,
                        PackFindings<dim>     &found);



  /** StressUpdate of a law with the dual domain method. */
  template <int dim, class Law>
  class DualDomainSweep final : public LawOnPacks<dim, Law>
  {
  public:
    using LawOnPacks<dim, Law>::LawOnPacks;

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim> *,
           const StressSweep &what) const override
    {
      PackFindings<dim>   found;
      const StressSummary moved = strain_by_dual_domain<dim>(
        points, grid, what, this->strain_projection.kind, *this, found);
      return this->whole_summary(found, moved);
    }
  };
} // namespace limber

#endif
