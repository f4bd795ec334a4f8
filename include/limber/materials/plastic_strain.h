// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_materials_plastic_strain_h
#define limber_materials_plastic_strain_h

#include <optional>
#include <string>
#include <vector>

namespace limber
{
  /**
   * The index of 'equivalent plastic strain' among the named variables of the
   * law of that name (variables_of()), if it has it; @p values in the order of
   * its entries.
   */
  std::optional<unsigned int>
  plastic_strain_of(const std::string &law, const std::vector<double> &values);
} // namespace limber

#endif
