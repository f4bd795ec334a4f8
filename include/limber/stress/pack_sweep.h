// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_pack_sweep_h
#define limber_stress_pack_sweep_h

#include <limber/stress/pack_strain.h>

namespace limber
{
  /**
   * Strain points by the functions of a basis with any of the projections it
   * knows, and move them, as StrainSweep; @p law is called once per pack.
   */
  template <class Basis>
  StressSummary
  strain_packs(const PointView<Basis::dim>  &points,
               const GridView<Basis::dim>   &grid,
               const CellSums<Basis::dim>   *sums,
               const StressSweep            &what,
               const StrainProjection       &projection,
               const PackStrain<Basis::dim> &law,
               PackFindings<Basis::dim>     &found);



  /**
   * StressUpdate of a law that is called once per pack: a basis is compiled
   * once for all laws.
   */
  template <class Basis, class Law>
  class PackSweep final : public LawOnPacks<Basis::dim, Law>
  {
    static constexpr int dim = Basis::dim;

  public:
    using LawOnPacks<dim, Law>::LawOnPacks;

    StressSummary
    update(const PointView<dim> &points,
           const GridView<dim>  &grid,
           const CellSums<dim>  *sums,
           const StressSweep    &what) const override
    {
      PackFindings<dim>   found;
      const StressSummary moved = strain_packs<Basis>(
        points, grid, sums, what, this->strain_projection, *this, found);
      return this->whole_summary(found, moved);
    }
  };
} // namespace limber

#endif
