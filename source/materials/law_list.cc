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
                            Law::is_plastic,
                            {Law::parameters.begin(), Law::parameters.end()},
                            {}});
        // variables of the last variant, which has the most
        result.back().variables.assign(Law::variables.begin(),
                                       Law::variables.end());
      });
      return result;
    }();
    return laws;
  }



  namespace
  {
    /** Call work(law) for the law of that name with these values. */
    template <class Work>
    void
    with_law(const std::string         &name,
             const std::vector<double> &values,
             const Work                &work)
    {
      for_each_law([&](auto *const candidate) {
        using Law = std::remove_pointer_t<decltype(candidate)>;
        std::array<double, Law::parameters.size()> own;
        if (name != Law::name || values.size() != own.size())
          return;
        std::copy(values.begin(), values.end(), own.begin());
        if (Law::accepts(own))
          work(Law(own));
      });
    }
  } // namespace



  Moduli
  moduli_of(const std::string &name, const std::vector<double> &values)
  {
    Moduli result;
    with_law(name, values, [&](const auto &law) {
      result = {law.bulk_modulus, law.shear_modulus};
    });
    return result;
  }



  bool
  flows_by_rate(const std::string &name, const std::vector<double> &values)
  {
    bool result = false;
    with_law(name, values, [&](const auto &law) {
      if constexpr (std::decay_t<decltype(law)>::is_plastic)
        result = law.depends_on_rate();
    });
    return result;
  }



  bool
  flows_like_metal(const std::string &name, const std::vector<double> &values)
  {
    bool result = false;
    with_law(name, values, [&](const auto &law) {
      using Law = std::decay_t<decltype(law)>;
      if constexpr (Law::is_plastic)
        result = !Law::is_frictional && !law.depends_on_rate();
    });
    return result;
  }



  std::vector<StateVariable>
  variables_of(const std::string &name, const std::vector<double> &values)
  {
    std::vector<StateVariable> result;
    with_law(name, values, [&](const auto &law) {
      using Law = std::decay_t<decltype(law)>;
      result.assign(Law::variables.begin(), Law::variables.end());
    });
    return result;
  }



  std::string
  objection_to(const std::string &name, const std::vector<double> &values)
  {
    std::string result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      std::array<double, Law::parameters.size()> own;
      if (name != Law::name || values.size() != own.size())
        return;
      std::copy(values.begin(), values.end(), own.begin());
      if (const char *const found = Law::objection(own))
        result = found;
    });
    return result;
  }



  std::vector<std::string>
  names_of_variables()
  {
    std::vector<std::string> result;
    for (const LawDescription &law : describe_laws())
      for (const StateVariable &variable : law.variables)
        if (std::find(result.begin(), result.end(), variable.name) ==
            result.end())
          result.push_back(variable.name);
    return result;
  }
} // namespace limber
