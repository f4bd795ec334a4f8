// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_point_start_h
#define limber_materials_point_start_h

#include <limber/base/law_parameter.h>
#include <limber/materials/law.h>

#include <optional>

namespace limber
{
  /** Initial stress and history variables of a point. */
  template <int dim>
  struct PointStart
  {
    double                pressure = 0; // Cauchy, Pa
    Deviator<dim, double> deviator{};   // Cauchy, Pa; not for liquids
    // By index of the law's variables; those not given are as in virgin
    // material.
    std::array<std::optional<double>, max_variables> variables;

    bool
    is_under_stress() const
    {
      return pressure != 0 || squared_norm<dim, double>(deviator) > 0;
    }
  };
} // namespace limber

#endif
