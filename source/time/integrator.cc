// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<Integrator<dim>>
  make_integrator(const RunParts<dim> &parts)
  {
    return std::make_unique<ExplicitIntegrator<dim>>(parts);
  }



  template std::unique_ptr<Integrator<2>>
  make_integrator(const RunParts<2> &);
  template std::unique_ptr<Integrator<3>>
  make_integrator(const RunParts<3> &);
} // namespace limber
