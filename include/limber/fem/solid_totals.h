// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_solid_totals_h
#define limber_fem_solid_totals_h

#include <limber/fem/solid_model.h>

/**
 * @file Sums and extremes over a body in finite elements. All are collective
 * and the same on every rank.
 */
namespace limber
{
  /** Strain energy and extremes over the quadrature points. */
  struct StrainTotals
  {
    double strain_energy   = 0; // J
    double smallest_volume = 1; // of all J
    double largest_volume  = 1;
    // of the variables of a law that flows
    std::array<double, max_variables> largest_variable{};
  };

  template <int dim>
  StrainTotals
  strain_totals(const SolidModel<dim> &model, const NodalVector &displacement);

  /** J: of lumped masses where steps are explicit. */
  template <int dim>
  double
  kinetic_energy(const SolidModel<dim> &model, const NodalVector &velocity);

  /** kg m/s. */
  template <int dim>
  dealii::Tensor<1, dim>
  momentum(const SolidModel<dim> &model, const NodalVector &velocity);

  /** Sum of mass times place of the deformed body, kg m. */
  template <int dim>
  dealii::Tensor<1, dim>
  mass_moment(const SolidModel<dim> &model, const NodalVector &displacement);

  /** kg. */
  template <int dim>
  double
  total_mass(const SolidModel<dim> &model);

  /** Of the nodes, m/s. */
  template <int dim>
  double
  largest_speed(const SolidModel<dim> &model, const NodalVector &velocity);

  /** The sum of the vectors at all nodes, in the unit of their components. */
  template <int dim>
  dealii::Tensor<1, dim>
  sum_over_nodes(const SolidModel<dim> &model, const NodalVector &vector);
} // namespace limber

#endif
