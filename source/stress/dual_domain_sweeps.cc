// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/dual_domain_sweep.h>
#include <limber/stress/make_sweep.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_dual_domain_sweep(const AnyLaw &any, const StrainProjection &projection)
  {
    return std::visit(
      [&](const auto &law) -> std::unique_ptr<const StressUpdate<dim>> {
        using Law = std::decay_t<decltype(law)>;
        return std::make_unique<DualDomainSweep<dim, Law>>(law, projection);
      },
      any);
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_dual_domain_sweep(const AnyLaw &, const StrainProjection &);
  template std::unique_ptr<const StressUpdate<3>>
  make_dual_domain_sweep(const AnyLaw &, const StrainProjection &);
} // namespace limber
