// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/interpolation/linear.h>
#include <limber/stress/make_sweep.h>
#include <limber/stress/sweeps.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_linear_sweep(const AnyLaw          &any,
                    const StrainTreatment &treatment,
                    const Frame            frame)
  {
    return std::visit(
      [&](const auto &law) {
        return frame == Frame::initial ?
                 make_initial_frame_sweep<Linear<dim>>(law, treatment) :
                 make_sweep<Linear<dim>>(law, treatment);
      },
      any);
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_linear_sweep(const AnyLaw &, const StrainTreatment &, Frame);
  template std::unique_ptr<const StressUpdate<3>>
  make_linear_sweep(const AnyLaw &, const StrainTreatment &, Frame);
} // namespace limber
