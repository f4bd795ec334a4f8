// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/stress/make_sweep.h>

#include <stdexcept>

namespace limber
{
  namespace
  {
    /**
     * The strain of an hourglass mode that resists bending as a beam does:
     * the mate contracts by nu / (1 - nu) where the third axis is held, and
     * by nu each in the trilinear mode (doc/theory/treatments.md).
     */
    template <class Law>
    StrainProjection
    strain_projection(const Law              &law,
                      const Projection        kind,
                      const HourglassResponse response)
    {
      const double     K = law.bulk_modulus, G = law.shear_modulus;
      StrainProjection result;
      result.kind = kind;
      switch (response)
        {
          case HourglassResponse::automatic:
            throw std::logic_error("no hourglass response chosen");
          case HourglassResponse::bending:
            result.own            = 1;
            result.mate           = -(K - 2. / 3. * G) / (K + 4. / 3. * G);
            result.trilinear_own  = 1;
            result.trilinear_mate = -(3 * K - 2 * G) / (2 * (3 * K + G));
            break;
          case HourglassResponse::deviatoric:
            result.own            = 0.5;
            result.mate           = -0.5;
            result.trilinear_own  = 2. / 3.;
            result.trilinear_mate = -1. / 3.;
            break;
          case HourglassResponse::incompressible:
            result.own            = 1;
            result.mate           = -1;
            result.trilinear_own  = 1;
            result.trilinear_mate = -0.5;
            break;
        }
      return result;
    }



    /** Without shear stress there is no more to project than the pressure. */
    template <class Law>
    Projection
    projection_for(const Projection kind)
    {
      if (Law::has_deviator || kind == Projection::none ||
          kind == Projection::automatic)
        return kind;
      return averages_around_nodes(kind) ? Projection::node : Projection::cell;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<const StressUpdate<dim>>
  make_stress_update(const std::string         &name,
                     const std::vector<double> &values,
                     const Projection           kind,
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
      const auto projection =
        strain_projection(law, projection_for<Law>(kind), response);
      if (kernel == KernelKind::quadratic)
        result = make_quadratic_sweep<dim>(law, projection, frame);
      else if (kernel == KernelKind::cubic)
        result = make_cubic_sweep<dim>(law, projection, frame);
      else if (frame == Frame::initial)
        result = make_initial_frame_sweep<Linear<dim>>(law, projection);
      else if (kernel == KernelKind::ddmp)
        result = make_dual_domain_sweep<dim>(law, projection);
      else if (has_domains(kernel))
        result = make_convected_sweep<dim>(law, projection);
      else
        result = make_sweep<Linear<dim>>(law, projection);
    });
    if (!result)
      throw std::logic_error("no law " + name);
    return result;
  }



  template std::unique_ptr<const StressUpdate<2>>
  make_stress_update(const std::string &,
                     const std::vector<double> &,
                     Projection,
                     HourglassResponse,
                     Frame,
                     KernelKind);
  template std::unique_ptr<const StressUpdate<3>>
  make_stress_update(const std::string &,
                     const std::vector<double> &,
                     Projection,
                     HourglassResponse,
                     Frame,
                     KernelKind);
} // namespace limber
