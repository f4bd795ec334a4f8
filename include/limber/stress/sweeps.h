// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_stress_sweeps_h
#define limber_stress_sweeps_h

#include <limber/materials/law_list.h>
#include <limber/stress/stress_update.h>

#include <memory>

namespace limber
{
  /** The sweeps of all laws, each basis in its own translation unit. */
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_linear_sweep(const AnyLaw          &law,
                    const StrainTreatment &treatment,
                    Frame                  frame);
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_quadratic_sweep(const AnyLaw          &law,
                       const StrainTreatment &treatment,
                       Frame                  frame);
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_cubic_sweep(const AnyLaw          &law,
                   const StrainTreatment &treatment,
                   Frame                  frame);
} // namespace limber

#endif
