// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/materials/law_list.h>
#include <limber/stress/law_sweep.h>

#include <stdexcept>

namespace limber
{
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_stress_update(const std::string         &name,
                     const std::vector<double> &values,
                     const bool                 projected)
  {
    std::unique_ptr<const StressUpdate<dim>> result;
    for_each_law([&](auto *const candidate) {
      using Law = std::remove_pointer_t<decltype(candidate)>;
      if (result || name != Law::name)
        return;
      std::array<double, Law::parameters.size()> own;
      if (values.size() != own.size())
        throw std::logic_error("wrong number of parameters for " + name);
      std::copy(values.begin(), values.end(), own.begin());
      if (!Law::accepts(own))
        return;
      const Law law(own);
      if (projected)
        result = std::make_unique<LawSweep<dim, Law, true>>(law);
      else
        result = std::make_unique<LawSweep<dim, Law, false>>(law);
    });
    if (!result)
      throw std::logic_error("no law " + name);
    return result;
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_stress_update(const std::string &, const std::vector<double> &, bool);
  template std::unique_ptr<const StressUpdate<3>>
  make_stress_update(const std::string &, const std::vector<double> &, bool);
} // namespace limber
