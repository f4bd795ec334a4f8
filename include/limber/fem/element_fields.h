// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_fem_element_fields_h
#define limber_fem_element_fields_h

#include <deal.II/base/symmetric_tensor.h>

#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/full_matrix.h>

#include <limber/fem/solid_element.h>
#include <limber/materials/law.h>

#include <cmath>
#include <vector>

/** @file Fields within an element: deformation gradients and L2 projections. */
namespace limber
{
  /** Deformation at a quadrature point, with what the variation of J needs. */
  template <int dim>
  struct Deformation
  {
    SquareMatrix<dim>      gradient{}; // F
    dealii::Tensor<2, dim> inverse;    // F^-1; 1 for small strains
    double                 J = 1;
  };



  template <int dim>
  inline Deformation<dim>
  deformation(const dealii::FEValues<dim> &values,
              const unsigned int           q,
              const std::vector<double>   &u,
              const bool                   finite_strain)
  {
    dealii::Tensor<2, dim> F  = dealii::unit_symmetric_tensor<dim>();
    const auto            &fe = values.get_fe();
    for (unsigned int i = 0; i < u.size(); ++i)
      F[fe.system_to_component_index(i).first] +=
        u[i] * values.shape_grad(i, q);

    Deformation<dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result.gradient[i][j] = F[i][j];
    if (finite_strain)
      {
        result.J = determinant(F);
        if (result.J > 0)
          result.inverse = invert(F);
      }
    else
      {
        result.J       = 1 + trace(F) - dim;
        result.inverse = dealii::unit_symmetric_tensor<dim>();
      }
    return result;
  }



  /**
   * L2 projection within an element onto constants (one mode) or linear
   * functions 1, X, Y (, Z); without modes it is the identity on the quadrature
   * points.
   */
  template <int dim>
  class FieldProjection
  {
  public:
    FieldProjection(const dealii::FEValues<dim> &values,
                    const unsigned int           n_modes)
      : n_modes(n_modes)
      , weights(values.get_JxW_values())
    {
      if (n_modes == 0)
        return;
      double volume = 0;
      for (unsigned int q = 0; q < weights.size(); ++q)
        {
          centre += weights[q] * values.quadrature_point(q);
          volume += weights[q];
        }
      centre /= volume;
      scale = std::pow(volume, -1. / dim);
      modes = modes_at(values);
      inverse_mass.reinit(n_modes, n_modes);
      for (unsigned int q = 0; q < weights.size(); ++q)
        for (unsigned int m = 0; m < n_modes; ++m)
          for (unsigned int n = 0; n < n_modes; ++n)
            inverse_mass(m, n) += weights[q] * modes(q, m) * modes(q, n);
      inverse_mass.gauss_jordan();
    }

    dealii::FullMatrix<double>
    modes_at(const dealii::FEValues<dim> &places) const
    {
      dealii::FullMatrix<double> result(places.n_quadrature_points, n_modes);
      for (const unsigned int q : places.quadrature_point_indices())
        for (unsigned int m = 0; m < n_modes; ++m)
          result(q, m) =
            m == 0 ?
              1 :
              scale * (places.quadrature_point(q)[m - 1] - centre[m - 1]);
      return result;
    }

    /** Coefficients of a field given at the quadrature points. */
    std::vector<double>
    coefficients(const std::vector<double> &field) const
    {
      std::vector<double> moments(n_modes), result(n_modes);
      for (unsigned int q = 0; q < weights.size(); ++q)
        for (unsigned int m = 0; m < n_modes; ++m)
          moments[m] += weights[q] * modes(q, m) * field[q];
      for (unsigned int m = 0; m < n_modes; ++m)
        for (unsigned int n = 0; n < n_modes; ++n)
          result[m] += inverse_mass(m, n) * moments[n];
      return result;
    }

    static std::vector<double>
    evaluate(const dealii::FullMatrix<double> &modes,
             const std::vector<double>        &coefficients)
    {
      std::vector<double> result(modes.m());
      for (unsigned int q = 0; q < modes.m(); ++q)
        for (unsigned int m = 0; m < modes.n(); ++m)
          result[q] += modes(q, m) * coefficients[m];
      return result;
    }

    std::vector<double>
    project(const std::vector<double> &field) const
    {
      return n_modes == 0 ? field : evaluate(modes, coefficients(field));
    }

    const unsigned int         n_modes;
    const std::vector<double> &weights;
    dealii::FullMatrix<double> modes, inverse_mass;

  private:
    dealii::Point<dim> centre;
    double             scale = 1;
  };



  /** The components of a deviator within the dimensions. */
  template <int dim>
  inline dealii::Tensor<2, dim>
  tensor_of(const Deviator<dim, double> &s)
  {
    const auto             rows = rows_of<dim>(s);
    dealii::Tensor<2, dim> result;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        result[i][j] = rows[i][j];
    return result;
  }



  /** Output of the state of a law: Cauchy stress, energy per initial volume. */
  template <int dim, class Law>
  inline MaterialState
  material_state(const Law                                       &law,
                 const typename Law::template State<dim, double> &state)
  {
    MaterialState result;
    result.volume_ratio  = law.template volume_ratio<dim>(state);
    result.pressure      = state.pressure / result.volume_ratio;
    result.strain_energy = law.template strain_energy<dim>(state);
    const auto s         = full_matrix<dim>(state.deviator);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        result.stress[i][j] =
          s[i][j] / result.volume_ratio - (i == j ? result.pressure : 0);
    for (unsigned int k = 0; k < Law::variables.size(); ++k)
      result.variables[k] = state.history[index_of_variable<dim, Law>(k)];
    return result;
  }



  /** The displacement component of a degree of freedom of an element. */
  template <int dim>
  inline unsigned int
  component(const dealii::FEValues<dim> &values, const unsigned int i)
  {
    return values.get_fe().system_to_component_index(i).first;
  }
} // namespace limber

#endif
