// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/convected_sweep.h>
#include <limber/stress/make_sweep.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_convected_sweep(const AnyLaw &any, const StrainProjection &projection)
  {
    return std::visit(
      [&](const auto &law) -> std::unique_ptr<const StressUpdate<dim>> {
        using Law = std::decay_t<decltype(law)>;
        switch (projection.kind)
          {
            case Projection::none:
              return std::make_unique<
                ConvectedSweep<dim, Law, Projection::none>>(law, projection);
            case Projection::cell:
              return std::make_unique<
                ConvectedSweep<dim, Law, Projection::cell>>(law, projection);
            case Projection::node:
              return std::make_unique<
                ConvectedSweep<dim, Law, Projection::node>>(law, projection);
            default:
              throw std::logic_error("no such projection with domains");
          }
      },
      any);
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_convected_sweep(const AnyLaw &, const StrainProjection &);
  template std::unique_ptr<const StressUpdate<3>>
  make_convected_sweep(const AnyLaw &, const StrainProjection &);
} // namespace limber
