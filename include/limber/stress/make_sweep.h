// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_make_sweep_h
#define limber_stress_make_sweep_h

#include <limber/interpolation/basis.h>
#include <limber/materials/law_list.h>
#include <limber/stress/initial_frame_sweep.h>
#include <limber/stress/law_sweep.h>
#include <limber/stress/pack_sweep.h>
#include <limber/stress/strain_packs.h>

#include <memory>
#include <stdexcept>

/** @file The sweeps of a law, for each basis. */
namespace limber
{
  /**
   * The fastest sweep there is. Common treatments are compiled for each law,
   * `assumed strain` for solids only; not for plastic laws, as a return mapping
   * takes longer than a virtual call per pack.
   */
  template <class Basis, class Law>
  std::unique_ptr<const StressUpdate<Basis::dim>>
  make_sweep(const Law &law, const StrainTreatment &treatment)
  {
    [[maybe_unused]] const auto with = [&](const auto kind) {
      using Sweep = LawSweep<Basis, Law, decltype(kind)::value>;
      return std::unique_ptr<const StressUpdate<Basis::dim>>(
        std::make_unique<Sweep>(law, treatment));
    };
    using P = Treatment;
    if constexpr (!Law::is_plastic)
      switch (treatment.kind)
        {
          case P::none:
            return with(std::integral_constant<P, P::none>());
          case P::cell:
            return with(std::integral_constant<P, P::cell>());
          case P::assumed_strain:
            if constexpr (Law::is_elastic)
              return with(std::integral_constant<P, P::assumed_strain>());
            break;
          default:
            break;
        }
    return make_pack_sweep<Basis::dim>(law, treatment, {strain_packs<Basis>});
  }



  /** Sweeps in the initial frame (total Lagrangian), of solids. */
  template <class Basis, class Law>
  std::unique_ptr<const StressUpdate<Basis::dim>>
  make_initial_frame_sweep(const Law                              &law,
                           [[maybe_unused]] const StrainTreatment &treatment)
  {
    const auto with = [&](const auto kind) {
      using Sweep = InitialFrameSweep<Basis, Law, decltype(kind)::value>;
      return std::unique_ptr<const StressUpdate<Basis::dim>>(
        std::make_unique<Sweep>(law, treatment));
    };
    using P = Treatment;
    if constexpr (Law::is_elastic || Law::is_plastic)
      switch (treatment.kind)
        {
          case P::none:
            return with(std::integral_constant<P, P::none>());
          case P::cell:
            return with(std::integral_constant<P, P::cell>());
          case P::assumed_strain:
            if constexpr (has_bending_modes<Basis>)
              return with(std::integral_constant<P, P::assumed_strain>());
            break;
          default:
            break;
        }
    throw std::logic_error("law or treatment without an initial frame");
  }

} // namespace limber

#endif
