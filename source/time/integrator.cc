// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/time/explicit_integrator.h>
#include <limber/time/newton_integrator.h>
#include <limber/time/semi_implicit_integrator.h>

namespace limber
{
  template <int dim>
  std::unique_ptr<Integrator<dim>>
  make_integrator(const RunParts<dim> &parts)
  {
    switch (parts.problem.method.integration)
      {
        case TimeIntegration::explicit_steps:
          break;
        case TimeIntegration::semi_implicit:
          return std::make_unique<SemiImplicitIntegrator<dim>>(parts);
        case TimeIntegration::implicit_steps:
        case TimeIntegration::quasi_static:
          return std::make_unique<NewtonIntegrator<dim>>(parts);
      }
    return std::make_unique<ExplicitIntegrator<dim>>(parts);
  }



  template std::unique_ptr<Integrator<2>>
  make_integrator(const RunParts<2> &);
  template std::unique_ptr<Integrator<3>>
  make_integrator(const RunParts<3> &);
} // namespace limber
