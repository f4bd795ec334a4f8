// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>
#include <limber/materials/plastic_strain.h>

#include <algorithm>

namespace limber
{
  std::optional<unsigned int>
  plastic_strain_of(const std::string &law, const std::vector<double> &values)
  {
    const auto variables = variables_of(law, values);
    const auto found     = std::find_if(variables.begin(),
                                    variables.end(),
                                    [](const StateVariable &variable) {
                                      return std::string(variable.name) ==
                                             "equivalent plastic strain";
                                    });
    if (found == variables.end())
      return {};
    return found - variables.begin();
  }
} // namespace limber
