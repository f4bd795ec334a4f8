// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_kernel_h
#define limber_materials_kernel_h

namespace limber
{
  /**
   * The shape functions of the grid (the MPM kernel): one value for each type
   * of basis (interpolation/basis.h).
   */
  enum class KernelKind
  {
    automatic, // chosen from the bodies and their frames: linear or quadratic
    linear,    // Q1 shape functions
    quadratic, // quadratic B-splines
    cubic,     // cubic B-splines
    gimp,      // linear functions averaged over fixed boxes (uGIMP)
    cpgimp,    // the same, boxes follow the stretch (cpGIMP)
    cpdi,      // the same over parallelepipeds convected by F
    cpdi2,     // the same, each corner moves with the grid velocity
    ddmp       // dual domain MPM: gradients partly from nodal means
  };

  inline constexpr bool
  is_spline(const KernelKind kernel)
  {
    return kernel == KernelKind::quadratic || kernel == KernelKind::cubic;
  }

  /**
   * Whether points have domains over which linear functions are averaged (GIMP,
   * CPDI).
   */
  inline constexpr bool
  has_domains(const KernelKind kernel)
  {
    return kernel == KernelKind::gimp || kernel == KernelKind::cpgimp ||
           kernel == KernelKind::cpdi || kernel == KernelKind::cpdi2;
  }

  /**
   * Whether this kernel is for solids only: liquids in the same scene then use
   * linear functions.
   */
  inline constexpr bool
  is_for_solids(const KernelKind kernel)
  {
    return has_domains(kernel) || kernel == KernelKind::ddmp;
  }
} // namespace limber

#endif
