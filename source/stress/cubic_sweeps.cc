// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/spline.h>
#include <limber/stress/make_sweep.h>
#include <limber/stress/sweeps.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_cubic_sweep(const AnyLaw          &any,
                   const StrainTreatment &treatment,
                   const Frame            frame)
  {
    if (frame == Frame::initial)
      return std::visit(
        [&](const auto &law) {
          return make_initial_frame_sweep<Cubic<dim>>(law, treatment);
        },
        any);
    return make_pack_sweep<dim>(any, treatment, {strain_packs<Cubic<dim>>});
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_cubic_sweep(const AnyLaw &, const StrainTreatment &, Frame);
  template std::unique_ptr<const StressUpdate<3>>
  make_cubic_sweep(const AnyLaw &, const StrainTreatment &, Frame);
} // namespace limber
