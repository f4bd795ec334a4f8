// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>

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
} // namespace limber
