// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_strain_packs_h
#define limber_stress_strain_packs_h

#include <limber/interpolation/basis.h>
#include <limber/stress/pack_strain.h>
#include <limber/stress/strain_sweep.h>

#include <stdexcept>

/**
 * @file Definition of strain_packs(), for the translation unit of each basis.
 */
namespace limber
{
  namespace internal
  {
    template <int dim>
    struct CallOnPacks
    {
      template <class Lanes>
      __attribute__((always_inline)) PointPack<dim>
      operator()(const PointView<dim>                       &points,
                 const Lanes                                &lanes,
                 const MotionIncrement<dim, PointPack<dim>> &motion,
                 const HistoryChange                        &change,
                 PackFindings<dim>                          &found) const
      {
        return law.strain_pack(points, lanes, motion, change, found);
      }

      const PackStrain<dim> &law;
    };
  } // namespace internal



  /**
   * Strain points by the functions of a basis with any of the treatments it
   * knows, and move them, as StrainSweep; @p law is called once per pack.
   */
  template <class Basis>
  StressSummary
  strain_packs(const PointView<Basis::dim>  &points,
               const GridView<Basis::dim>   &grid,
               const CellSums<Basis::dim>   *sums,
               const StressSweep            &what,
               const StrainTreatment        &treatment,
               const PackStrain<Basis::dim> &law,
               PackFindings<Basis::dim>     &found)
  {
    using Call      = internal::CallOnPacks<Basis::dim>;
    using P         = Treatment;
    const auto with = [&](const auto kind) {
      return StrainSweep<Basis, decltype(kind)::value, true, Call>::run(
        points, grid, sums, what, treatment, Call{law}, found);
    };
    switch (treatment.kind)
      {
        case P::none:
          return with(std::integral_constant<P, P::none>());
        case P::cell:
          return with(std::integral_constant<P, P::cell>());
        case P::node:
          return with(std::integral_constant<P, P::node>());
        case P::cell_shear:
          return with(std::integral_constant<P, P::cell_shear>());
        case P::cell_full:
          return with(std::integral_constant<P, P::cell_full>());
        case P::hybrid:
          return with(std::integral_constant<P, P::hybrid>());
        case P::assumed_strain:
          if constexpr (has_bending_modes<Basis>)
            return with(std::integral_constant<P, P::assumed_strain>());
          break;
        case P::automatic:
          break;
      }
    throw std::logic_error("no such treatment with this basis");
  }
} // namespace limber

#endif
