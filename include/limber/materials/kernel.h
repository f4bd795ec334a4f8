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
    cpdi       // linear, averaged over convected domains of points
  };

  inline constexpr bool
  is_spline(const KernelKind kernel)
  {
    return kernel == KernelKind::quadratic || kernel == KernelKind::cubic;
  }
} // namespace limber

#endif
