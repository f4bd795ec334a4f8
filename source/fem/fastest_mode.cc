// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/fem/fastest_mode.h>

#include <cmath>

namespace limber
{
  template <int dim>
  FastestMode<dim>::FastestMode(const SolidModel<dim> &model)
    : model(model)
    , mode(model.make_vector())
  {
    // an oscillating start vector, the same on any number of ranks
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      double phase = 0;
      for (unsigned int d = 0; d < dim; ++d)
        phase += (1 + d) * place[d] / model.smallest_edge;
      for (unsigned int d = 0; d < dim; ++d)
        mode[dofs[d]] = std::cos(3.1 * phase + 1.7 * d);
    });
    model.held().clear(mode);
  }



  template <int dim>
  double
  FastestMode<dim>::circular_frequency(const NodalVector &displacement,
                                       const unsigned int n_iterations)
  {
    const double size  = 1e-6 * model.smallest_edge;
    NodalVector  ahead = model.make_vector(), behind = model.make_vector();
    NodalVector  moved   = model.make_vector();
    double       largest = 0; // eigenvalue
    for (unsigned int k = 0; k < n_iterations; ++k)
      {
        mode *= size / mode.linfty_norm();
        moved = displacement;
        moved += mode;
        moved.update_ghost_values();
        bool good = model.internal_forces(moved, ahead);
        moved.add(-2, mode);
        moved.update_ghost_values();
        good &= model.internal_forces(moved, behind);
        if (!good)
          break;
        ahead -= behind;
        ahead *= 0.5;
        model.held().clear(ahead);
        // Rayleigh quotient in the metric of the lumped masses
        double mass = 0;
        for (const auto i : mode.locally_owned_elements())
          mass += mode[i] * mode[i] * model.nodal_masses()[i];
        mass    = dealii::Utilities::MPI::sum(mass, model.communicator);
        largest = (mode * ahead) / mass;
        for (const auto i : mode.locally_owned_elements())
          mode[i] = ahead[i] / model.nodal_masses()[i];
      }
    return largest > 0 ? std::sqrt(largest) : 0;
  }



  template class FastestMode<2>;
  template class FastestMode<3>;
} // namespace limber
