// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>

#include <algorithm>

namespace limber
{
  const std::vector<LawDescription> &
  describe_laws()
  {
    static const std::vector<LawDescription> laws = []() {
      std::vector<LawDescription> result;
      for_each_law([&](auto *const law) {
        using Law = std::remove_pointer_t<decltype(law)>;
        static_assert(sizeof(CheckLaw<Law>) > 0);
        if (result.empty() || result.back().name != Law::name)
          result.push_back({Law::name,
                            Law::text,
                            Law::takes_pressure,
                            Law::is_elastic,
                            {Law::parameters.begin(), Law::parameters.end()}});
      });
      return result;
    }();
    return laws;
  }



  Moduli
  moduli_of(const std::string &name, const std::vector<double> &values)
  {
    Moduli result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      std::array<double, Law::parameters.size()> own;
      if (name != Law::name || values.size() != own.size())
        return;
      std::copy(values.begin(), values.end(), own.begin());
      if (!Law::accepts(own))
        return;
      const Law law(own);
      result = {law.bulk_modulus, law.shear_modulus};
    });
    return result;
  }
} // namespace limber
