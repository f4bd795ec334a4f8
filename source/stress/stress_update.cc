// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/convected_sweep.h>
#include <limber/stress/dual_domain_sweep.h>
#include <limber/stress/pack_sweep.h>
#include <limber/stress/strain_treatment.h>
#include <limber/stress/sweeps.h>

#include <stdexcept>

namespace limber
{
  namespace
  {
    /** A law without deviator has only its pressure to average. */
    template <class Law>
    Treatment
    treatment_for(const Treatment kind)
    {
      if (Law::has_deviator || kind == Treatment::none ||
          kind == Treatment::automatic)
        return kind;
      return averages_around_nodes(kind) ? Treatment::node : Treatment::cell;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_stress_update(const std::string         &name,
                     const std::vector<double> &values,
                     const Treatment            kind,
                     const HourglassResponse    response,
                     const Frame                frame,
                     const KernelKind           kernel)
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
      const Law  law(own);
      const auto treatment =
        strain_treatment(law, treatment_for<Law>(kind), response);
      if (kernel == KernelKind::quadratic)
        result = make_quadratic_sweep<dim>(law, treatment, frame);
      else if (kernel == KernelKind::cubic)
        result = make_cubic_sweep<dim>(law, treatment, frame);
      else if (frame == Frame::initial || kernel == KernelKind::linear)
        result = make_linear_sweep<dim>(law, treatment, frame);
      else if (kernel == KernelKind::ddmp)
        result =
          make_pack_sweep<dim>(law, treatment, {strain_by_dual_domain<dim>});
      else
        result =
          make_pack_sweep<dim>(law, treatment, {strain_domains<dim>, true});
    });
    if (!result)
      throw std::logic_error("no law " + name);
    return result;
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_stress_update(const std::string &,
                     const std::vector<double> &,
                     Treatment,
                     HourglassResponse,
                     Frame,
                     KernelKind);
  template std::unique_ptr<const StressUpdate<3>>
  make_stress_update(const std::string &,
                     const std::vector<double> &,
                     Treatment,
                     HourglassResponse,
                     Frame,
                     KernelKind);
} // namespace limber
