// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <limber/fem/solid_totals.h>

#include <algorithm>
#include <cmath>

namespace limber
{
  template <int dim>
  StrainTotals
  strain_totals(const SolidModel<dim> &model, const NodalVector &displacement)
  {
    StrainTotals          result;
    dealii::FEValues<dim> values(model.shape_values(model.quadrature));
    for (const auto &cell : model.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          const auto states = model.states(cell, values, values, displacement);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              result.strain_energy += values.JxW(q) * states[q].strain_energy;
              result.smallest_volume =
                std::min(result.smallest_volume, states[q].volume_ratio);
              result.largest_volume =
                std::max(result.largest_volume, states[q].volume_ratio);
              for (unsigned int k = 0; k < max_variables; ++k)
                result.largest_variable[k] =
                  std::max(result.largest_variable[k], states[q].variables[k]);
            }
        }
    namespace MPI        = dealii::Utilities::MPI;
    result.strain_energy = MPI::sum(result.strain_energy, model.communicator);
    result.smallest_volume =
      MPI::min(result.smallest_volume, model.communicator);
    result.largest_volume = MPI::max(result.largest_volume, model.communicator);
    for (double &value : result.largest_variable)
      value = MPI::max(value, model.communicator);
    return result;
  }



  template <int dim>
  double
  kinetic_energy(const SolidModel<dim> &model, const NodalVector &velocity)
  {
    NodalVector momenta = model.make_vector();
    if (model.problem.reference.method == ReferenceMethod::explicit_steps)
      {
        for (const auto i : momenta.locally_owned_elements())
          momenta[i] = model.nodal_masses()[i] * velocity[i];
      }
    else
      model.mass_matrix().vmult(momenta, velocity);
    return 0.5 * (momenta * velocity);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  momentum(const SolidModel<dim> &model, const NodalVector &velocity)
  {
    NodalVector momenta = model.make_vector();
    for (const auto i : momenta.locally_owned_elements())
      momenta[i] = model.nodal_masses()[i] * velocity[i];
    return sum_over_nodes(model, momenta);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  mass_moment(const SolidModel<dim> &model, const NodalVector &displacement)
  {
    dealii::Tensor<1, dim> result;
    model.for_each_owned_node([&](const auto &place, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        result[d] +=
          model.nodal_masses()[dofs[d]] * (place[d] + displacement[dofs[d]]);
    });
    return dealii::Utilities::MPI::sum(result, model.communicator);
  }



  template <int dim>
  double
  total_mass(const SolidModel<dim> &model)
  {
    return sum_over_nodes(model, model.nodal_masses())[0];
  }



  template <int dim>
  double
  largest_speed(const SolidModel<dim> &model, const NodalVector &velocity)
  {
    double squared = 0;
    model.for_each_owned_node([&](const auto &, const auto &dofs) {
      double sum = 0;
      for (unsigned int d = 0; d < dim; ++d)
        sum += velocity[dofs[d]] * velocity[dofs[d]];
      squared = std::max(squared, sum);
    });
    return std::sqrt(dealii::Utilities::MPI::max(squared, model.communicator));
  }



  template <int dim>
  dealii::Tensor<1, dim>
  sum_over_nodes(const SolidModel<dim> &model, const NodalVector &vector)
  {
    dealii::Tensor<1, dim> result;
    model.for_each_owned_node([&](const auto &, const auto &dofs) {
      for (unsigned int d = 0; d < dim; ++d)
        result[d] += vector[dofs[d]];
    });
    return dealii::Utilities::MPI::sum(result, model.communicator);
  }



  template StrainTotals
  strain_totals(const SolidModel<2> &, const NodalVector &);
  template double
  kinetic_energy(const SolidModel<2> &, const NodalVector &);
  template dealii::Tensor<1, 2>
  momentum(const SolidModel<2> &, const NodalVector &);
  template dealii::Tensor<1, 2>
  mass_moment(const SolidModel<2> &, const NodalVector &);
  template double
  total_mass(const SolidModel<2> &);
  template double
  largest_speed(const SolidModel<2> &, const NodalVector &);
  template dealii::Tensor<1, 2>
  sum_over_nodes(const SolidModel<2> &, const NodalVector &);
  template StrainTotals
  strain_totals(const SolidModel<3> &, const NodalVector &);
  template double
  kinetic_energy(const SolidModel<3> &, const NodalVector &);
  template dealii::Tensor<1, 3>
  momentum(const SolidModel<3> &, const NodalVector &);
  template dealii::Tensor<1, 3>
  mass_moment(const SolidModel<3> &, const NodalVector &);
  template double
  total_mass(const SolidModel<3> &);
  template double
  largest_speed(const SolidModel<3> &, const NodalVector &);
  template dealii::Tensor<1, 3>
  sum_over_nodes(const SolidModel<3> &, const NodalVector &);
} // namespace limber
