// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_kernel_h
#define limber_materials_kernel_h

namespace limber
{
  /** The functions of the nodes: a word for each type of basis (basis.h). */
  enum class KernelKind
  {
    automatic, // linear or quadratic, by bodies and frames
    linear,    // Q1 shape functions
    quadratic, // quadratic B-splines
    cubic,     // cubic B-splines
    gimp,      // linear, averaged over boxes of fixed size around points
    cpgimp,    // the same, with boxes that follow the stretch
    cpdi,      // linear, averaged over convected domains of points
    cpdi2,     // the same, with domains whose corners are carried along
    ddmp       // linear, with gradients that partly come from the nodes
  };

  inline constexpr bool
  is_spline(const KernelKind kernel)
  {
    return kernel == KernelKind::quadratic || kernel == KernelKind::cubic;
  }

  /** Whether points have domains over which linear functions are averaged. */
  inline constexpr bool
  has_domains(const KernelKind kernel)
  {
    return kernel == KernelKind::gimp || kernel == KernelKind::cpgimp ||
           kernel == KernelKind::cpdi || kernel == KernelKind::cpdi2;
  }

  /** Whether liquids have linear functions with it, which it leaves to solids.
   */
  inline constexpr bool
  is_for_solids(const KernelKind kernel)
  {
    return has_domains(kernel) || kernel == KernelKind::ddmp;
  }
} // namespace limber

#endif
